#pragma once
/// Reads vertices back that a frame graph has moved.

#include "gl/Context.h"
#include "graph/FrameGraph.h"
#include "views/FieldTextures.h"
#include "views/Meshes.h"

#include <gtest/gtest.h>

namespace lucent::support {

struct Vertices {
    std::vector<vec3> positions, normals;
    int passes = 0; ///< that moved them
};

// The device reads the last row of texels first.
inline std::vector<vec3> valuesOf(const Image& image, std::size_t count) {
    std::vector<vec3> values;
    for (std::size_t i = 0; i < count; ++i) {
        const float* texel = image.at(int(i) % image.width, image.height - 1 - int(i) / image.width);
        values.push_back({texel[0], texel[1], texel[2]});
    }
    return values;
}

/// Vertices of a scene's first object, which is opaque, as a frame at `time` has them.
inline Vertices verticesAt(gl::Context& context, const scene::Scene& scene, float time,
                           const views::Waters* waters = nullptr) {
    graph::TexturePool pool(context.device());
    views::ImageCache images(context);
    graph::FrameGraph graph;
    const auto posed = views::recordPose(graph, context, *views::drawablesOf(scene, images, waters), time);
    EXPECT_TRUE(posed.ok()) << posed.error().message;
    const graph::Texture target(context.device(), {.size = {1, 1}}, "reader");
    const graph::TextureId targetId = graph.import(target.handle(), target.desc(), target.label());
    graph.keep(targetId);
    Vertices found;
    graph.addPass("reader", [&](graph::PassBuilder& pass) -> graph::Execute {
        const views::DrawnMesh& mesh = *posed->front()->mesh();
        mesh.sampleFrom(pass);
        pass.write(targetId);
        return [&](const graph::Resources& resources, graph::Commands&) {
            const std::size_t count = scene::meshOf(scene.objects[0])->positions.size();
            found.positions = valuesOf(context.device().read(resources[mesh.positions]), count);
            found.normals = valuesOf(context.device().read(resources[mesh.normals]), count);
        };
    });
    const Status compiled = graph.compile();
    EXPECT_TRUE(compiled.ok()) << compiled.error().message;
    graph.execute(pool);
    found.passes = graph.livePasses() - 1;
    return found;
}

} // namespace lucent::support
