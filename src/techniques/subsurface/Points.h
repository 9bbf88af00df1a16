#pragma once
/// The surface of an object as a light sees it, or along an axis, as points that hold the light that entered
/// there (shaders/subsurface/points.glsl).

#include "light/Samples.h"
#include "views/Meshes.h"

#include <array>
#include <vector>

namespace lucent::subsurface {

/// Points that each stand for a block of a view's pixels.
struct Level {
    graph::TextureId place, flux, normal;
    graph::TextureId sharpness{}; ///< of painted objects
    ivec2 size{0};
};

/// Levels of the same light, finest first; a block of one is four of the level before.
using Points = std::vector<Level>;

/// Which M_d the points of a painted object can carry.
struct Sharpness {
    float most = scene::kMostSharpness; ///< larger ones count as this
    float spread = 0, blur = 0; ///< m: radius within which half of the profile's light leaves, and what
                                ///< it was blurred by; blur 0: not at all, or at every M_d alike
    bool paper = false;         ///< without the factor M_d² of the light
};

/// How finely a view is cut.
struct Grid {
    float pixel = 0; ///< m on a surface that faces the view: width of a block of the finest level
    int levels = 1;  ///< at most; fewer where a level has one block
    int most = 0;    ///< pixels a side
    float spare = 1; ///< blocks up to so many times as wide still do, but where the view grazes the surface
    Sharpness sharpness{};
};
/// Pixels of the finest level, for an object in this view. Where they are wider than what does, a warning
/// names the object.
ivec2 pixelsOf(const views::Eye& eye, const scene::Object& object, const Grid& grid);

/// Points of an object that a lamp sees.
///
/// @param face     one of the lamp's views of the object
/// @param casters  all meshes that stand in the light's way, the object among them
/// @param fields   height fields that do
Result<Points> recordLit(graph::FrameGraph& graph, gl::Context& context, const views::LampPoint& lamp,
                         const views::Eye& face, const views::PosedMesh& object,
                         const std::vector<views::PosedMesh>& casters,
                         const std::vector<views::DrawnObject>& fields, const Grid& grid);

/// Points of all surfaces of an object behind each other along an axis, one list a layer.
///
/// @param axis  a view of the object along an axis
/// @param sky   what enters by the normal (Sky.h)
Result<std::vector<Points>> recordSky(graph::FrameGraph& graph, gl::Context& context, const views::Eye& axis,
                                      const views::PosedMesh& object, int layers,
                                      const std::array<vec3, 9>& sky, const Grid& grid);

/// The object as large as it is, but neither moved nor turned: what depends on its shape and size alone.
scene::Object unmoved(const scene::Object& object);

/// Views of a box along x, y and z.
std::array<views::Eye, 3> axesOf(const views::Bounds& box, int size);
/// Views of an object along its own x, y and z: they show the same however it moves and turns.
std::array<views::Eye, 3> axesOf(const scene::Object& object, int size);

} // namespace lucent::subsurface
