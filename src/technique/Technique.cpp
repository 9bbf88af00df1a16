#include "technique/Technique.h"

#include "light/Samples.h"

#include <algorithm>

namespace lucent::technique {

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
    static constexpr double kLampSamples[] = {1, 4, 16, 64, 256};
    static constexpr Knob kLamps{
        .id = "lampSamples", .coarse = 4, .steps = kLampSamples, .words = "samples a lamp"};
    std::vector<KnobOf> list;
    if (views::hasLargeLamp(scene)) list.push_back({views::samplingParams().name, &kLamps, true});
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

} // namespace lucent::technique
