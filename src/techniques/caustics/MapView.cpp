#include "techniques/caustics/MapView.h"

#include "shaders/caustics/Blocks.h"

#include <algorithm>

namespace lucent::caustics {

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
