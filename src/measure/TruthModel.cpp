#include "measure/TruthModel.h"

#include "frame/Renderer.h"

#include <algorithm>

namespace lucent::measure {

TruthModel usualTruth(const scene::Scene& scene) {
    const scene::Aov aov = scene.view.show;
    const bool scatters = std::any_of(scene.objects.begin(), scene.objects.end(),
                                      [](const auto& object) { return object.material.isScattering(); });
    if (aov == scene::Aov::Radiosity || (aov == scene::Aov::Color && scatters)) return TruthModel::Dipole;
    if (aov == scene::Aov::Irradiance) return TruthModel::Light;
    if (aov == scene::Aov::Color && frame::need(scene, "caustics")) return TruthModel::Light;
    const bool fields = std::all_of(scene.objects.begin(), scene.objects.end(),
                                    [](const scene::Object& object) { return object.isField(); });
    return fields ? TruthModel::Relief : TruthModel::Glass;
}

} // namespace lucent::measure
