#include "views/Glass.h"

#include <algorithm>

namespace lucent::views {

GlassBlock glassBlock(const scene::Material& material) {
    const scene::Clear& clear = material.clear();
    return {vec4(iorsOf(clear), clear.fresnel), vec4(clear.absorption, clear.transmission)};
}

vec3 iorsOf(const scene::Clear& material) {
    const auto inverseSquare = [](float micrometres) { return 1 / (micrometres * micrometres); };
    const float c = inverseSquare(0.6563f), d = inverseSquare(0.5876f), f = inverseSquare(0.4861f);
    const float b = (material.ior - 1) * material.dispersion / 20 / (f - c);
    return vec3(material.ior) + b * vec3(c - d, 0, f - d);
}

bool disperses(const Drawables& glass) {
    return std::any_of(glass.begin(), glass.end(),
                       [](const auto& one) { return one->object->material.clear().dispersion > 0; });
}

} // namespace lucent::views
