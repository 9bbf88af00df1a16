#pragma once
/// What an artist painted on translucent objects (scene/Painting.h), as textures and as images of a view.

#include "gl/Context.h"
#include "graph/FrameGraph.h"
#include "scene/Painting.h"
#include "scene/Scene.h"
#include "views/Eye.h"

#include <vector>

namespace lucent::views {

struct DrawnMesh;

/// Whether paint on the object does anything: it must be translucent.
bool isPainted(const scene::Object& object);

/// A map of a painting on the GPU, where it comes part by part: a browser takes long to copy all of it.
class PaintMap {
public:
    PaintMap(gl::Device& device, std::shared_ptr<const Image> map);
    /// Takes the next rows there. @return whether there were more
    bool takePart(gl::Device& device);

    graph::TextureHandle texture() const { return texture_.handle(); } ///< RGBA32F, row 0 first
    float least() const { return least_; }                             ///< of the last channel
    float most() const { return most_; }
    std::size_t bytes() const { return texture_.desc().bytes(); }

private:
    std::shared_ptr<const Image> source_;
    graph::Texture texture_;
    int rows_ = 0; // that are there
    float least_, most_;
};

/// Atlas::places as a texture of vertexImageSize(), RG32F.
graph::Texture placeTexture(gl::Device& device, const scene::Atlas& atlas);

/// What a painted object is drawn with.
struct Paint {
    graph::TextureHandle entering, leaving; ///< scene::Painting's maps
    graph::TextureHandle places;
    float bluntest, sharpest; ///< least and largest M_d

    bool isBlurred() const { return bluntest != 1 || sharpest != 1; }
};

/// What shaders/views/paint.glsl samples for what enters.
std::vector<graph::Binding> enteringBindings(const Paint& paint);

/// Draws what is painted on one object where a view shows it.
///
/// @param eye, size  of a surface image: what is painted belongs to those of its pixels that show the object
/// @return           RGBA32F. rgb: M_i times translucency, a: M_d
Result<graph::TextureId> recordEntering(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                                        const DrawnMesh& mesh, ivec2 size);

/// The map itself on painted objects. rgb: M_i, a: M_d
Result<graph::TextureId> recordEnteringMap(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                                           const std::vector<DrawnMesh>& meshes, ivec2 size);

/// The same for what leaves painted objects. rgb: its factor; a: translucency
Result<graph::TextureId> recordLeaving(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                                       const std::vector<DrawnMesh>& meshes, ivec2 size);

} // namespace lucent::views
