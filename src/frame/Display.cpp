// From linear light to what is shown, alone or with another picture beside it.
#include "frame/RendererState.h"

#include "views/Surface.h"

#include <cmath>

namespace lucent::frame {

using graph::Format;
using graph::TextureDesc;
using graph::TextureId;
using scene::Aov;

namespace {

// How a quantity is shown as a picture. Light is exposed and encoded; the rest is brought into [0, 1].
DisplayBlock displayOf(const scene::Scene& scene, const views::Eye& eye) {
    DisplayBlock block{.scale = vec4(1)};
    switch (scene.view.show) {
    case Aov::Color:
    case Aov::Irradiance:
    case Aov::Radiosity:
    case Aov::Atlas:
        block.scale = vec4(std::exp2(scene.view.exposure));
        block.encode = 1;
        break;
    case Aov::Illumination:
    case Aov::Visibility:
        block.isScalar = 1;
        block.encode = 1;
        break;
    case Aov::Iterations: // white at 128 steps
        block.isScalar = 1;
        block.scale = vec4(1.0f / 128);
        break;
    case Aov::Layers: // white at 16 interfaces
        block.scale = vec4(1.0f / 16);
        break;
    case Aov::Lost:
    case Aov::Misses:
    case Aov::LayerObject:
        break;
    case Aov::CausticMap: // in false colours, by doublings
        block.scale = vec4(1 / std::log2(kMapBrightest / kMapDarkest));
        block.shift = -std::log2(kMapDarkest) * block.scale;
        block.encode = block.isHeat = 1;
        break;
    case Aov::Normal:
    case Aov::Direction:
    case Aov::LayerNormal:
        block.scale = vec4(0.5f);
        block.shift = vec4(0.5f);
        break;
    case Aov::Depth:
    case Aov::LayerDepth:
    case Aov::Position: { // over the objects' extent: nearest or lowest black, farthest or highest white
        views::Bounds bounds;
        for (const scene::Object& object : scene.objects)
            bounds.add(views::boundsOf(object));
        vec3 low = bounds.low, high = bounds.high;
        if (scene.view.show != Aov::Position) {
            const float middle = glm::dot(bounds.center() - eye.position, eye.forward);
            low = vec3(middle - bounds.radius());
            high = vec3(middle + bounds.radius());
        }
        const vec3 extent = glm::max(high - low, vec3(1e-9f));
        block.scale = vec4(1.0f / extent, 1);
        block.shift = vec4(-low / extent, 0);
        break;
    }
    }
    return block;
}

} // namespace

// @param composes  where `through` or `mean` stands in for the sum
const gl::Program* Renderer::State::displayProgram(bool linear, bool composes) const {
    std::vector<std::string> defines;
    if (linear) defines.push_back("LINEAR");
    if (composes) defines.push_back("COMPOSED");
    return context.program("frame/display", defines);
}

// @param from  null: whence it was drawn
Status Renderer::State::recordDisplay(graph::FrameGraph& graph, const scene::Scene& scene,
                                      graph::TextureId target, bool linear, const views::Eye* from) {
    const bool shows = kept.light && !linear; // what is kept
    const gl::Program* program = displayProgram(linear, composed || averaged || shows);
    const views::Eye eye = views::makeEye(scene, aspect());
    DisplayBlock block = displayOf(scene, eye);
    if (linear) {
        block.scale = vec4(1);
        block.shift = vec4(0);
        block.isHeat = 0;
    }
    if (shows) block.isScalar = 0; // its channels are alike
    const graph::TextureId surfaceId = import(graph, shownSurface);
    graph::TextureId shownId;
    if (!shows) {
        shownId = import(graph, finished());
    } else {
        const Result<graph::TextureId> seen = recordReprojected(graph, scene, from ? *from : kept.eye);
        if (!seen) return seen.error();
        shownId = *seen;
    }
    const bool scales = shows && kept.light.desc().size != screen;
    TextureId small;
    graph.addPass("frame.display", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(linear ? "linear values for a file" : "exposure, clamp and sRGB curve for the display");
        pass.sample(surfaceId);
        pass.sample(shownId);
        if (scales)
            small = pass.createColor("frame.small", {.size = kept.light.desc().size, .linear = true});
        else
            pass.write(target);
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = block,
                           .textures = {{"uSurface", resources[surfaceId]}, {"uSum", resources[shownId]}}});
        };
    });
    if (scales) recordScaled(graph, small, target);
    graph.keep(target);
    return Done{};
}

void Renderer::State::recordScaled(graph::FrameGraph& graph, TextureId small, TextureId target) {
    const gl::Program* program = scaledProgram();
    graph.addPass("frame.scaled", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("a preview of fewer pixels, smoothed between them");
        pass.sample(small);
        pass.write(target);
        const ScaledBlock block{.pixels = vec2(screen)};
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program, .block = block, .textures = {{"uShown", resources[small]}}});
        };
    });
}

void Renderer::State::takeOther(const Beside& beside) {
    const TextureDesc desc{.size = beside.image.size(), .format = Format::RGBA32F};
    const bool fits = other && other.desc() == desc;
    if (fits && otherNumber == beside.number) return;
    if (!fits) other = graph::Texture(context.device(), desc, "frame.other");
    context.device().upload(other.handle(), 0, beside.image.pixels);
    otherNumber = beside.number;
}

// Over what is on the screen already.
Status Renderer::State::recordBeside(graph::FrameGraph& graph, const scene::Scene& scene,
                                     const Beside& beside) {
    const gl::Program* program = context.program("frame/beside", {});
    const graph::TextureId otherId = import(graph, other);
    const graph::TextureId target = importScreen(graph);
    const DisplayBlock shown = displayOf(scene, views::makeEye(scene, aspect()));
    BesideBlock block;
    block.scale = shown.scale;
    block.shift = shown.shift;
    block.encode = shown.encode;
    block.isHeat = shown.isHeat;
    block.corner = {beside.corner.x,
                    float(screen.y) - beside.corner.y - float(beside.image.height) * beside.pixelsPerTexel};
    block.pixelsPerTexel = beside.pixelsPerTexel;
    block.divider = beside.divider;
    block.full = beside.full;
    block.isError = beside.isError;
    graph.addPass("frame.beside", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("another picture beside it");
        pass.sample(otherId);
        pass.write(target);
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program, .block = block, .textures = {{"uOther", resources[otherId]}}});
        };
    });
    graph.keep(target);
    return Done{};
}

Result<Image> Renderer::State::display(const scene::Scene& scene, bool linear) {
    const graph::Texture target(context.device(),
                                {.size = size, .format = linear ? Format::RGBA32F : Format::RGBA8},
                                "frame.picture");
    const Status status = runGraph([&](graph::FrameGraph& graph) {
        return recordDisplay(graph, scene, graph.import(target.handle(), target.desc(), target.label()),
                             linear);
    });
    if (!status) return status.error();
    return context.device().read(target.handle());
}

} // namespace lucent::frame
