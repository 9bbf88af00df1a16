#pragma once
/// Light on matt objects, slice by slice as a frame sums it.

#include "techniques/brdf/Brdf.h"

#include <gtest/gtest.h>

namespace lucent::support {

/// What a picture of matt objects is made of besides its light.
struct MattView {
    const scene::Scene& scene;
    const views::Eye& eye;
    ivec2 size;
    graph::TextureId surface;
    views::Drawables matt; ///< visible
    views::Drawables all;  ///< that stands in the way of light
    scene::Aov show;
    graph::TextureId flux{};
};

/// Adds the light of all samples to the matt pixels of `target`; the others stay as they were.
inline void recordMatt(graph::FrameGraph& graph, gl::Context& context, const MattView& in,
                       graph::Texture& lightTable, graph::TextureId target, const views::Sampling& sampling) {
    const std::vector<views::LampPoint> samples = views::lightSamples(in.scene, sampling);
    const Image table = views::sampleTable(samples);
    const graph::TextureDesc desc{.size = table.size(), .format = graph::Format::RGBA32F};
    lightTable = graph::Texture(context.device(), desc, "samples");
    context.device().upload(lightTable.handle(), 0, table.pixels);
    const graph::TextureId tableId = graph.import(lightTable.handle(), desc, "samples");
    const int count = int(samples.size()), most = views::mostSamplesAtOnce(context, in.size);
    graph::TextureId sum;
    for (int first = 0; first == 0 || first < count; first += most) {
        const int end = std::min(count, first + most);
        const auto occlusion =
            views::recordOcclusion(graph, context,
                                   {.eye = in.eye,
                                    .size = in.size,
                                    .surface = in.surface,
                                    .drawables = in.all,
                                    .shadowSize = sampling.shadowSize},
                                   std::span(samples).subspan(std::size_t(first), std::size_t(end - first)));
        ASSERT_TRUE(occlusion.ok()) << occlusion.error().message;
        graph::TextureId drawn = target;
        if (end < count)
            graph.addPass("clear", [&](graph::PassBuilder& pass) -> graph::Execute {
                drawn = pass.createColor("sum", {.size = in.size, .format = graph::Format::RGBA32F});
                pass.clear(drawn, vec4(0));
                return [](const graph::Resources&, graph::Commands&) {};
            });
        const Status recorded = brdf::Brdf(context).record(graph, {.scene = in.scene,
                                                                   .eye = in.eye,
                                                                   .size = in.size,
                                                                   .solids = in.matt,
                                                                   .surface = in.surface,
                                                                   .lightTable = tableId,
                                                                   .first = first,
                                                                   .end = end,
                                                                   .occlusion = *occlusion,
                                                                   .flux = in.flux,
                                                                   .sum = sum,
                                                                   .target = drawn,
                                                                   .show = in.show});
        ASSERT_TRUE(recorded.ok()) << recorded.error().message;
        sum = drawn;
    }
}

} // namespace lucent::support
