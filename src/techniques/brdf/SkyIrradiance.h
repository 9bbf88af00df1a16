#pragma once
/// Light of an environment on matt surfaces.

#include "base/Math.h"
#include "scene/Scene.h"

#include <array>

namespace lucent::brdf {

/// Irradiance of an environment, with its rotation and intensity and nothing in its way, on a surface with
/// the normal n (unit, world): the sum of these times 1, y, z, x, xy, yz, 3z² - 1, xz, x² - y² of n, W/m².
///
/// Spherical harmonics up to order 2, each times the integral of a clamped cosine, pi, 2 pi / 3, pi / 4
/// (Ramamoorthi, Hanrahan 2001). The worst case is a single small light: of what it brings to a surface that
/// faces it, one at right angles gets 9.4 % instead of nothing, and one that faces away by 122 degrees -4.0
/// %.
std::array<vec3, 9> skyIrradiance(const scene::Environment& environment);

} // namespace lucent::brdf
