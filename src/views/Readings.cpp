#include "views/Readings.h"

#include <algorithm>

namespace lucent::views {

namespace {

// The greatest red of each block of pixels, so that little is read back.
graph::Texture recordMaxima(graph::FrameGraph& graph, gl::Context& context, graph::TextureId values) {
    constexpr int kBlock = 16; // as in the shader
    const graph::TextureDesc desc{.size = (graph.descOf(values).size + kBlock - 1) / kBlock,
                                  .format = graph::Format::RGBA32F};
    graph::Texture maxima(context.device(), desc, "views.maxima");
    const graph::TextureId target = graph.import(maxima.handle(), desc, maxima.label());
    graph.keep(target);
    const gl::Program* program = context.program("views/maxima");
    graph.addPass("views.maxima", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("the greatest value of each block, so that little is read back");
        pass.sample(values);
        pass.write(target);
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program, .textures = {{"uValues", resources[values]}}});
        };
    });
    return maxima;
}

} // namespace

bool Readings::areDrawn() const {
    return std::all_of(asked_.begin(), asked_.end(),
                       [](const auto& asked) { return asked.second.answer || asked.second.drawn.passed(0); });
}

// Programs are asked for by what is recorded, and made while it waits. @return whether it was drawn
Result<bool> Readings::draw(const std::string& question, graph::TexturePool& pool, gl::Context& context,
                            const std::function<Result<graph::TextureId>(graph::FrameGraph&)>& record) {
    graph::FrameGraph graph;
    const Result<graph::TextureId> values = record(graph);
    if (!values) return values.error();
    graph::Texture maxima = recordMaxima(graph, context, *values);
    if (canDraw_ && !canDraw_()) return false;
    if (Status compiled = graph.compile(); !compiled) return compiled.error();
    graph.execute(pool);
    asked_.emplace(question, Asked{std::move(maxima)});
    return true;
}

Result<std::optional<float>>
Readings::most(const std::string& question, graph::TexturePool& pool, gl::Context& context,
               const std::function<Result<graph::TextureId>(graph::FrameGraph&)>& record) {
    if (!asked_.count(question)) {
        const Result<bool> drawn = draw(question, pool, context, record);
        if (!drawn) return drawn.error();
        if (!*drawn) return ++missing_, std::optional<float>();
    }
    Asked& asked = asked_.at(question);
    if (!asked.answer) {
        // Reading waits for all that was given to the GPU, not for this alone.
        if (canDraw_ && !areDrawn()) return ++missing_, std::optional<float>();
        const Image image = context.device().read(asked.maxima.handle());
        asked.maxima = graph::Texture();
        float most = 0;
        for (std::size_t i = 0; i < image.pixels.size(); i += 4)
            most = std::max(most, image.pixels[i]);
        asked.answer = most;
        if (std::string error = context.takeError(); !error.empty()) return Error{error, Fault::Machine};
    }
    return asked.answer;
}

} // namespace lucent::views
