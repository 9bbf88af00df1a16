#pragma once
/// The benchmark of refraction: directions of light behind glass, and what they cost over triangles.

#include "measure/MeshSeries.h"
#include "measure/Plan.h"
#include "truth/Picture.h"

#include <vector>

namespace lucent::measure {

/// @param meshes   measured beside sphere, torus, box and nested spheres
/// @param simpler  one shape in several numbers of triangles, for the cost over triangles; empty: spheres
/// @param quick    smaller pictures, fewer repeats, no more than a hundred thousand triangles
Plan refractPlan(const std::vector<BenchMesh>& meshes, const std::vector<BenchMesh>& simpler, bool quick);

/// A clear mesh under the rainbow, scaled and moved so that its box is two metres long and in the picture's
/// middle; shows directions.
scene::Scene glassScene(const BenchMesh& mesh, int size);

/// Rows of the exact directions or of the numbers of layers, whichever the scene shows.
///
/// @param threads  0: as many as the machine has
Result<truth::Picture> solveRefraction(const scene::Scene& scene, const truth::Tile& rows, int threads);

} // namespace lucent::measure
