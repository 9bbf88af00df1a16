#include "viewer/Mode.h"

#include "technique/Technique.h"
#include "viewer/Painter.h"

#include <algorithm>

namespace lucent::viewer {

using scene::Aov;

namespace {

constexpr std::string_view kPaint = "paint";
constexpr std::string_view kAccuracies[] = {"automatic", "full"};
constexpr Group kPaintFirst[] = {Group::Mode, Group::View, Group::Material};

// Techniques that people work on, from the left.
const std::vector<const technique::Technique*>& workedOn() {
    static const auto list = [] {
        std::vector<const technique::Technique*> sorted;
        for (const technique::Technique* one : technique::all())
            if (one->mode) sorted.push_back(one);
        std::sort(sorted.begin(), sorted.end(),
                  [](const auto* a, const auto* b) { return a->mode->place < b->mode->place; });
        return sorted;
    }();
    return list;
}

const std::vector<std::string_view>& modeNames() {
    static const auto names = [] {
        std::vector<std::string_view> list;
        for (const technique::Technique* one : workedOn())
            list.push_back(one->mode->name);
        list.push_back(kPaint);
        return list;
    }();
    return names;
}

// Null: the brush.
const technique::Technique* techniqueOf(Mode mode) {
    return std::size_t(mode) < workedOn().size() ? workedOn()[std::size_t(mode)] : nullptr;
}

std::span<const Group> firstOf(Mode mode) {
    const technique::Technique* one = techniqueOf(mode);
    return one ? one->mode->first : std::span<const Group>(kPaintFirst);
}

// Whose own a quantity is; nothing: it belongs to all modes.
const technique::Technique* ownerOf(Aov aov) {
    for (const technique::Technique* one : workedOn())
        if (std::find(one->aovs.begin(), one->aovs.end(), aov) != one->aovs.end()) return one;
    return nullptr;
}

bool isOffered(const technique::Technique& one, const scene::Scene& scene) {
    return one.mode->has ? one.mode->has(scene) : one.need(scene).has_value();
}

bool scatters(const scene::Object& object) {
    return object.visible && !object.isField() && object.material.isScattering();
}

} // namespace

std::span<const Param> modeParams() {
    static const Param params[] = {
        declare(
            &ModeSettings::mode,
            {.id = "mode",
             .label = "Mode",
             .group = Group::Mode,
             .doc = "Which sliders stand first, and which views Show offers: those of the light on a relief, "
                    "of what is seen through glass and water, of the light that these throw, of "
                    "subsurface scattering, of how surfaces reflect light (brdf), of how rays find displaced "
                    "heights, or of precomputed subsurface scattering (throughput); or the brush that paints "
                    "on translucent objects.",
             .choices = modeNames(),
             .attribute = "mode"}),
        declare(&ModeSettings::matt,
                {.id = "matt",
                 .label = "As matt",
                 .group = Group::Subsurface,
                 .doc =
                     "What has subsurface scattering, for comparison as if light left where it entered: as "
                     "much of it, with the same highlights (key M).",
                 .attribute = "matt"}),
        declare(&ModeSettings::accuracy,
                {.id = "accuracy",
                 .label = "Accuracy",
                 .group = Group::View,
                 .doc = "Without a fast graphics card a picture is drawn to an error of 3 %, with no more "
                        "light samples than that takes; full: with all that the scene asks for. An Error "
                        "above 0 is kept in both.",
                 .choices = kAccuracies,
                 .attribute = "accuracy"})};
    return params;
}

std::string_view nameOf(Mode mode) { return modeNames()[std::size_t(mode)]; }

Mode paintMode() { return Mode(workedOn().size()); }

std::vector<BoundParam> bindMode(ModeSettings& settings, const scene::Scene& scene, float error) {
    static const ModeSettings defaults;
    const Param &mode = modeParams()[0], &matt = modeParams()[1], &accuracy = modeParams()[2];
    const bool hasMatt = std::any_of(scene.objects.begin(), scene.objects.end(), scatters);
    return {{std::string(mode.id), "mode", &mode, &settings.mode, &defaults.mode, modesOf(scene).size() > 1},
            {std::string(matt.id), "mode", &matt, &settings.matt, &defaults.matt, hasMatt},
            {std::string(accuracy.id), "mode", &accuracy, &settings.accuracy, &defaults.accuracy, error > 0}};
}

void applyMatt(const ModeSettings& settings, scene::Scene& scene) { scene.view.matt = settings.matt; }

std::vector<Mode> modesOf(const scene::Scene& scene) {
    std::vector<Mode> modes;
    for (std::size_t i = 0; i < workedOn().size(); ++i)
        if (isOffered(*workedOn()[i], scene)) modes.push_back(Mode(i));
    if (std::any_of(scene.objects.begin(), scene.objects.end(), isPaintable)) modes.push_back(paintMode());
    if (modes.empty()) modes.push_back(Mode{});
    return modes;
}

Mode modeFor(const scene::Scene& scene) {
    const std::vector<Mode> modes = modesOf(scene);
    const auto leading = std::find_if(modes.rbegin(), modes.rend(), [&](Mode mode) {
        const technique::Technique* one = techniqueOf(mode);
        return one && one->mode->leads && one->mode->leads(scene);
    });
    return leading != modes.rend() ? *leading : modes.front();
}

int placeOf(Group group, Mode mode) {
    if (group == Group::None) group = Group(int(Group::View) + 1);
    const std::span<const Group> first = firstOf(mode);
    const auto found = std::find(first.begin(), first.end(), group);
    return found != first.end() ? int(found - first.begin()) : int(first.size()) + int(group);
}

std::vector<std::string_view> viewsOf(Mode mode, Aov shown) {
    std::vector<std::string_view> names;
    for (std::size_t i = 0; i < scene::aovNames().size(); ++i) {
        const technique::Technique* owner = ownerOf(Aov(i));
        if (Aov(i) == shown || !owner || owner == techniqueOf(mode)) names.push_back(scene::aovNames()[i]);
    }
    return names;
}

} // namespace lucent::viewer
