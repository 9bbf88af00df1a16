#pragma once
/// Light of an environment that enters through a smooth surface.

#include "base/Math.h"
#include "scene/Scene.h"

#include <array>

namespace lucent::subsurface {

/// Light of an environment, with nothing in its way, that enters a surface with the normal n (unit, world) of
/// a medium with this index: the sum of these times 1, y, z, x, xy, yz, 3z² - 1, xz, x² - y² of n, W/m².
///
/// Spherical harmonics up to order 2, each times the integral of F_t(cos) cos over the hemisphere
/// (dissertation 2007, eq. 6.19-6.21).
std::array<vec3, 9> enteringSky(const scene::Environment& environment, double ior);

} // namespace lucent::subsurface
