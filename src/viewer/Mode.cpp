#include "viewer/Mode.h"

#include "frame/Renderer.h"
#include "techniques/subsurface/Subsurface.h"
#include "viewer/Painter.h"

#include <algorithm>
#include <optional>

namespace lucent::viewer {

using scene::Aov;

namespace {

constexpr std::string_view kModes[] = {"relief", "refraction", "caustics", "subsurface", "paint"};

// Groups that stand first; the others follow in their own order.
constexpr Group kReliefFirst[] = {Group::Mode};
constexpr Group kRefractionFirst[] = {Group::Mode, Group::Refraction, Group::View, Group::Environment};
constexpr Group kPaintFirst[] = {Group::Mode, Group::View, Group::Material};
constexpr Group kCausticsFirst[] = {Group::Mode, Group::Caustics, Group::Light, Group::View};
constexpr Group kSubsurfaceFirst[] = {Group::Mode, Group::Subsurface, Group::Light, Group::View};

std::span<const Group> firstOf(Mode mode) {
    switch (mode) {
    case Mode::Relief:
        return kReliefFirst;
    case Mode::Refraction:
        return kRefractionFirst;
    case Mode::Caustics:
        return kCausticsFirst;
    case Mode::Subsurface:
        return kSubsurfaceFirst;
    case Mode::Paint:
        return kPaintFirst;
    }
    return {};
}

// Nothing: it belongs to all modes.
std::optional<Mode> modeOf(Aov aov) {
    switch (aov) {
    case Aov::Illumination:
    case Aov::Visibility:
    case Aov::Iterations:
        return Mode::Relief;
    case Aov::Direction:
    case Aov::Layers:
    case Aov::Lost:
    case Aov::LayerDepth:
    case Aov::LayerNormal:
    case Aov::LayerObject:
        return Mode::Refraction;
    case Aov::CausticMap:
        return Mode::Caustics;
    case Aov::Radiosity:
        return Mode::Subsurface;
    default:
        return std::nullopt;
    }
}

} // namespace

std::span<const Param> modeParams() {
    static const Param params[] = {
        declare(
            &ModeSettings::mode,
            {.id = "mode",
             .label = "What stands first",
             .group = Group::Mode,
             .doc = "Which sliders stand first, and which views Show offers: those of the light on a relief, "
                    "of what is seen through glass and water, of the light that these throw, or of light "
                    "inside things; or the brush that paints on these.",
             .choices = kModes,
             .attribute = "mode"}),
        declare(&ModeSettings::matt,
                {.id = "matt",
                 .label = "As matt",
                 .group = Group::Subsurface,
                 .doc = "What scatters light inside, for comparison as if light left where it entered: as "
                        "much of it, with the same highlights (key M).",
                 .attribute = "matt"})};
    return params;
}

std::string_view nameOf(Mode mode) { return kModes[int(mode)]; }

std::vector<BoundParam> bindMode(ModeSettings& settings, const scene::Scene& scene) {
    static const ModeSettings defaults;
    const Param &mode = modeParams()[0], &matt = modeParams()[1];
    const bool scatters = frame::need(scene, "subsurface").has_value();
    return {{std::string(mode.id), "mode", &mode, &settings.mode, &defaults.mode, modesOf(scene).size() > 1},
            {std::string(matt.id), "mode", &matt, &settings.matt, &defaults.matt, scatters}};
}

void applyMatt(const ModeSettings& settings, scene::Scene& scene) {
    if (!settings.matt) return;
    auto* technique = static_cast<subsurface::Settings*>(scene.technique.at("subsurface").data());
    technique->method = subsurface::Method::Lambert;
}

std::vector<Mode> modesOf(const scene::Scene& scene) {
    std::vector<Mode> modes;
    if (frame::need(scene, "relief")) modes.push_back(Mode::Relief);
    if (frame::need(scene, "refract")) modes.push_back(Mode::Refraction);
    if (frame::need(scene, "caustics")) modes.push_back(Mode::Caustics);
    if (frame::need(scene, "subsurface")) modes.push_back(Mode::Subsurface);
    if (std::any_of(scene.objects.begin(), scene.objects.end(), isPaintable)) modes.push_back(Mode::Paint);
    if (modes.empty()) modes.push_back(Mode::Relief);
    return modes;
}

Mode modeFor(const scene::Scene& scene) {
    const std::vector<Mode> modes = modesOf(scene);
    const auto has = [&](Mode mode) { return std::find(modes.begin(), modes.end(), mode) != modes.end(); };
    const bool throwsLight =
        std::any_of(scene.objects.begin(), scene.objects.end(), [](const scene::Object& object) {
            return object.material.isMirror() || std::holds_alternative<scene::Water>(object.shape);
        });
    if (has(Mode::Caustics) && throwsLight) return Mode::Caustics;
    return has(Mode::Refraction) ? Mode::Refraction : modes.front();
}

int placeOf(Group group, Mode mode) {
    if (group == Group::None) group = Group(int(Group::View) + 1);
    const std::span<const Group> first = firstOf(mode);
    const auto found = std::find(first.begin(), first.end(), group);
    return found != first.end() ? int(found - first.begin()) : int(first.size()) + int(group);
}

std::vector<std::string_view> viewsOf(Mode mode, Aov shown) {
    std::vector<std::string_view> names;
    for (std::size_t i = 0; i < scene::aovNames().size(); ++i)
        if (Aov(i) == shown || modeOf(Aov(i)).value_or(mode) == mode) names.push_back(scene::aovNames()[i]);
    return names;
}

} // namespace lucent::viewer
