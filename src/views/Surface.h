#pragma once
/// The camera's view of the scene: for each pixel the first point it meets (one layer).

#include "graph/FrameGraph.h"
#include "scene/Scene.h"
#include "views/Eye.h"
#include "views/FieldTextures.h"

#include <vector>

namespace lucent::views {

/// A visible object with its textures.
struct DrawnObject {
    const scene::Object* object = nullptr;
    int index = 0; ///< in the scene
    const FieldTextures* field = nullptr;
    graph::TextureHandle alpha = graph::TextureHandle::None;
    graph::TextureHandle baseMap = graph::TextureHandle::None;
    graph::TextureHandle diffuseMap = graph::TextureHandle::None;
    graph::TextureHandle specularMap = graph::TextureHandle::None;
};

/// Looks the textures of a scene's height fields up.
///
/// @param hiddenToo  those that the camera does not see as well
Result<std::vector<DrawnObject>> drawnObjects(const scene::Scene& scene, ImageCache& images,
                                              bool hiddenToo = false);

/// Draws one height field with shaders/views/surface.vert.
///
/// @param program  views/surface, or a variant of it
/// @param size     of the view in pixels; it stands at the corner of draw.region
/// @param draw     how, and what else is bound
void drawField(graph::Commands& commands, const gl::Program& program, const DrawnObject& drawn,
               const Eye& eye, ivec2 size, graph::Draw draw);

/// Draws the surface image (layout: shaders/views/surface_pixel.glsl) into `target`, RGBA32F.
///
/// @param solids  opaque objects and mirrors that are no height fields
Status recordSurface(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                     const std::vector<DrawnObject>& fields, const std::vector<PosedMesh>& solids,
                     graph::TextureId target, ivec2 size);

/// Draws a geometric AOV (normal, depth or position) of the surface image into `target`.
Status recordGeometry(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                      const std::vector<DrawnObject>& fields, const std::vector<PosedMesh>& solids,
                      graph::TextureId surface, graph::TextureId target, scene::Aov aov, ivec2 size);

/// Draws depth, normal and coverage of the surface image into `target`, RGBA32F, as uSolid of
/// shaders/views/layers.glsl has them: what rays through refractive objects may end on.
Status recordSolid(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                   const std::vector<DrawnObject>& fields, const std::vector<PosedMesh>& solids,
                   graph::TextureId surface, graph::TextureId target, ivec2 size);

} // namespace lucent::views
