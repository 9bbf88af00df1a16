#pragma once
/// The lamps of a scene as points that shine, in physical units.

#include "scene/Scene.h"
#include "light/ShadowMap.h"

#include <vector>

namespace lucent::views {

/// A lamp, or one of the points that stand for it. Its irradiance on a surface that faces it is
/// color * cone * (1, or 1 / distance²).
struct LampPoint {
    vec4 place;          ///< world: position, 1; or unit direction to the light, 0
    vec3 centre{0};      ///< of the lamp whose point it is, m
    bool fades = false;  ///< with the square of the distance
    vec3 color{0};       ///< W/sr, or W/m²; its part of the lamp's
    vec3 axis{0};        ///< unit: along which it shines most
    vec2 cone{0, 1};     ///< clamp(cosine to the axis * x + y, 0, 1) to the power of
    float exponent = 1;  ///< this
    bool isPart = false; ///< the lamp has a size and several points
    ShadowSource source; ///< the same point as what shadows are seen from
};

/// Lamps with a size (a point light's ball, a distant light's disc of directions, an area) are so many points
/// each. A lamp's disc faces whatever it lights, so its points lie in a ball, more of them near its surface,
/// such that the ball is an even disc from all sides: density 1 / sqrt(1 - r²), whose integral along a line
/// is pi wherever the line passes.
///
/// Spots fade between their angles by the square of (cos - cos outer) / max(0.001, cos inner - cos outer)
/// (KHR_lights_punctual). Areas shine from one side, radiance times area times the cosine there.
///
/// @param samples  > 0
std::vector<LampPoint> lampPoints(const scene::Scene& scene, int samples);

} // namespace lucent::views
