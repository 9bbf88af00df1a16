#include "techniques/subsurface/Points.h"

#include "base/Log.h"
#include "light/ShadowMap.h"
#include "shaders/subsurface/Blocks.h"
#include "views/Surface.h"

#include <algorithm>
#include <cmath>

namespace lucent::subsurface {

using graph::Format;
using graph::TextureId;

namespace {

constexpr const char* kPlace = "subsurface.place";
constexpr const char* kFlux = "subsurface.flux";
constexpr const char* kNormal = "subsurface.normal";
constexpr const char* kSharpness = "subsurface.sharpness";

Level createLevel(graph::PassBuilder& pass, ivec2 size, bool painted) {
    const graph::TextureDesc desc{.size = size, .format = Format::RGBA32F};
    Level level{.place = pass.createColor(kPlace, desc),
                .flux = pass.createColor(kFlux, desc),
                .normal = pass.createColor(kNormal, desc),
                .size = size};
    if (painted) level.sharpness = pass.createColor(kSharpness, {.size = size, .format = Format::R32F});
    return level;
}

Result<Level> recordMerge(graph::FrameGraph& graph, gl::Context& context, const Level& fine,
                          const MergeBlock& block) {
    const bool painted = bool(fine.sharpness);
    const gl::Program* program = context.program(
        "subsurface/merge", painted ? std::vector<std::string>{"PAINTED"} : std::vector<std::string>{});
    Level level;
    graph.addPass("subsurface.merge", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("points for four blocks each");
        for (const TextureId id : {fine.place, fine.flux, fine.normal})
            pass.sample(id);
        if (painted) pass.sample(fine.sharpness);
        level = createLevel(pass, (fine.size + 1) / 2, painted);
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            graph::Draw draw{.program = program,
                             .block = block,
                             .textures = {{"uPlace", resources[fine.place]},
                                          {"uFlux", resources[fine.flux]},
                                          {"uNormal", resources[fine.normal]}}};
            if (painted) draw.textures.push_back({"uSharpness", resources[fine.sharpness]});
            commands.draw(draw);
        };
    });
    return level;
}

// What the points of a view are made of.
struct Sources {
    TextureId surface, paint{};
    TextureId entered{}, way{};                                // of a layer
    graph::TextureHandle picture = graph::TextureHandle::None; // of a projector
};

Result<Points> recordPoints(graph::FrameGraph& graph, gl::Context& context, const FluxBlock& block,
                            const Sources& from, const Cut& cut, ivec2 size) {
    std::vector<std::string> defines;
    if (from.entered) defines.push_back("OF_LAYER");
    if (from.paint) defines.push_back("PAINTED");
    if (cut.refracted) defines.push_back("REFRACTED");
    const gl::Program* program = context.program("subsurface/flux", defines);
    const TextureId way = cut.refracted ? from.way : TextureId{};
    Points points;
    graph.addPass("subsurface.flux", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("light that enters object \"" + cut.object.object->name + "\"");
        for (const TextureId id : {from.surface, from.paint, from.entered, way})
            if (id) pass.sample(id);
        points.push_back(createLevel(pass, size, bool(from.paint)));
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            graph::Draw draw{
                .program = program, .block = block, .textures = {{"uSurface", resources[from.surface]}}};
            const bool isProjected = from.picture != graph::TextureHandle::None;
            draw.textures.push_back({"uPicture", isProjected ? from.picture : resources[from.surface]});
            if (from.paint) draw.textures.push_back({"uPaint", resources[from.paint]});
            if (from.entered) draw.textures.push_back({"uEntered", resources[from.entered]});
            if (way) draw.textures.push_back({"uWay", resources[way]});
            commands.draw(draw);
        };
    });
    float width = std::max(glm::length(vec3(block.view.right)), glm::length(vec3(block.view.up)));
    while (int(points.size()) < cut.grid.levels && points.back().size != ivec2(1)) {
        width *= 2;
        Result<Level> level = recordMerge(graph, context, points.back(), {width, int(block.view.eye.w)});
        if (!level) return level.error();
        points.push_back(*level);
    }
    return points;
}

FluxBlock blockOf(const views::Eye& eye, ivec2 size, const views::DrawnMesh& object,
                  const Sharpness& sharpness) {
    FluxBlock block{.view = views::viewBlock(eye, size)};
    block.sharpness = {sharpness.most, sharpness.spread, sharpness.blur, float(sharpness.paper)};
    block.object = object.index;
    block.ior = object.object->material.translucent().surfaceIor();
    return block;
}

// @param move  without scale
views::Eye moved(views::Eye eye, const mat4& move) {
    eye.clipFromWorld = eye.clipFromWorld * glm::inverse(move);
    eye.position = vec3(move * vec4(eye.position, 1));
    for (vec3* direction : {&eye.forward, &eye.right, &eye.up})
        *direction = mat3(move) * *direction;
    return eye;
}

// More pixels across a flat object that a lamp grazes: there each stands for a strip that is so much longer.
ivec2 pixelsOfGrazed(ivec2 size, const views::Eye& eye, const views::Bounds& object, const Grid& grid) {
    constexpr float kSteepest = 4; // what finer levels of points make up for
    const vec3 box = object.high - object.low;
    const auto along = [&](const vec3& axis) { return glm::dot(glm::abs(axis), box); };
    const vec2 seen = glm::max(vec2(along(eye.right), along(eye.up)), vec2(1e-12f));
    const vec2 steeper = glm::max(along(eye.forward) / seen / kSteepest, vec2(1));
    const float longest = std::min(glm::length(box) / grid.pixel, float(grid.most));
    return glm::max(size, ivec2(glm::min(vec2(size) * steeper, vec2(longest))));
}

} // namespace

ivec2 pixelsOf(const views::Eye& eye, const scene::Object& object, const Grid& grid) {
    const views::Bounds bounds = views::boundsOf(object);
    const float farthest = glm::dot(bounds.center() - eye.position, eye.forward) + bounds.radius();
    const vec2 extent = 2.0f * eye.halfExtent * (eye.perspective ? farthest : 1.0f);
    const vec2 wanted = glm::ceil(extent / grid.pixel);
    const float most = std::max(wanted.x, wanted.y);
    if (most > grid.spare * float(grid.most))
        warnOnce("subsurface: a light's view of object \"" + object.name + "\" asks for " +
                 std::to_string(std::int64_t(most)) + " pixels a side; " + std::to_string(grid.most) +
                 " are drawn, and its light is patchy");
    return glm::clamp(ivec2(glm::min(wanted, vec2(float(grid.most)))), ivec2(1), ivec2(grid.most));
}

Status recordPeel(graph::FrameGraph& graph, gl::Context& context, const views::Eye& eye,
                  const views::DrawnMesh& object, ivec2 size, TextureId before, TextureId layer,
                  TextureId paint) {
    std::vector<std::string> defines;
    if (!before) defines.push_back("PEEL_FIRST");
    if (paint) defines.push_back("PAINTED");
    const gl::Program* program = context.program("subsurface/peel", defines);
    graph.addPass("subsurface.peel", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("a surface of object \"" + object.object->name + "\" that the environment lights");
        object.sampleFrom(pass);
        if (before) pass.sample(before);
        pass.write(layer);
        pass.clear(layer, vec4(0));
        if (paint) {
            pass.write(paint);
            pass.clear(paint, vec4(1));
        }
        pass.clear(pass.createDepth("subsurface.depth", size, Format::Depth32F), 1.0f);
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            graph::Draw draw{.depthTest = graph::DepthTest::Less};
            if (paint) draw.textures = views::enteringBindings(*object.paint);
            if (before) draw.textures.push_back({"uBefore", resources[before]});
            drawMesh(commands, *program, resources, object, eye, size, object.index, std::move(draw));
        };
    });
    return Done{};
}

Result<Points> recordLit(graph::FrameGraph& graph, gl::Context& context, const views::LampPoint& lamp,
                         const views::Eye& face, const Cut& cut, const views::Drawables& casters) {
    const views::DrawnMesh& object = cut.object;
    const views::Bounds bounds = views::boundsOf(*object.object);
    const ivec2 size = pixelsOfGrazed(pixelsOf(face, *object.object, cut.grid), face, bounds, cut.grid);
    Sources from{.surface = graph.create("subsurface.lit", {.size = size, .format = Format::RGBA32F})};
    if (Status s = views::recordSurface(graph, context, face, casters, from.surface, size); !s)
        return s.error();
    if (object.paint) {
        Result<TextureId> drawn = views::recordEntering(graph, context, face, object, size);
        if (!drawn) return drawn.error();
        from.paint = *drawn;
    }
    if (lamp.picture) {
        const Result<graph::TextureHandle> picture = cut.pictureOf(lamp);
        if (!picture) return picture.error();
        from.picture = *picture;
    }
    FluxBlock block = blockOf(face, size, object, cut.grid.sharpness);
    block.picture = views::pictureBlock(lamp);
    block.color = vec4(lamp.color, lamp.exponent);
    block.axis = vec4(lamp.axis, lamp.fades);
    block.cone = lamp.cone;
    return recordPoints(graph, context, block, from, cut, size);
}

Result<Points> recordLayer(graph::FrameGraph& graph, gl::Context& context, const views::Eye& axis,
                           const Cut& cut, const LitLayer& layer) {
    const auto import = [&](const graph::Texture& texture) {
        return texture ? graph.import(texture.handle(), texture.desc(), texture.label()) : TextureId{};
    };
    const ivec2 size = layer.surface.desc().size;
    const Entered& entered = layer.entered;
    return recordPoints(graph, context, blockOf(axis, size, cut.object, cut.grid.sharpness),
                        {import(layer.surface), import(layer.paint), import(entered.light[entered.now]),
                         import(entered.other[entered.now])},
                        cut, size);
}

scene::Object unmoved(const scene::Object& object) {
    scene::Object same = object;
    same.transform = {.scale = object.transform.scale};
    return same;
}

std::array<views::Eye, 3> axesOf(const views::Bounds& box, int size) {
    std::array<views::Eye, 3> axes;
    for (int i = 0; i < 3; ++i) {
        views::ShadowSource source{.place = vec4(0)};
        source.place[i] = 1;
        axes[std::size_t(i)] = views::shadowViews(source, box, box, size).faces.front();
    }
    return axes;
}

std::array<views::Eye, 3> axesOf(const scene::Object& object, int size) {
    const scene::Object before = unmoved(object);
    const mat4 move = object.transform.worldFromObject() * glm::inverse(before.transform.worldFromObject());
    std::array<views::Eye, 3> axes = axesOf(views::boundsOf(before), size);
    for (views::Eye& eye : axes)
        eye = moved(eye, move);
    return axes;
}

} // namespace lucent::subsurface
