#include "views/Surface.h"

#include <algorithm>

namespace lucent::views {

namespace {

// @param first  surface image of the objects that are left out in its pixels, or none
void drawSurface(graph::FrameGraph& graph, gl::Context& context, const Eye& eye, const Drawables& drawables,
                 graph::TextureId target, ivec2 size, graph::TextureId first) {
    graph.addPass("views.surface", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason((first ? "behind the first object the first point of " : "the first point of ") +
                    std::to_string(drawables.size()) + " visible object(s) that each pixel meets");
        std::vector<std::string> defines;
        if (first) defines.push_back("SECOND");
        if (eye.isCut()) defines.push_back("CUT");
        std::vector<Drawing> drawings = drawingsOf(context, pass, drawables, ViewKind::Surface, defines);
        if (first) pass.sample(first);
        pass.write(target);
        pass.clear(target, vec4(0));
        const bool hides =
            drawables.size() > 1 || std::any_of(drawables.begin(), drawables.end(),
                                                [](const auto& one) { return !one->drawsNearest(); });
        if (hides) pass.clear(pass.createDepth("views.depth", size), 1.0f);
        return [=, depthTest = hides ? graph::DepthTest::Less : graph::DepthTest::None](
                   const graph::Resources& resources, graph::Commands& commands) {
            graph::Draw how{.depthTest = depthTest};
            if (first) how.textures = {{"uFirst", resources[first]}};
            for (const Drawing& draw : drawings)
                draw(resources, commands, eye, size, how);
        };
    });
}

} // namespace

Status recordSurface(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                     const Drawables& drawables, graph::TextureId target, ivec2 size) {
    graph::TextureId first;
    if (eye.second) {
        first = graph.create("views.first", {.size = size, .format = graph::Format::RGBA32F});
        drawSurface(graph, context, eye, drawables, first, size, {});
    }
    drawSurface(graph, context, eye, drawables, target, size, first);
    return Done{};
}

namespace {

const char* switchFor(scene::Aov aov) {
    switch (aov) {
    case scene::Aov::Normal:
        return "SHOW_NORMAL";
    case scene::Aov::Position:
        return "SHOW_POSITION";
    default:
        return "SHOW_DEPTH";
    }
}

// `quantity`: a switch of views/geometry.frag.
Status recordQuantity(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                      const Drawables& drawables, graph::TextureId surface, graph::TextureId target,
                      ivec2 size, const char* quantity, const std::string& reason) {
    std::vector<graph::Draw> draws;
    for (const auto& one : drawables)
        if (auto draw = one->geometry(context, eye, quantity)) draws.push_back(std::move(*draw));
    if (draws.size() < drawables.size()) // one draw for all whose pixels hold depth and normal
        draws.push_back({.program = context.program("views/geometry", {quantity, "OF_MESHES"}),
                         .block = SolidBlock{viewBlock(eye, size)}});
    graph.addPass("views.geometry", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(reason);
        pass.sample(surface);
        pass.write(target);
        pass.clear(target, vec4(0));
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            for (graph::Draw draw : draws) {
                draw.textures.push_back({"uSurface", resources[surface]});
                commands.draw(draw);
            }
        };
    });
    return Done{};
}

} // namespace

Status recordGeometry(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                      const Drawables& drawables, graph::TextureId surface, graph::TextureId target,
                      scene::Aov aov, ivec2 size) {
    return recordQuantity(graph, context, eye, drawables, surface, target, size, switchFor(aov),
                          "view.show asks for \"" + std::string(scene::aovNames()[std::size_t(aov)]) + "\"");
}

Status recordSolid(graph::FrameGraph& graph, gl::Context& context, const Eye& eye, const Drawables& drawables,
                   graph::TextureId surface, graph::TextureId target, ivec2 size) {
    return recordQuantity(graph, context, eye, drawables, surface, target, size, "SHOW_SOLID",
                          "opaque surfaces on which rays through refractive objects end");
}

Status recordOpticalDepth(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                          const Drawables& blended, graph::TextureId first, graph::TextureId target,
                          ivec2 size, const std::vector<std::string>& defines) {
    graph.addPass("views.opticalDepth", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("what " + std::to_string(blended.size()) + " blended object(s) take of the light");
        pass.sample(first);
        pass.write(target);
        pass.clear(target, vec4(0));
        return [=, drawings = drawingsOf(context, pass, blended, ViewKind::OpticalDepth, defines)](
                   const graph::Resources& resources, graph::Commands& commands) {
            for (const Drawing& draw : drawings)
                draw(resources, commands, eye, size,
                     {.blend = graph::Blend::Add, .textures = {{"uFirst", resources[first]}}});
        };
    });
    return Done{};
}

} // namespace lucent::views
