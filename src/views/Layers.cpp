#include "views/Layers.h"

#include "base/Log.h"

#include <algorithm>
#include <cstddef>

namespace lucent::views {

using graph::Format;
using graph::TextureDesc;
using graph::TextureId;

namespace {

struct ReduceBlock {
    ViewBlock view;
    ivec2 size;
    int layer, padding = 0;

    static const graph::BlockLayout& layout() {
        static const auto members = [] {
            auto list = viewMembers(offsetof(ReduceBlock, view));
            list.insert(list.end(),
                        {{"size", offsetof(ReduceBlock, size)}, {"layer", offsetof(ReduceBlock, layer)}});
            return list;
        }();
        static const graph::BlockLayout layout{"ReduceBlock", sizeof(ReduceBlock), members};
        return layout;
    }
};

constexpr const char* kBlockLabels[] = {"views.blocks4", "views.blocks16", "views.blocks64"};
constexpr const char* kBlockSamplers[] = {"uBlocks4", "uBlocks16", "uBlocks64"};

// An array of one layer would be a plain image to shaders.
int arrayLayers(int count) { return std::max(2, count); }

void samplePosed(graph::PassBuilder& pass, const std::vector<PosedMesh>& meshes) {
    for (const PosedMesh& mesh : meshes) {
        pass.sample(mesh.positions);
        pass.sample(mesh.normals);
    }
}

Status recordPeel(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                  const std::vector<PosedMesh>& meshes, ivec2 size, TextureId images, int layer,
                  TextureId& done, graph::Query* query) {
    const bool first = layer == 0;
    Result<const gl::Program*> program = context.program(
        "views/peel", first ? std::vector<std::string>{"PEEL_FIRST"} : std::vector<std::string>{});
    if (!program) return program.error();
    const TextureId before = done;
    graph.addPass("views.peel", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("surface " + std::to_string(layer + 1) + " of the refractive objects behind each pixel");
        for (const PosedMesh& mesh : meshes)
            pass.sample(mesh.triangles.corners);
        if (!first) pass.sample(before);
        pass.write(images, layer);
        pass.clear(images, vec4(0));
        if (query) pass.query(*query);
        done = pass.createColor("views.peeled", {.size = size, .format = Format::RG32F});
        pass.clear(done, vec4(0));
        const TextureId depth = pass.createDepth("views.peelDepth", size, Format::Depth32F);
        pass.clear(depth, 1.0f);
        return [=, program = *program](const graph::Resources& resources, graph::Commands& commands) {
            for (std::size_t i = 0; i < meshes.size(); ++i) {
                graph::Draw draw{.depthTest = graph::DepthTest::Less};
                if (!first) draw.textures.push_back({"uBefore", resources[before]});
                drawTriangles(commands, *program, resources, meshes[i], eye, size, int(i), std::move(draw));
            }
        };
    });
    return Done{};
}

// One layer of one level of blocks.
Status recordReduce(graph::FrameGraph& graph, gl::Context& context, const ViewBlock& view, TextureId fine,
                    ivec2 fineSize, int layer, TextureId blocks, const char* variant) {
    Result<const gl::Program*> program = context.program(
        "views/reduce", variant ? std::vector<std::string>{variant} : std::vector<std::string>{});
    if (!program) return program.error();
    graph.addPass("views.reduce", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("depth ranges of surface " + std::to_string(layer + 1) + ", by which rays skip");
        pass.sample(fine);
        pass.write(blocks, layer);
        return [=, program = *program](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = ReduceBlock{view, fineSize, layer},
                           .textures = {{"uFine", resources[fine]}}});
        };
    });
    return Done{};
}

} // namespace

Result<int> countLayers(graph::TexturePool& pool, gl::Context& context, const Eye& eye,
                        const std::vector<DrawnMesh>& meshes, float time, ivec2 size) {
    Result<const gl::Program*> program = context.program("views/count");
    if (!program) return program.error();
    const graph::Texture counts(context.device(), {.size = size, .format = Format::RGBA16F}, "views.counts");
    graph::FrameGraph graph;
    const TextureId target = graph.import(counts.handle(), counts.desc(), counts.label());
    graph.keep(target);
    Result<std::vector<PosedMesh>> posed = recordPose(graph, context, meshes, time);
    if (!posed) return posed.error();
    graph.addPass("views.count", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("how many surfaces of refractive objects lie behind each other");
        samplePosed(pass, *posed);
        pass.write(target);
        pass.clear(target, vec4(0));
        return [=, program = *program, meshes = *posed](const graph::Resources& resources,
                                                        graph::Commands& commands) {
            for (std::size_t i = 0; i < meshes.size(); ++i)
                drawMesh(commands, *program, resources, meshes[i], eye, size, int(i),
                         {.blend = graph::Blend::Add});
        };
    });
    if (Status compiled = graph.compile(); !compiled) return compiled.error();
    graph.execute(pool);
    const Image image = context.device().read(counts.handle());
    if (std::string error = context.takeError(); !error.empty()) return Error{error, Fault::Machine};
    float most = 0;
    for (std::size_t i = 0; i < image.pixels.size(); i += 4)
        most = std::max(most, image.pixels[i]);
    if (int(most) > kMostLayers)
        warnOnce("views: " + std::to_string(int(most)) +
                 " refractive surfaces lie behind each other; the nearest " + std::to_string(kMostLayers) +
                 " are drawn, and rays go straight on behind them");
    return std::min(int(most), kMostLayers);
}

LayerQueries LayerCount::ask() {
    if (waits()) return {};
    asked_ = drawn();
    return {&last_, &before_};
}

bool LayerCount::poll() {
    if (!waits()) return false;
    const std::optional<bool> last = last_.poll(), before = before_.poll();
    if (!last || !before) return false;
    const bool current = asked_ == drawn(); // else another scene was asked about
    const bool more = *last && current && asked_ < kMostLayers;
    if (more)
        known_ = asked_;
    else if (current && !*before)
        known_ = std::max(1, known_ - 1);
    asked_ = 0;
    return more;
}

Result<Layers> recordLayers(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                            const std::vector<PosedMesh>& meshes, ivec2 size, int count, TextureId solid,
                            const LayerQueries& queries) {
    Layers layers;
    layers.count = count;
    if (!meshes.empty()) layers.triangles = meshes.front().triangles;
    layers.images =
        graph.create("views.layers", {.size = size, .format = Format::RGBA32F, .layers = arrayLayers(count)});
    TextureId done;
    for (int layer = 0; layer < count; ++layer) {
        graph::Query* query = layer == count - 1   ? queries.last
                              : layer == count - 2 ? queries.before
                                                   : nullptr;
        if (Status s = recordPeel(graph, context, eye, meshes, size, layers.images, layer, done, query); !s)
            return s.error();
    }
    const ViewBlock view = viewBlock(eye, size);
    ivec2 fineSize = size;
    TextureId fine = layers.images;
    for (std::size_t level = 0; level < layers.blocks.size(); ++level) {
        const ivec2 blockSize = (fineSize + 3) / 4;
        layers.blocks[level] =
            graph.create(kBlockLabels[level],
                         {.size = blockSize, .format = Format::RG32F, .layers = arrayLayers(count + 1)});
        for (int layer = 0; layer < count; ++layer)
            if (Status s = recordReduce(graph, context, view, fine, fineSize, layer, layers.blocks[level],
                                        level == 0 ? "FROM_LAYERS" : nullptr);
                !s)
                return s.error();
        if (solid)
            if (Status s = recordReduce(graph, context, view, level == 0 ? solid : fine, fineSize, count,
                                        layers.blocks[level], level == 0 ? "FROM_SOLID" : nullptr);
                !s)
                return s.error();
        fine = layers.blocks[level];
        fineSize = blockSize;
    }
    return layers;
}

void sampleLayers(graph::PassBuilder& pass, const Layers& layers) {
    pass.sample(layers.images);
    sampleTriangles(pass, layers.triangles);
    for (const TextureId blocks : layers.blocks)
        pass.sample(blocks);
}

std::vector<graph::Binding> layerBindings(const graph::Resources& resources, const Layers& layers) {
    std::vector<graph::Binding> list = triangleBindings(resources, layers.triangles);
    list.push_back({"uLayers", resources[layers.images]});
    for (std::size_t level = 0; level < layers.blocks.size(); ++level)
        list.push_back({kBlockSamplers[level], resources[layers.blocks[level]]});
    return list;
}

} // namespace lucent::views
