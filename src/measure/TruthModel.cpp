#include "measure/TruthModel.h"

#include "technique/Technique.h"

#include <algorithm>

namespace lucent::measure {

std::optional<std::string> causticOf(const scene::Scene& scene) {
    const auto bends = [](const scene::Object& one) {
        return !one.isField() && (one.material.isRefractive() || one.material.isMirror());
    };
    const auto& objects = scene.objects;
    const auto thrower = std::find_if(objects.begin(), objects.end(), bends);
    const auto receiver = std::find_if_not(objects.begin(), objects.end(), bends);
    const bool hasWater = std::any_of(objects.begin(), objects.end(), [](const scene::Object& one) {
        return std::holds_alternative<scene::Water>(one.shape); // which bends all light
    });
    const bool isLit = !scene.lights.empty() || (scene.environment && scene.environment->enabled &&
                                                 (hasWater || technique::modelOf(scene).environmentCaustics));
    if (!isLit || thrower == objects.end() || receiver == objects.end()) return std::nullopt;
    return "object \"" + thrower->name + "\" casts a caustic on \"" + receiver->name + "\"";
}

TruthModel usualTruth(const scene::Scene& scene) {
    const scene::Aov aov = scene.view.show;
    const bool scatters = std::any_of(scene.objects.begin(), scene.objects.end(),
                                      [](const auto& object) { return object.material.isScattering(); });
    if (aov == scene::Aov::Radiosity || (aov == scene::Aov::Color && scatters)) return TruthModel::Dipole;
    if (aov == scene::Aov::Irradiance) return TruthModel::Light;
    if (aov == scene::Aov::Color && causticOf(scene)) return TruthModel::Light;
    const bool alone = std::all_of(scene.objects.begin(), scene.objects.end(),
                                   [](const scene::Object& object) { return object.isField(); });
    if (aov == scene::Aov::Illumination) return TruthModel::Relief;
    const bool shaded = scene.objects.size() > 1 ||
                        std::any_of(scene.lights.begin(), scene.lights.end(), [](const scene::Light& light) {
                            return std::holds_alternative<scene::SpotLight>(light) ||
                                   std::holds_alternative<scene::AreaLight>(light);
                        });
    return alone && !shaded ? TruthModel::Relief : TruthModel::Glass;
}

} // namespace lucent::measure
