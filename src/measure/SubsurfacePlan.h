#pragma once
/// The benchmark of light inside: what leaves bodies, by every method and profile, and what it costs.

#include "measure/MeshSeries.h"
#include "measure/Plan.h"
#include "measure/Sweep.h"

#include <vector>

namespace lucent::subsurface {
struct Settings;
}

namespace lucent::measure {

/// A ball of marble, 20 mm wide, seen along -z under light of 1 W/m² from the right; what is shown is the
/// radiosity.
scene::Scene marbleBall(int size);
subsurface::Settings& subsurfaceSettings(scene::Scene& scene);

/// What has no scale of its own or too fine a one for any picture: on that ball, whose light is known by its
/// angle.
HardTable subsurfaceHardCases();

/// @param meshes   of marble, 20 mm long, beside a ball and a half space
/// @param simpler  one shape in several numbers of triangles, for the cost over triangles; empty: spheres
/// @param quick    smaller pictures, fewer settings and repeats, no random walks in meshes
Plan subsurfacePlan(const std::vector<BenchMesh>& meshes, const std::vector<BenchMesh>& simpler, bool quick);

/// What single pictures do not show: the largest error on a half space and beside a ball, light that leaks
/// into what touches a lit body, the light around a ball against random walks by angle, what of it scatters
/// once, what painting costs, and the flicker of a body that turns, with and without `temporal`. With the
/// targets that each of them has.
///
/// @param meshes  as above; the first turns, a block where there is none
/// @param solve   as for Sweep
Result<std::vector<Ratio>> proveSubsurface(gl::Context& context, const std::vector<BenchMesh>& meshes,
                                           const SolveTruth& solve, bool quick, const Say& say);

} // namespace lucent::measure
