#include "techniques/caustics/MapView.h"

#include <algorithm>
#include <cstddef>

namespace lucent::caustics {

namespace {

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

Status recordMapView(graph::FrameGraph& graph, gl::Context& context, const Map& map, graph::TextureId target,
                     ivec2 size) {
    const gl::Program* program = context.program("caustics/map_view");
    const vec2 room(size), all(map.size);
    const float texels = std::max(all.x / room.x, all.y / room.y);
    const MapBlock block{(room - all / texels) / 2.0f, texels};
    graph.addPass("caustics.mapView", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("the caustic map itself is shown");
        pass.sample(map.flux);
        pass.sample(map.depths);
        pass.write(target);
        return [=, flux = map.flux, depths = map.depths](const graph::Resources& resources,
                                                         graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = block,
                           .textures = {{"uMap", resources[flux]}, {"uShadow", resources[depths]}}});
        };
    });
    return Done{};
}

} // namespace lucent::caustics
