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

/// A sum over light samples in one view, which outlives the graphs that add to it.
struct Entered {
    graph::Texture light[2]; ///< W/m² that enters; the sum and the one before it, in turns
    graph::Texture other[2]; ///< shaders/subsurface/enter.frag
    int now = 0;
};

/// One surface of an object along an axis.
struct LitLayer {
    graph::Texture surface; ///< shaders/subsurface/peel.frag
    graph::Texture paint;   ///< of painted objects: what enters there
    Entered entered;
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

/// How points are made of what a view shows of an object.
struct Cut {
    const views::DrawnMesh& object;
    const Grid& grid;
    bool refracted = false; ///< `normal` holds the way on which light goes on inside instead
    views::PictureOf pictureOf{};
};

/// Points of an object that a lamp sees.
///
/// @param face     one of the lamp's views of the object
/// @param casters  all that stands in the light's way, the object among it
Result<Points> recordLit(graph::FrameGraph& graph, gl::Context& context, const views::LampPoint& lamp,
                         const views::Eye& face, const Cut& cut, const views::Drawables& casters);

/// Points of one layer of an object along an axis.
Result<Points> recordLayer(graph::FrameGraph& graph, gl::Context& context, const views::Eye& axis,
                           const Cut& cut, const LitLayer& layer);

/// Draws one layer of an object along an axis: the surface behind another one.
///
/// @param before  the layer before; none: there is none
/// @param layer   RGBA32F; paint: none, or the same
Status recordPeel(graph::FrameGraph& graph, gl::Context& context, const views::Eye& eye,
                  const views::DrawnMesh& object, ivec2 size, graph::TextureId before, graph::TextureId layer,
                  graph::TextureId paint);

/// The object as large as it is, but neither moved nor turned: what depends on its shape and size alone.
scene::Object unmoved(const scene::Object& object);

/// Views of a box along x, y and z.
std::array<views::Eye, 3> axesOf(const views::Bounds& box, int size);
/// Views of an object along its own x, y and z: they show the same however it moves and turns.
std::array<views::Eye, 3> axesOf(const scene::Object& object, int size);

} // namespace lucent::subsurface
