#include "technique/Technique.h"

#include "light/Samples.h"

#include <algorithm>
#include <cassert>

namespace lucent::technique {

namespace {

// Steps of a factor of the fourth root of two.
constexpr double kCounts[] = {1,   2,   3,   4,   5,   6,   7,   8,    10,   11,   13,   16,  19,  23,
                              27,  32,  38,  45,  54,  64,  76,  91,   108,  128,  152,  181, 215, 256,
                              304, 362, 431, 512, 609, 724, 861, 1024, 1218, 1448, 1722, 2048};
constexpr std::string_view kPlacings[] = {"evenly", "by importance"}; // views::EnvironmentSampling
constexpr Knob kLamps{.id = "lampSamples",
                      .coarse = 4,
                      .steps = std::span(kCounts).first(28),
                      .most = 1024,
                      .showsOnFew = true,
                      .words = "samples a lamp"};
// Previews grow by directions, whatever the scene's number is.
constexpr Knob kDirections{.id = "directions",
                           .coarse = 65536,
                           .steps = std::span(kCounts).subspan(7),
                           .most = 4096,
                           .showsOnFew = true,
                           .words = "directions",
                           .placing = "environmentSampling",
                           .placings = kPlacings};

} // namespace

const Technique* find(std::string_view name) {
    const auto found = std::find_if(all().begin(), all().end(),
                                    [name](const Technique* technique) { return technique->name == name; });
    return found == all().end() ? nullptr : *found;
}

std::optional<std::string> need(const scene::Scene& scene, std::string_view technique) {
    const Technique* found = find(technique);
    return found ? found->need(scene) : std::nullopt;
}

bool acts(const scene::Scene& scene, std::string_view table, std::string_view id) {
    if (table == views::samplingParams().name) return views::samplingActs(scene, id);
    const Technique* technique = find(table);
    if (!technique) return true;
    const auto settings = scene.technique.find(std::string(table));
    if (settings == scene.technique.end() || !technique->need(scene)) return false;
    return !technique->acts || technique->acts(settings->second, id);
}

std::vector<KnobOf> knobs(const scene::Scene& scene) {
    const std::string_view table = views::samplingParams().name;
    std::vector<KnobOf> list;
    if (views::hasLargeLamp(scene)) list.push_back({table, &kLamps});
    if (views::hasEnvironment(scene)) list.push_back({table, &kDirections});
    for (const Technique* technique : all())
        if (technique->need(scene))
            for (const Knob& knob : technique->knobs)
                if (!knob.acts || knob.acts(scene)) list.push_back({technique->name, &knob});
    return list;
}

bool isShaded(const scene::Object& object, std::span<const Technique* const> techniques) {
    return std::any_of(techniques.begin(), techniques.end(), [&](const Technique* technique) {
        return technique->shades && technique->shades(object);
    });
}

std::vector<std::string> notDrawn(const scene::Scene& scene, std::optional<scene::PaintMap> map,
                                  std::span<const Technique* const> techniques) {
    std::vector<std::string> lines;
    for (const scene::Object& object : scene.objects)
        if (!map && !isShaded(object, techniques))
            lines.push_back("object \"" + object.name +
                            "\": the technique for its material is not built into this program");
    for (const Technique* technique : techniques)
        for (const NotDrawn& limit : technique->limits)
            if (limit.applies(scene) && (!map || limit.map == map))
                lines.push_back(std::string(limit.what) + ": " + std::string(limit.why));
    return lines;
}

void drawAll(scene::Scene& scene) {
    for (const Technique* technique : all())
        for (const NotDrawn& limit : technique->limits) {
            const auto settings = scene.technique.find(std::string(technique->name));
            if (limit.setting.empty() || settings == scene.technique.end() || !limit.applies(scene)) continue;
            for (const Param& param : settings->second.table().params) {
                if (param.id != limit.setting) continue;
                const Status set = setText(
                    param, static_cast<std::byte*>(settings->second.data()) + param.offset, limit.value);
                assert(set);
            }
        }
}

} // namespace lucent::technique
