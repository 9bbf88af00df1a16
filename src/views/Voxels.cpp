#include "views/Voxels.h"

#include "base/Log.h"

#include <algorithm>

namespace lucent::views {

using graph::Format;
using graph::TextureId;

namespace {

constexpr float kNoDepth = -1e30f; // shaders/views/depth.glsl
constexpr int kColumns = 4;        // of images in the reduced one, shaders/views/deepest.frag

int blocksOf(int size, int side) { return (size + side - 1) / side; }

int imagesOfBits(const VoxelSettings& settings) { return settings.slices / 32; }
int imagesOf(const VoxelSettings& settings) { return imagesOfBits(settings) + settings.slices / 64; }

// Nearest and farthest depth of the boxes around all of them.
vec2 depthsOf(const Eye& eye, const Drawables& glass) {
    vec2 all(1e30f, kNoDepth);
    for (const auto& one : glass) {
        const Bounds box = one->bounds();
        for (int corner = 0; corner < 8; ++corner) {
            const vec3 point(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                             corner & 4 ? box.high.z : box.low.z);
            const float depth = glm::dot(point - eye.position, eye.forward);
            all = {std::min(all.x, depth), std::max(all.y, depth)};
        }
    }
    return {std::max(all.x, eye.perspective ? 0.0f : all.x), all.y};
}

// The eye that drawing goes by: its depths are those between which all of them lie.
Eye between(Eye eye, vec2 bounds) {
    eye.nearest = bounds.x;
    eye.farthest = bounds.y;
    return eye;
}

std::string number(const char* name, int value) { return name + (" " + std::to_string(value)); }

std::vector<std::string> sliceDefines(const VoxelSettings& settings) {
    std::vector<std::string> defines{number("SLICES", settings.slices)};
    if (!settings.local) defines.push_back("GLOBAL_BOUNDS");
    return defines;
}

// Calls `add` for images [first, first + count), as many at once as a pass can draw into.
Status inTurns(const gl::Context& context, const VoxelSettings& settings, int images,
               const std::function<Status(int first, int count)>& add) {
    const int most = std::clamp(context.caps().maxDrawBuffers, 1, settings.targets);
    for (int first = 0; first < images; first += most)
        if (Status s = add(first, std::min(most, images - first)); !s) return s;
    return Done{};
}

// Records the passes of one method.
class Recorder {
public:
    Recorder(graph::FrameGraph& graph, gl::Context& context, const Eye& eye, const Drawables& glass,
             ivec2 size)
        : graph_(graph), context_(context), bounds_(depthsOf(eye, glass)), eye_(between(eye, bounds_)),
          glass_(glass), size_(size) {}

    Result<TextureId> extreme(const VoxelSettings& settings);
    Result<TextureId> slices(const VoxelSettings& settings, TextureId extreme);
    Result<TextureId> peel(const DepthLayers& depths);
    Status deepest(DepthLayers& depths);
    DepthLayers begin(DepthLayers::From from, int count) const {
        return {.from = from,
                .voxels = {},
                .count = count,
                .bounds = bounds_,
                .images = {},
                .extreme = {},
                .deepest = {}};
    }
    const gl::Program* program(const char* stem, const std::vector<std::string>& defines) {
        return context_.program(stem, defines);
    }

private:
    void drawAll(const graph::Resources& resources, graph::Commands& commands,
                 const std::vector<Drawing>& drawings, const graph::Draw& how) const {
        for (const Drawing& draw : drawings)
            draw(resources, commands, eye_, size_, how);
    }
    Status extremeByDepthTest(TextureId extreme, int layer, const char* define);
    VoxelBlock block(int count) const {
        return {.bounds = bounds_, .size = size_, .blocks = {}, .count = count};
    }

    graph::FrameGraph& graph_;
    gl::Context& context_;
    vec2 bounds_;
    Eye eye_;
    Drawables glass_;
    ivec2 size_;
};

Result<TextureId> Recorder::extreme(const VoxelSettings& settings) {
    const TextureId extreme =
        graph_.create("views.voxelBounds", {.size = size_, .format = Format::R32F, .layers = 2});
    if (!settings.floatBlend || !context_.caps().floatBlend) {
        if (settings.floatBlend)
            warnOnce(
                "caps: cannot blend into R32F (EXT_float_blend missing); the first and the last surface of "
                "refractive objects are drawn one after the other, which takes twice as long");
        if (Status s = extremeByDepthTest(extreme, 0, "ONLY_NEAREST"); !s) return s.error();
        if (Status s = extremeByDepthTest(extreme, 1, "ONLY_FARTHEST"); !s) return s.error();
        return extreme;
    }
    graph_.addPass("views.voxelBounds", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("first and last surface of the refractive objects in each pixel");
        std::vector<Drawing> drawings = drawingsOf(context_, pass, glass_, ViewKind::VoxelBounds);
        pass.write(extreme, 0);
        pass.write(extreme, 1);
        pass.clear(extreme, vec4(kNoDepth));
        return [self = *this, drawings](const graph::Resources& resources, graph::Commands& commands) {
            self.drawAll(resources, commands, drawings, {.blend = graph::Blend::Max});
        };
    });
    return extreme;
}

Status Recorder::extremeByDepthTest(TextureId extreme, int layer, const char* define) {
    graph_.addPass("views.voxelBounds", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(layer == 0 ? "first surface of the refractive objects in each pixel"
                               : "last surface of the refractive objects in each pixel");
        std::vector<Drawing> drawings = drawingsOf(context_, pass, glass_, ViewKind::VoxelBounds, {define});
        pass.write(extreme, layer);
        pass.clear(extreme, vec4(kNoDepth));
        pass.clear(pass.createDepth("views.voxelDepth", size_, Format::Depth32F), 1.0f);
        return [self = *this, drawings](const graph::Resources& resources, graph::Commands& commands) {
            self.drawAll(resources, commands, drawings, {.depthTest = graph::DepthTest::LessEqual});
        };
    });
    return Done{};
}

Result<TextureId> Recorder::slices(const VoxelSettings& settings, TextureId extreme) {
    const TextureId images =
        graph_.create("views.voxels", {.size = size_, .format = Format::RGBA8, .layers = imagesOf(settings)});
    const auto add = [&](int first, int count) -> Status {
        std::vector<std::string> defines = sliceDefines(settings);
        defines.push_back(number("FIRST", first));
        defines.push_back(number("TARGETS", count));
        graph_.addPass("views.voxels", [&](graph::PassBuilder& pass) -> graph::Execute {
            pass.reason("surfaces as bits in " + std::to_string(settings.slices) +
                        " slices of depth, images " + std::to_string(first + 1) + " to " +
                        std::to_string(first + count) + " of " + std::to_string(imagesOf(settings)));
            std::vector<Drawing> drawings = drawingsOf(context_, pass, glass_, ViewKind::VoxelSlice, defines);
            if (settings.local) pass.sample(extreme);
            for (int i = 0; i < count; ++i)
                pass.write(images, first + i);
            pass.clear(images, vec4(0));
            return [self = *this, drawings, extreme,
                    local = settings.local](const graph::Resources& resources, graph::Commands& commands) {
                graph::Draw draw{.blend = graph::Blend::Add};
                if (local) draw.textures.push_back({"uBounds", resources[extreme]});
                self.drawAll(resources, commands, drawings, draw);
            };
        });
        return Done{};
    };
    if (Status s = inTurns(context_, settings, imagesOf(settings), add); !s) return s.error();
    return images;
}

Result<TextureId> Recorder::peel(const DepthLayers& bits) {
    const int images = blocksOf(bits.count, 4);
    // An array of one layer would be a plain image to shaders.
    const TextureId depths = graph_.create(
        "views.voxelDepths", {.size = size_, .format = Format::RGBA32F, .layers = std::max(2, images)});
    const auto add = [&](int first, int count) -> Status {
        std::vector<std::string> defines = sliceDefines(bits.voxels);
        defines.push_back(number("FIRST", first));
        defines.push_back(number("TARGETS", count));
        const gl::Program* program = context_.program("views/voxel_peel", defines);
        graph_.addPass("views.voxelPeel", [&](graph::PassBuilder& pass) -> graph::Execute {
            pass.reason("depths of " + std::to_string(bits.count) + " surfaces from their bits");
            sampleDepths(pass, bits);
            for (int i = 0; i < count; ++i)
                pass.write(depths, first + i);
            return [bits, program, block = block(bits.count)](const graph::Resources& resources,
                                                              graph::Commands& commands) {
                commands.draw(
                    {.program = program, .block = block, .textures = depthBindings(resources, bits)});
            };
        });
        return Done{};
    };
    if (Status s = inTurns(context_, bits.voxels, images, add); !s) return s.error();
    return depths;
}

// The images of four layers each are reduced together, side by side.
Status Recorder::deepest(DepthLayers& depths) {
    const int groups = blocksOf(depths.count, 4);
    const ivec2 atlas(std::min(groups, kColumns), blocksOf(groups, kColumns));
    ivec2 size = size_;
    TextureId fine;
    do {
        const ivec2 blocks = (size + 3) / 4;
        const gl::Program* program = context_.program(
            "views/deepest", fine ? std::vector<std::string>{"FROM_FINE"} : depthDefines(depths));
        VoxelBlock values = block(depths.count);
        values.size = size;
        values.blocks = blocks;
        graph_.addPass("views.deepest", [&](graph::PassBuilder& pass) -> graph::Execute {
            pass.reason("how far each of " + std::to_string(depths.count) + " layers reaches");
            if (fine)
                pass.sample(fine);
            else
                sampleDepths(pass, depths);
            depths.deepest =
                pass.createColor("views.deepest", {.size = atlas * blocks, .format = Format::RGBA32F});
            return [depths, fine, values, program](const graph::Resources& resources,
                                                   graph::Commands& commands) {
                std::vector<graph::Binding> textures{{"uFine", graph::TextureHandle::None}};
                if (fine)
                    textures[0].texture = resources[fine];
                else
                    textures = depthBindings(resources, depths);
                commands.draw({.program = program, .block = values, .textures = std::move(textures)});
            };
        });
        fine = depths.deepest;
        size = blocks;
    } while (std::max(size.x, size.y) > 1);
    return Done{};
}

} // namespace

Result<DepthLayers> recordVoxels(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                                 const Drawables& glass, ivec2 size, int count,
                                 const VoxelSettings& settings) {
    Recorder recorder(graph, context, eye, glass, size);
    DepthLayers depths = recorder.begin(DepthLayers::From::Bits, count);
    depths.voxels = settings;
    Result<TextureId> extreme = recorder.extreme(settings);
    if (!extreme) return extreme.error();
    depths.extreme = *extreme;
    Result<TextureId> images = recorder.slices(settings, *extreme);
    if (!images) return images.error();
    depths.images = *images;
    if (!settings.onTheFly) {
        Result<TextureId> peeled = recorder.peel(depths);
        if (!peeled) return peeled.error();
        depths.from = DepthLayers::From::Voxels;
        depths.images = *peeled;
    }
    if (Status s = recorder.deepest(depths); !s) return s.error();
    return depths;
}

Result<DepthLayers> recordFrontBack(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                                    const Drawables& glass, ivec2 size) {
    Recorder recorder(graph, context, eye, glass, size);
    DepthLayers depths = recorder.begin(DepthLayers::From::Bounds, 2);
    Result<TextureId> extreme = recorder.extreme({});
    if (!extreme) return extreme.error();
    depths.extreme = *extreme;
    if (Status s = recorder.deepest(depths); !s) return s.error();
    return depths;
}

Result<DepthLayers> recordDepths(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                                 const Drawables& glass, ivec2 size, const Layers& layers) {
    Recorder recorder(graph, context, eye, glass, size);
    DepthLayers depths = recorder.begin(DepthLayers::From::Peel, layers.count);
    depths.images = layers.images;
    if (Status s = recorder.deepest(depths); !s) return s.error();
    return depths;
}

Result<VoxelCount> countVoxels(graph::TexturePool& pool, gl::Context& context, const Eye& eye,
                               const Drawables& glass, float time, ivec2 size,
                               const VoxelSettings& settings) {
    const graph::Texture counts(context.device(), {.size = size, .format = Format::RGBA16F},
                                "views.voxelCounts");
    graph::FrameGraph graph;
    const TextureId target = graph.import(counts.handle(), counts.desc(), counts.label());
    graph.keep(target);
    Result<Drawables> posed = recordPose(graph, context, glass, time);
    if (!posed) return posed.error();
    VoxelSettings bits = settings;
    bits.onTheFly = true;
    Result<DepthLayers> depths = recordVoxels(graph, context, eye, *posed, size, kMostLayers, bits);
    if (!depths) return depths.error();
    const gl::Program* program = context.program("views/voxel_count", sliceDefines(settings));
    graph.addPass("views.voxelCount", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("how many surfaces share a slice");
        sampleDepths(pass, *depths);
        pass.write(target);
        return [depths = *depths, program](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program, .textures = depthBindings(resources, depths)});
        };
    });
    if (Status compiled = graph.compile(); !compiled) return compiled.error();
    graph.execute(pool);
    const Image image = context.device().read(counts.handle());
    if (std::string error = context.takeError(); !error.empty()) return Error{error, Fault::Machine};
    VoxelCount sum;
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        sum.surfaces += long(image.pixels[i]);
        sum.sharing += long(image.pixels[i + 1]);
        sum.saturated += long(image.pixels[i + 3]);
    }
    return sum;
}

std::vector<std::string> depthDefines(const DepthLayers& depths) {
    constexpr const char* kNames[] = {"FROM_PEEL", "FROM_VOXELS", "FROM_BITS", "FROM_BOUNDS"};
    std::vector<std::string> defines{kNames[int(depths.from)]};
    if (depths.from == DepthLayers::From::Bits) {
        const std::vector<std::string> slices = sliceDefines(depths.voxels);
        defines.insert(defines.end(), slices.begin(), slices.end());
    }
    return defines;
}

void sampleDepths(graph::PassBuilder& pass, const DepthLayers& depths) {
    if (depths.images) pass.sample(depths.images);
    if (depths.extreme) pass.sample(depths.extreme);
}

std::vector<graph::Binding> depthBindings(const graph::Resources& resources, const DepthLayers& depths) {
    constexpr const char* kSamplers[] = {"uLayers", "uDepths", "uVoxels", ""};
    std::vector<graph::Binding> list;
    if (depths.images) list.push_back({kSamplers[int(depths.from)], resources[depths.images]});
    if (depths.extreme) list.push_back({"uBounds", resources[depths.extreme]});
    return list;
}

} // namespace lucent::views
