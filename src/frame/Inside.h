#pragma once
/// Pictures of what the techniques work on: a layer of the camera's view, a caustic map. Each writes what it
/// is worth into an image of the picture's size, with coverage 0 where there is nothing.

#include "techniques/caustics/Caustics.h"
#include "views/Layers.h"

namespace lucent::frame {

/// @param number  of the layer, from 1 on; more than there are: nothing
/// @param show    LayerDepth, LayerNormal or LayerObject
Status recordLayerView(graph::FrameGraph& graph, gl::Context& context, const views::Layers& layers,
                       int number, scene::Aov show, graph::TextureId target);

/// The map as large as the picture shows it whole.
Status recordMapView(graph::FrameGraph& graph, gl::Context& context, const caustics::Map& map,
                     graph::TextureId target, ivec2 size);

/// A picture of nothing.
void recordNothing(graph::FrameGraph& graph, const char* reason, graph::TextureId target);

} // namespace lucent::frame
