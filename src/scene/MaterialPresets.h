#pragma once
/// Measured materials that scatter light, by name.

#include "scene/Scene.h"

#include <span>
#include <string_view>

namespace lucent::scene {

/// Of red, green and blue light.
struct MaterialPreset {
    std::string_view name;
    dvec3 scattering; ///< reduced: (1 - g) sigma_s, 1/mm
    dvec3 absorption; ///< sigma_a, 1/mm
    float ior;
};

/// The twelve that Jensen, Marschner, Levoy and Hanrahan measured (A Practical Model for Subsurface Light
/// Transport, 2001, figure 5).
std::span<const MaterialPreset> materialPresets();

/// Gives a material the coefficients of a preset. The measurement knows the reduced coefficient only, so what
/// is scattered grows with the material's anisotropy: sigma_s = sigma_s' / (1 - g).
void apply(const MaterialPreset& preset, Translucent& material);
void apply(const MaterialPreset& preset, MediumLayer& layer);

} // namespace lucent::scene
