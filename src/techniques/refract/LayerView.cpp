#include "techniques/refract/LayerView.h"

#include "shaders/refract/Blocks.h"
#include "views/Drawable.h"

namespace lucent::refract {

Status recordLayerView(graph::FrameGraph& graph, gl::Context& context, const views::Layers& layers,
                       int number, scene::Aov show, graph::TextureId target) {
    if (number > layers.count) {
        views::recordNothing(graph, "the view has no such layer", target);
        return Done{};
    }
    std::vector<std::string> defines;
    if (show == scene::Aov::LayerDepth) defines.push_back("SHOW_DEPTH");
    if (show == scene::Aov::LayerNormal) defines.push_back("SHOW_NORMAL");
    const gl::Program* program = context.program("refract/layer_view", defines);
    graph.addPass("refract.layerView", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("layer " + std::to_string(number) + " itself is shown");
        pass.sample(layers.images);
        pass.write(target);
        return [=, images = layers.images](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = LayerBlock{number - 1},
                           .textures = {{"uLayers", resources[images]}}});
        };
    });
    return Done{};
}

} // namespace lucent::refract
