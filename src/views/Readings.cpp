#include "views/Readings.h"

#include <algorithm>

namespace lucent::views {

bool Readings::areDrawn() const {
    return std::all_of(asked_.begin(), asked_.end(), [](const auto& asked) {
        return !asked.second.image.empty() || asked.second.drawn.passed(0);
    });
}

// Programs are asked for by what is recorded, and made while it waits. @return whether it was drawn
Result<bool> Readings::draw(const std::string& question, graph::TexturePool& pool,
                            const std::function<Result<graph::Texture>(graph::FrameGraph&)>& record) {
    graph::FrameGraph graph;
    Result<graph::Texture> texture = record(graph);
    if (!texture) return texture.error();
    if (canDraw_ && !canDraw_()) return false;
    if (Status compiled = graph.compile(); !compiled) return compiled.error();
    graph.execute(pool);
    asked_.emplace(question, Asked{std::move(*texture)});
    return true;
}

Result<const Image*> Readings::of(const std::string& question, graph::TexturePool& pool, gl::Context& context,
                                  const std::function<Result<graph::Texture>(graph::FrameGraph&)>& record) {
    if (!asked_.count(question)) {
        const Result<bool> drawn = draw(question, pool, record);
        if (!drawn) return drawn.error();
        if (!*drawn) return areThere_ = false, nullptr;
    }
    Asked& asked = asked_.at(question);
    if (asked.image.empty()) {
        if (canDraw_ && !asked.drawn.passed(0)) return areThere_ = false, nullptr;
        asked.image = context.device().read(asked.texture.handle());
        asked.texture = graph::Texture();
        if (std::string error = context.takeError(); !error.empty()) return Error{error, Fault::Machine};
    }
    return &asked.image;
}

} // namespace lucent::views
