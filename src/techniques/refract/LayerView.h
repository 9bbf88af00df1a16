#pragma once
/// A layer of the camera's view itself, as large as the picture, with coverage 0 where there is nothing.

#include "views/Layers.h"

namespace lucent::refract {

/// @param number  of the layer, from 1 on; more than there are: nothing
/// @param show    LayerDepth, LayerNormal or LayerObject
Status recordLayerView(graph::FrameGraph& graph, gl::Context& context, const views::Layers& layers,
                       int number, scene::Aov show, graph::TextureId target);

} // namespace lucent::refract
