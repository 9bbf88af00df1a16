#pragma once
/// The benchmark of caustics: light that a floor receives by way of glass, water and metal.

#include "measure/Plan.h"
#include "measure/RefractPlan.h"
#include "measure/Sweep.h"
#include "truth/Picture.h"

#include <vector>

namespace lucent::measure {

/// @param meshes  of glass, beside a ball, sine water and a ring of metal
/// @param quick   smaller pictures, fewer settings and repeats
Plan causticsPlan(const std::vector<BenchMesh>& meshes, bool quick);

/// The exact irradiance of what the camera sees, by rays of light; its noise is in the picture.
///
/// @param threads  0: as many as the machine has
Result<truth::Picture> solveCaustics(const scene::Scene& scene, const truth::Tile& rows, int threads);

/// What pictures do not show: the flux that each scene's light brings, takes and loses, for several numbers
/// of rays; how many looks each method needs until all but a hundredth of the light is where it belongs; and
/// what goes astray where the fixed point swings. With the targets that each of them has.
Result<std::vector<Ratio>> proveCaustics(gl::Context& context, const std::vector<BenchMesh>& meshes,
                                         bool quick, const Say& say);

} // namespace lucent::measure
