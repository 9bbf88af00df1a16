#pragma once
/// Light that leaves where it entered: what a scattering object would be were its light to go no way inside.
/// The matt surface with which figure 6.1 of the dissertation compares, of the same brightness.

#include "techniques/subsurface/Splatting.h"

namespace lucent::subsurface {

/// What stands in the way of one point of a lamp.
struct LampShadow {
    views::ShadowViews views;
    graph::TextureId map; ///< none where nothing does
};
Result<LampShadow> recordLampShadow(graph::FrameGraph& graph, gl::Context& context, const Inputs& in,
                                    const std::vector<views::PosedMesh>& objects,
                                    const views::LampPoint& lamp);

/// Adds the passes that sum, at each pixel of the objects, what enters there times the profile's whole
/// integral (diffusion::totalReflectance()); with Inputs::irradiance what arrives there instead. Of the
/// environment by spherical harmonics of order 2, with nothing in its way (Sky.h).
Result<Radiosity> recordLambert(graph::FrameGraph& graph, gl::Context& context, const Inputs& in,
                                const std::vector<views::PosedMesh>& objects, const Settings& settings);

} // namespace lucent::subsurface
