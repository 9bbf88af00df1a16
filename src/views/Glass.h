#pragma once
/// Refractive objects as shaders see them (shaders/views/glass_block.glsl).

#include "views/Drawable.h"

namespace lucent::views {

/// A view traces at most kMostGlass refractive objects.
GlassBlock glassBlock(const scene::Material& material);

/// Indices of refraction at the lines C, d and F (656, 588, 486 nm), which stand for red, green and blue:
/// n = A + B / wavelength² with the Abbe number 20 / dispersion = (n_d - 1) / (n_F - n_C), as
/// KHR_materials_dispersion has it.
vec3 iorsOf(const scene::Clear& material);

/// Whether light of different colours takes different ways through any of them.
bool disperses(const Drawables& glass);

} // namespace lucent::views
