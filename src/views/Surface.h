#pragma once
/// The camera's view of the scene: for each pixel the first point it meets (one layer).

#include "views/Drawable.h"

namespace lucent::views {

/// Draws the surface image (layout: shaders/views/surface_pixel.glsl) into `target`, RGBA32F; of the second
/// object in each pixel where the eye asks for that (Eye::second).
Status recordSurface(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                     const Drawables& drawables, graph::TextureId target, ivec2 size);

/// Draws a geometric AOV (normal, depth or position) of the surface image into `target`.
Status recordGeometry(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                      const Drawables& drawables, graph::TextureId surface, graph::TextureId target,
                      scene::Aov aov, ivec2 size);

/// Draws depth, normal and coverage of the surface image into `target`, RGBA32F, as uSolid of
/// shaders/views/layers.glsl has them: what rays through refractive objects may end on.
Status recordSolid(graph::FrameGraph& graph, gl::Context& context, const Eye& eye, const Drawables& drawables,
                   graph::TextureId surface, graph::TextureId target, ivec2 size);

/// Draws into `target`, R16F, the optical depth of blended meshes before the first surface of each pixel.
///
/// @param first    where that is: a surface image, or views::Layers::images
/// @param defines  OF_LAYERS for these
Status recordOpticalDepth(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                          const Drawables& blended, graph::TextureId first, graph::TextureId target,
                          ivec2 size, const std::vector<std::string>& defines);

} // namespace lucent::views
