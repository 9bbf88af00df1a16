#pragma once
/// One shape in several numbers of triangles: what stages of a picture cost over them.

#include "measure/Plan.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lucent::measure {

/// A mesh to measure on; any size and place.
struct BenchMesh {
    std::string name;
    std::shared_ptr<const scene::Mesh> mesh;
};

/// The mesh scaled and moved so that its box is two metres long and around the origin.
scene::Object objectOf(const BenchMesh& mesh);

/// Points of a series over triangles, the fewest first.
///
/// @param meshes   one shape; empty: spheres, up to as many triangles as the dragon has
/// @param quick    leaves out those of more than a hundred thousand
/// @param pixels   of the scenes
/// @param sceneOf  makes the scene of a mesh
std::vector<Series::Point> overTriangles(std::vector<BenchMesh> meshes, bool quick, double pixels,
                                         const std::function<scene::Scene(const BenchMesh&)>& sceneOf);

/// A stage's time with the most triangles over that with the fewest; at most `target`.
RatioRule growth(const std::string& stage, std::optional<double> target);

} // namespace lucent::measure
