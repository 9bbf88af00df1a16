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

std::span<const ParamTable* const> tables() {
    static const std::vector<const ParamTable*> list = [] {
        std::vector<const ParamTable*> made{&views::samplingParams()};
        for (const Technique* technique : all())
            if (technique->params) made.push_back(technique->params());
        return made;
    }();
    return list;
}

bool acts(const scene::Scene& scene, std::string_view table, std::string_view id) {
    if (table == views::samplingParams().name) return views::samplingActs(scene, id);
    const Technique* technique = find(table);
    if (!technique) return true;
    const auto settings = scene.technique.find(std::string(table));
    if (settings == scene.technique.end() || !technique->need(scene)) return false;
    return !technique->acts || technique->acts(settings->second, id);
}

truth::Model modelOf(const scene::Scene& scene) {
    truth::Model model;
    for (const Technique* technique : all()) {
        const auto settings = scene.technique.find(std::string(technique->name));
        if (technique->describe && settings != scene.technique.end())
            technique->describe(settings->second, model);
    }
    return model;
}

scene::Scene withDefaults(scene::Scene scene) {
    for (auto& [name, settings] : scene.technique) {
        Settings fresh(settings.table());
        const Technique* technique = find(name);
        for (const Param& param : settings.table().params)
            if (technique && std::find(technique->model.begin(), technique->model.end(), param.id) !=
                                 technique->model.end()) {
                const std::string value =
                    getText(param, static_cast<const std::byte*>(settings.data()) + param.offset);
                (void)setText(param, static_cast<std::byte*>(fresh.data()) + param.offset, value);
            }
        settings = std::move(fresh);
    }
    return scene;
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

std::vector<std::string> notDrawn(const scene::Scene& scene, std::optional<scene::PaintMap> map) {
    std::vector<std::string> lines;
    for (const Technique* technique : all())
        for (const NotDrawn& limit : technique->limits)
            if (limit.applies(scene) && (!map || limit.map == map))
                lines.push_back(std::string(limit.what) + ": " + std::string(limit.why));
    return lines;
}

} // namespace lucent::technique
