#pragma once
/// Parallel light by way of a sheet of water, as if that lay still (shaders/light/flat_water.glsl).

#include "light/Samples.h"

#include <optional>

namespace lucent::views {

/// The first sheet of water of a scene, at rest; nothing where there is none.
std::optional<light::FlatWaterBlock> flatWater(const scene::Scene& scene);

/// From beneath the water to where light enters it.
///
/// @param toLight  unit, above the surface
/// @return         unit; 0 where all of it is mirrored, by what is thinner than air
vec3 bentBy(const light::FlatWaterBlock& water, const vec3& toLight);

/// Each direction of an environment above the water as two samples: beside the water and through it.
std::vector<LampPoint> withWater(const std::vector<LampPoint>& samples, const light::FlatWaterBlock& water);

/// Around the water's surface.
Bounds surfaceOf(const light::FlatWaterBlock& water);

/// Around what light that enters a sheet of water may reach of a box.
///
/// @param bent  bentBy()
Bounds reachedBelow(const light::FlatWaterBlock& water, const vec3& bent, const Bounds& box);

} // namespace lucent::views
