#include "frame/Inside.h"

#include <algorithm>
#include <cstddef>

namespace lucent::frame {

using graph::TextureId;

namespace {

struct LayerBlock {
    int layer;
    int padding[3] = {};

    static const graph::BlockLayout& layout() {
        static const graph::BlockLayout::Member members[] = {{"layer", offsetof(LayerBlock, layer)}};
        static const graph::BlockLayout layout{"LayerBlock", sizeof(LayerBlock), members};
        return layout;
    }
};

struct MapBlock {
    vec2 corner;
    float texels;
    int padding = 0;

    static const graph::BlockLayout& layout() {
        static const graph::BlockLayout::Member members[] = {{"corner", offsetof(MapBlock, corner)},
                                                             {"texels", offsetof(MapBlock, texels)}};
        static const graph::BlockLayout layout{"MapBlock", sizeof(MapBlock), members};
        return layout;
    }
};

} // namespace

Status recordLayerView(graph::FrameGraph& graph, gl::Context& context, const views::Layers& layers,
                       int number, scene::Aov show, TextureId target) {
    if (number > layers.count) {
        recordNothing(graph, "the view has no such layer", target);
        return Done{};
    }
    std::vector<std::string> defines;
    if (show == scene::Aov::LayerDepth) defines.push_back("SHOW_DEPTH");
    if (show == scene::Aov::LayerNormal) defines.push_back("SHOW_NORMAL");
    Result<const gl::Program*> program = context.program("frame/layer", defines);
    if (!program) return program.error();
    graph.addPass("frame.layer", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("layer " + std::to_string(number) + " itself is shown");
        pass.sample(layers.images);
        pass.write(target);
        return [=, program = *program, images = layers.images](const graph::Resources& resources,
                                                               graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = LayerBlock{number - 1},
                           .textures = {{"uLayers", resources[images]}}});
        };
    });
    return Done{};
}

Status recordMapView(graph::FrameGraph& graph, gl::Context& context, const caustics::Map& map,
                     TextureId target, ivec2 size) {
    Result<const gl::Program*> program = context.program("frame/map");
    if (!program) return program.error();
    const vec2 room(size), all(map.size);
    const float texels = std::max(all.x / room.x, all.y / room.y);
    const MapBlock block{(room - all / texels) / 2.0f, texels};
    graph.addPass("frame.map", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("the caustic map itself is shown");
        pass.sample(map.flux);
        pass.sample(map.depths);
        pass.write(target);
        return [=, program = *program, flux = map.flux,
                depths = map.depths](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = block,
                           .textures = {{"uMap", resources[flux]}, {"uShadow", resources[depths]}}});
        };
    });
    return Done{};
}

void recordNothing(graph::FrameGraph& graph, const char* reason, TextureId target) {
    graph.addPass("frame.nothing", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(reason);
        pass.write(target);
        pass.clear(target, vec4(0));
        return [](const graph::Resources&, graph::Commands&) {};
    });
}

} // namespace lucent::frame
