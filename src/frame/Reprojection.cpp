// Temporal reprojection: what is shown of the last picture while the next one is drawn. One that is drawn
// smaller is kept for that; so is the last one before a camera that moves.
#include "frame/RendererState.h"

#include "views/Surface.h"

#include <algorithm>

namespace lucent::frame {

using graph::Format;
using graph::TextureDesc;
using graph::TextureId;
using technique::Guest;
using technique::Passes;

namespace {

constexpr int kMostCells = 64; // along the longer side; outlines are drawn by pixels

void makeFor(graph::Texture& texture, gl::Context& context, const TextureDesc& desc, const char* label) {
    if (!texture || texture.desc() != desc) texture = graph::Texture(context.device(), desc, label);
}

} // namespace

views::Eye Renderer::State::middleEyeOf(const scene::Scene& scene) const {
    return views::makeEye(scene, aspect());
}

// Whether pictures may be seen from elsewhere before the next one is there. Reliefs alone are drawn as fast.
bool Renderer::State::isReprojected(const scene::Scene& scene) const {
    return own && !atOnce && scene.view.show == scene::Aov::Color &&
           std::any_of(scene.objects.begin(), scene.objects.end(),
                       [](const scene::Object& object) { return object.visible && !object.isField(); });
}

// An environment that is seen is known in all directions, not only in those that a picture shows.
Renderer::State::Reprojecting Renderer::State::reprojecting(const scene::Scene& scene) const {
    if (!composed || !views::hasEnvironment(scene)) return {context.program("frame/reproject"), nullptr};
    return {context.program("frame/reproject", {"ENVIRONMENT"}),
            context.program("frame/background", {"ALONE"})};
}

// How far what the picture shows lies from the eye. Its samples share that of the first.
Status Renderer::State::recordDepth(const Passes& passes) {
    if (own && size != screen) { // they are made meanwhile
        (void)displayProgram(false, true);
        (void)scaledProgram();
    }
    if (!isReprojected(passes.picture.scene)) {
        depth = graph::Texture();
        return Done{};
    }
    if (sample > 0) return Done{};
    makeFor(depth, context, {.size = size, .format = Format::R32F}, "frame.depth");
    graph::FrameGraph& graph = passes.graph;
    const TextureId solid = graph.create("frame.solid", {.size = size, .format = Format::RGBA32F});
    const views::Drawables solids = opaque(visible(passes.posed));
    if (Status s =
            views::recordSolid(graph, context, passes.picture.eye, solids, passes.surface, solid, size);
        !s)
        return s;
    const Guest* const last = replacing(passes.picture);
    const TextureId layers = last ? last->layersOf() : TextureId{};
    const gl::Program* program = context.program("frame/depth", layers ? std::vector<std::string>{"OF_LAYERS"}
                                                                       : std::vector<std::string>{});
    if (!stages[stage].coarse) (void)reprojecting(passes.picture.scene); // they are made meanwhile,
    (void)displayProgram(true, composed || pixelSamples(passes.picture.scene) > 1); // and that of keep()
    const TextureId target = import(graph, depth);
    graph.keep(target);
    graph.addPass("frame.depth", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("how far what is seen lies away, by which it is reprojected when the camera moves");
        pass.sample(solid);
        if (layers) pass.sample(layers);
        pass.write(target);
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            graph::Draw draw{.program = program, .textures = {{"uSolid", resources[solid]}}};
            if (layers) draw.textures.push_back({"uLayers", resources[layers]});
            commands.draw(draw);
        };
    });
    return Done{};
}

// The picture that is shown, as linear values, with its depths.
Status Renderer::State::keep(const scene::Scene& scene) {
    makeFor(kept.light, context, {.size = size, .format = Format::RGBA32F}, "frame.kept");
    kept.eye = eyeShown;
    if (Status drawn = runGraph([&](graph::FrameGraph& graph) {
            return recordDisplay(graph, scene, import(graph, kept.light), true);
        });
        !drawn)
        return drawn;
    if (!isReprojected(scene)) depth = graph::Texture(); // it is of a picture before
    std::swap(kept.depth, depth);
    return Done{};
}

// Keeps a picture of the whole size for a camera that moves on: the next one is drawn over it.
Status Renderer::State::keepFor(const scene::Scene& next) {
    const bool isThere =
        !kept.light && (presentable || averaged) && depth && pictured && isReprojected(*pictured);
    if (!isThere || middleEyeOf(next) == eyeShown) return Done{};
    return keep(*pictured);
}

// What is kept, as another camera sees it. @return what is kept itself where nothing is known of its depths,
// or programs are still compiled: nobody waits for them
Result<TextureId> Renderer::State::recordReprojected(graph::FrameGraph& graph, const scene::Scene& scene,
                                                     const views::Eye& to) {
    const TextureId light = import(graph, kept.light);
    if (!kept.depth || to == kept.eye) return light;
    const Reprojecting programs = reprojecting(scene);
    if (!context.compile(kCompileMs)) return light;
    reprojected = true;
    const ivec2 of = kept.light.desc().size;
    graph::Draw behind{.program = programs.background};
    if (behind.program) {
        const Result<graph::TextureHandle> map = images.image(scene.environment->map);
        if (!map) return map.error();
        behind.block = backgroundBlock(*scene.environment, to, of);
        behind.textures = {{"uEnvironment", *map}};
    }
    const ivec2 cells = (of - 1) / (1 + (std::max(of.x, of.y) - 1) / kMostCells) + 1;
    const ReprojectBlock block{views::viewBlock(kept.eye, of), views::viewBlock(to, of), vec2(cells)};
    const TextureId depthId = import(graph, kept.depth);
    TextureId seen;
    graph.addPass("frame.reproject", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("the last picture from where the camera is now");
        pass.sample(light);
        pass.sample(depthId);
        seen = pass.createColor("frame.reprojected", kept.light.desc());
        pass.clear(seen, vec4(0));
        pass.clear(pass.createDepth("frame.reprojectedDepth", of), 1.0f);
        return [=, vertices = 12 * (cells.x + 2) * (cells.y + 2)](const graph::Resources& resources,
                                                                  graph::Commands& commands) {
            if (behind.program) commands.draw(behind);
            commands.draw({.program = programs.mesh,
                           .vertices = vertices,
                           .depthTest = graph::DepthTest::Less,
                           .block = block,
                           .textures = {{"uPicture", resources[light]}, {"uDepth", resources[depthId]}}});
        };
    });
    return seen;
}

} // namespace lucent::frame
