#pragma once
/// Subsurface scattering, in other words than the coefficients that a material holds: a measured material,
/// numbers per millimetre, and the two that an artist turns (image-space dissertation 2007, 7.3.4 and 7.4):
/// blur and glow.

#include "scene/Scene.h"

namespace lucent::scene {

/// Place in materialPresets(), from 1 on; Own: none of them.
enum class Measured : int { Own };

/// Computed from a material, and carried back to it one by one: none of them is held anywhere.
struct Translucency {
    Measured preset = Measured::Own; ///< whose coefficients these are, to 1e-5 of their values
    float blur = 1;                  ///< mm: 1 / sigma_t', the mean over colours
    float glow = 0.5f;               ///< halfSpaceAlbedo() of sigma_s' / sigma_t', the mean over colours
    vec3 scatteringPerMm{0};         ///< sigma_s, 1/mm
    vec3 absorptionPerMm{0};         ///< sigma_a, 1/mm
};

/// Share of evenly spread light that a deep body sends back where nothing is mirrored at its surface: van de
/// Hulst's (1 - s) (1 - 0.139 s) / (1 + 1.17 s) with s² = 1 - albedo (Multiple Light Scattering, 1980; within
/// 0.0021 of the exact one from an albedo of 0.5 on).
///
/// @param albedo  reduced, of one collision, [0,1]
double halfSpaceAlbedo(double albedo);

/// Of a material that is not translucent: nobody's.
Translucency translucencyOf(const Material& material);

/// In the order of the struct.
const ParamTable& translucencyParams();

/// Makes the material what one member says, translucent where it was not; what it says already changes
/// nothing.
/// - preset: apply() of MaterialPresets.h; Own is no material.
/// - blur: scattering and absorption change by one factor, so that every length inside does and no colour.
/// - glow: sigma_t' of each colour stays; the number of collisions before light is absorbed changes by one
///   factor for all colours, which keeps each albedo in (0, 1). A colour that is not absorbed, or not
///   scattered, counts as 1e6 or 1e-6 collisions. 1: nothing is absorbed.
/// - scatteringPerMm, absorptionPerMm: as they are.
///
/// @param id  of the member
/// @return    an error "is X; ..." where the material would leave what is legal; it is unchanged then
Status store(const Translucency& wanted, std::string_view id, Material& material);

} // namespace lucent::scene
