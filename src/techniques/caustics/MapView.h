#pragma once
/// A caustic map itself, as large as the picture shows it whole.

#include "techniques/caustics/Caustics.h"

namespace lucent::caustics {

/// @param target  of `size`; coverage 0 beside the map
Status recordMapView(graph::FrameGraph& graph, gl::Context& context, const Map& map, graph::TextureId target,
                     ivec2 size);

} // namespace lucent::caustics
