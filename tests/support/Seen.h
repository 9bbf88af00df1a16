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
    views::DrawnMeshes drawn;
    std::vector<views::PosedMesh> all;    ///< clear things among them
    std::vector<views::PosedMesh> solids; ///< opaque and visible
    graph::TextureHandle environment = graph::TextureHandle::None;

    /// Records the solids into `surface`, of `size`.
    Seen(graph::FrameGraph& graph, gl::Context& context, views::ImageCache& images, const scene::Scene& scene,
         graph::TextureId surface, ivec2 size)
        : eye(views::makeEye(scene, float(size.x) / float(size.y))),
          drawn(*views::drawnMeshes(scene, images, true)) {
        std::vector<views::DrawnMesh> meshes = drawn.solid;
        meshes.insert(meshes.end(), drawn.glass.begin(), drawn.glass.end());
        all = *views::recordPose(graph, context, meshes, scene.view.time);
        solids = all;
        std::erase_if(solids, [](const views::PosedMesh& mesh) {
            return !mesh.drawn.object->visible || mesh.drawn.object->material.isRefractive();
        });
        EXPECT_TRUE(views::recordSurface(graph, context, eye, {}, solids, surface, size).ok());
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
