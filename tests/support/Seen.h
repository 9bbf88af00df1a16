#pragma once
/// What techniques that shade opaque things are given of a scene: its meshes, posed, and what the eye sees of
/// them.

#include "tests/support/Gl.h"
#include "views/FieldTextures.h"
#include "views/Surface.h"

namespace lucent::support {

/// One frame's graph with the scene posed in it.
struct Seen {
    views::Eye eye;
    views::Drawables drawn;
    views::Drawables all;    ///< the same as they stand; clear things among them
    views::Drawables solids; ///< opaque and visible
    graph::TextureHandle environment = graph::TextureHandle::None;

    /// Records the solids into `surface`, of `size`.
    Seen(graph::FrameGraph& graph, gl::Context& context, views::ImageCache& images, const scene::Scene& scene,
         graph::TextureId surface, ivec2 size)
        : eye(views::makeEye(scene, float(size.x) / float(size.y))),
          drawn(*views::drawablesOf(scene, images)),
          all(*views::recordPose(graph, context, drawn, scene.view.time)), solids(opaque(visible(all))) {
        EXPECT_TRUE(views::recordSurface(graph, context, eye, solids, surface, size).ok());
        if (scene.environment) environment = *images.image(scene.environment->map);
    }
};

/// Runs a graph and reads back what it drew.
inline Image finish(graph::FrameGraph& graph, graph::TexturePool& pool, gl::Context& context,
                    const graph::Texture& target) {
    const Status compiled = graph.compile();
    EXPECT_TRUE(compiled.ok()) << compiled.error().message;
    graph.execute(pool);
    return context.device().read(target.handle());
}

} // namespace lucent::support
