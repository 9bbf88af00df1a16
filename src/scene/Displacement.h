#pragma once
/// Surfaces that heights lift along their normals (image-space dissertation 2007, ch. 3).
///
/// A point of a triangle with weights w of its corners, which stand at p and have unit normals n, lies at sum
/// w (p + h n) in the height h that its texture coordinates find on the map. All below is solid, down to the
/// triangle itself; where triangles have no neighbour the solid ends in a wall.

#include "base/Param.h"
#include "scene/Scene.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lucent::scene {

/// The space above one triangle. Corners stand counter-clockwise seen from outside.
struct DisplacedTriangle {
    std::array<vec3, 3> places;            ///< m, object space
    std::array<vec3, 3> directions;        ///< unit, in which heights count
    std::array<vec2, 3> coordinates;       ///< in tiles of the map: u to the right and v down
    std::array<std::uint32_t, 3> vertices; ///< of the shape's mesh
    /// Bit i: beside the edge from corner i to the next lies no triangle, or one that the map lies on
    /// otherwise.
    unsigned walls = 0;
};

/// What lies above a shape's triangles.
struct DisplacedBase {
    std::vector<DisplacedTriangle> triangles{};
    bool closed = true;                   ///< each triangle has three neighbours
    std::shared_ptr<const Image> heights; ///< those of the map with one texel more on each side, as tiles
                                          ///< have them beside them
    float highest = 0;                    ///< stored height
    /// Most that a point stands from a triangle, m.
    float reach(const Displacement& displacement) const { return highest * displacement.scale; }
};

/// The base of a displaced object, made once for the same shape and map.
///
/// Spheres have u around the y axis and v from pole to pole, tori u around the ring and v around the tube,
/// planes u along x and v along z, files their first set of coordinates. Corners at the same place share the
/// mean of their normals, so that no gap opens between triangles that meet at an edge.
std::shared_ptr<const DisplacedBase> baseOf(const Object& object);

/// The surface itself as triangles, for what must see a body: about two a texel of the map, but at most
/// kMostDisplacedTriangles. A closed body where the base is, whose seams are closed with the heights of one
/// side; else a sheet, without walls.
Mesh displacedMesh(const Object& object);
inline constexpr std::size_t kMostDisplacedTriangles = 400'000;

/// What no range can say: its shape has coordinates and stands still. Error "heights ...; must ...".
Status checkDisplacement(const Object& object);

const ParamTable& displacementParams();

} // namespace lucent::scene
