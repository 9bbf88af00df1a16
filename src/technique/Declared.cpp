// What is asked of techniques without a GPU: a module of exact solutions links no more than this.
#include "technique/Technique.h"

#include "light/Samples.h"

#include <algorithm>

namespace lucent::technique {

std::span<const ParamTable* const> tables() {
    static const std::vector<const ParamTable*> list = [] {
        std::vector<const ParamTable*> made{&views::samplingParams()};
        for (const Declared* one : declared())
            made.push_back(one->params());
        return made;
    }();
    return list;
}

void addSettings(scene::Scene& scene) {
    for (const ParamTable* table : tables())
        scene.technique.emplace(std::string(table->name), Settings(*table));
    views::samplingOf(scene).pixelSamples = 1;
}

truth::Model modelOf(const scene::Scene& scene) {
    truth::Model model;
    model.overPixels = scene.view.show == scene::Aov::Color && views::samplingOf(scene).pixelSamples > 1;
    for (const Declared* technique : declared()) {
        const auto settings = scene.technique.find(std::string(technique->name));
        if (technique->describe && settings != scene.technique.end())
            technique->describe(settings->second, model);
    }
    return model;
}

scene::Scene withDefaults(scene::Scene scene) {
    const bool ofMiddles = views::samplingOf(scene).pixelSamples == 1;
    for (auto& entry : scene.technique) {
        const std::string& name = entry.first;
        Settings& settings = entry.second;
        Settings fresh(settings.table());
        const auto found = std::find_if(declared().begin(), declared().end(),
                                        [&](const Declared* one) { return one->name == name; });
        const Declared* technique = found == declared().end() ? nullptr : *found;
        for (const Param& param : settings.table().params)
            if (technique && std::find(technique->model.begin(), technique->model.end(), param.id) !=
                                 technique->model.end()) {
                const std::string value =
                    getText(param, static_cast<const std::byte*>(settings.data()) + param.offset);
                (void)setText(param, static_cast<std::byte*>(fresh.data()) + param.offset, value);
            }
        settings = std::move(fresh);
    }
    if (ofMiddles) views::samplingOf(scene).pixelSamples = 1;
    for (scene::Object& object : scene.objects) // how it is drawn, not what it is
        if (object.material.isScattering()) object.material.translucent().precomputed = false;
    return scene;
}

} // namespace lucent::technique
