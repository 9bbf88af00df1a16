#include "views/Layers.h"

#include "base/Log.h"
#include "views/Meshes.h"

#include <algorithm>

namespace lucent::views {

using graph::Format;
using graph::TextureDesc;
using graph::TextureId;

namespace {

constexpr const char kImagesLabel[] = "views.layers", kBlocksLabel[] = "views.blocks",
                     kDepthLabel[] = "views.peelDepth";
constexpr int kBlockLevels = 3;
constexpr vec4 kEmptyRanges{1e30f, -1e30f, 1e30f, -1e30f};

// The first layer's counts all surfaces in its stencil.
TextureDesc depthDesc(ivec2 size, bool first) {
    return {.size = size, .format = first ? Format::Depth32FStencil8 : Format::Depth32F};
}

// An array of one layer would be a plain image to shaders.
int arrayLayers(int count) { return std::max(2, count); }

Status recordPeel(graph::FrameGraph& graph, gl::Context& context, const Eye& eye, const Drawables& glass,
                  ivec2 size, const Layers& layers, int layer, TextureId& done, graph::Query* query) {
    const bool first = layer == 0;
    std::vector<std::string> defines;
    if (first) defines.push_back("PEEL_FIRST");
    if (eye.isCut()) defines.push_back("CUT");
    const TextureId before = done, images = layers.images;
    graph.addPass("views.peel", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("surface " + std::to_string(layer + 1) + " of the refractive objects behind each pixel");
        std::vector<Drawing> drawings = drawingsOf(context, pass, glass, ViewKind::Peel, defines);
        if (!first) pass.sample(before);
        pass.write(images, layer);
        pass.clear(images, vec4(0));
        if (query) pass.query(*query);
        done = pass.createColor("views.peeled", {.size = size, .format = Format::RG32F});
        pass.clear(done, vec4(0));
        const TextureId depth = first ? layers.depth : graph.create(kDepthLabel, depthDesc(size, first));
        pass.write(depth);
        pass.clear(depth, 1.0f);
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            graph::Draw how{.depthTest = graph::DepthTest::Less};
            if (first) how.stencil = graph::Stencil::Count;
            if (!first) how.textures.push_back({"uBefore", resources[before]});
            for (const Drawing& draw : drawings)
                draw(resources, commands, eye, size, how);
        };
    });
    return Done{};
}

// Asks whether any pixel has more surfaces than are drawn: the first layer's pass counted them.
Status recordBehind(graph::FrameGraph& graph, gl::Context& context, const Layers& layers,
                    graph::Query& query) {
    const gl::Program* program = context.program("views/behind");
    graph.addPass("views.behind", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("whether surfaces lie behind the last one that is drawn");
        pass.write(layers.depth);
        pass.query(query);
        return [program, count = layers.count](const graph::Resources&, graph::Commands& commands) {
            commands.draw({.program = program, .stencil = graph::Stencil::More, .counted = count});
        };
    });
    return Done{};
}

// Depth ranges of one pair of surfaces in blocks of 4 pixels a side. `first`: the first layer of the pair, -1
// for what is opaque.
Result<TextureId> recordRanges(graph::FrameGraph& graph, gl::Context& context, const ViewBlock& view,
                               const Layers& layers, TextureId solid, ivec2 size, int first) {
    const gl::Program* program = context.program(
        "views/ranges", first < 0 ? std::vector<std::string>{"WITH_SOLID"} : std::vector<std::string>{});
    TextureId ranges;
    graph.addPass("views.ranges", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("depth ranges of " +
                    (first < 0 ? "what is opaque" : "surface " + std::to_string(first + 1)) +
                    " and of the next surface, by which rays skip");
        pass.sample(layers.images);
        if (first < 0) pass.sample(solid);
        ranges = pass.createColor("views.ranges", {.size = (size + 3) / 4, .format = Format::RGBA32F});
        return [=, images = layers.images, count = layers.count](const graph::Resources& resources,
                                                                 graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uLayers", resources[images]}};
            if (first < 0) textures.push_back({"uSolid", resources[solid]});
            commands.draw({.program = program,
                           .block = RangesBlock{view, size, first, count},
                           .textures = std::move(textures)});
        };
    });
    return ranges;
}

// One pair of surfaces in blocks of all sizes.
Status recordBlocks(graph::FrameGraph& graph, gl::Context& context, TextureId ranges, ivec2 rangesSize,
                    TextureId blocks, int pair) {
    const gl::Program* program = context.program("views/blocks");
    graph.addPass("views.blocks", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("the same of larger blocks");
        pass.sample(ranges);
        pass.write(blocks, pair);
        pass.clear(blocks, kEmptyRanges);
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            ivec2 size = rangesSize;
            for (int level = 0, side = 1, row = 0; level < kBlockLevels; ++level, side *= 4) {
                commands.draw({.program = program,
                               .region = {0, row, size},
                               .block = BlocksBlock{rangesSize, side, row},
                               .textures = {{"uRanges", resources[ranges]}}});
                row += size.y;
                size = (size + 3) / 4;
            }
        };
    });
    return Done{};
}

// How many pairs of surfaces have ranges: what is opaque first, where it is there, then the layers from the
// front.
int pairsOf(int count, bool withSolid) { return (count + (withSolid ? 1 : 0) + 1) / 2; }

TextureDesc imagesDesc(ivec2 size, int count) {
    return {.size = size, .format = Format::RGBA32F, .layers = arrayLayers(count)};
}
TextureDesc blocksDesc(ivec2 size, int pairs) {
    const ivec2 fine = (size + 3) / 4;
    ivec2 all(fine.x, 0);
    for (int level = 0, rows = fine.y; level < kBlockLevels; ++level, rows = (rows + 3) / 4)
        all.y += rows;
    return {.size = all, .format = Format::RGBA32F, .layers = arrayLayers(pairs)};
}

// Ranges of depth by which rays skip, two a texel.
Status recordSkipping(graph::FrameGraph& graph, gl::Context& context, const ViewBlock& view,
                      const Layers& layers, TextureId solid, ivec2 size) {
    const int shift = solid ? 1 : 0;
    for (int pair = 0; pair < pairsOf(layers.count, bool(solid)); ++pair) {
        const Result<TextureId> ranges =
            recordRanges(graph, context, view, layers, solid, size, 2 * pair - shift);
        if (!ranges) return ranges.error();
        if (Status s = recordBlocks(graph, context, *ranges, (size + 3) / 4, layers.blocks, pair); !s)
            return s;
    }
    return Done{};
}

// Makes textures anew that are of another size.
void importKept(graph::FrameGraph& graph, gl::Context& context, KeptLayers& kept, ivec2 size, bool withSolid,
                Layers& layers) {
    kept.current = kept.current && kept.count == layers.count;
    kept.count = layers.count;
    const auto import = [&](graph::Texture& texture, const TextureDesc& desc, const char* label) {
        if (!texture || texture.desc() != desc) {
            texture = graph::Texture(context.device(), desc, label);
            kept.current = false;
        }
        return graph.import(texture.handle(), desc, label);
    };
    layers.images = import(kept.images, imagesDesc(size, layers.count), kImagesLabel);
    layers.blocks = import(kept.blocks, blocksDesc(size, pairsOf(layers.count, withSolid)), kBlocksLabel);
    layers.depth = import(kept.depth, depthDesc(size, true), kDepthLabel);
}

// How many surfaces each pixel shows.
Result<TextureId> recordCounts(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                               const Drawables& glass, float time, ivec2 size) {
    const TextureId target = graph.create("views.counts", {.size = size, .format = Format::RGBA16F});
    Result<Drawables> posed = recordPose(graph, context, glass, time);
    if (!posed) return posed.error();
    graph.addPass("views.count", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("how many surfaces of refractive objects lie behind each other");
        std::vector<Drawing> drawings = drawingsOf(context, pass, *posed, ViewKind::Count);
        pass.write(target);
        pass.clear(target, vec4(0));
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            for (const Drawing& draw : drawings)
                draw(resources, commands, eye, size, {.blend = graph::Blend::Add});
        };
    });
    return target;
}

} // namespace

Result<int> countLayers(Readings& readings, const std::string& question, graph::TexturePool& pool,
                        gl::Context& context, const Eye& eye, const Drawables& glass, float time,
                        ivec2 size) {
    const auto counted = readings.most(question, pool, context, [&](graph::FrameGraph& graph) {
        return recordCounts(graph, context, eye, glass, time, size);
    });
    if (!counted) return counted.error();
    const int most = int(counted->value_or(1));
    if (most > kMostLayers)
        warnOnce("views: " + std::to_string(most) +
                 " refractive surfaces lie behind each other; the nearest " + std::to_string(kMostLayers) +
                 " are drawn, and rays go straight on behind them");
    return std::min(most, kMostLayers);
}

LayerQueries LayerCount::ask() {
    if (waits()) return {};
    asked_ = drawn();
    return {&last_, &behind_};
}

bool LayerCount::poll() {
    if (!waits()) return false;
    const std::optional<bool> last = last_.poll(), behind = behind_.poll();
    if (!last || !behind) return false;
    const bool current = asked_ == drawn(); // else another scene was asked about
    const bool more = *behind && current && asked_ < kMostLayers;
    if (more)
        known_ = asked_ + 1;
    else if (current && !*last)
        known_ = std::max(1, known_ - 1);
    asked_ = 0;
    return more;
}

Result<Layers> recordLayers(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                            const Drawables& glass, ivec2 size, int count, TextureId solid,
                            const LayerQueries& queries, KeptLayers* kept) {
    Layers layers;
    layers.count = count;
    if (!glass.empty()) layers.triangles = glass.front()->mesh()->triangles;
    if (kept && count > 0) {
        importKept(graph, context, *kept, size, bool(solid), layers);
        if (kept->current) return layers;
        for (const TextureId image : {layers.images, layers.blocks, layers.depth})
            graph.keep(image);
    } else {
        layers.images = graph.create(kImagesLabel, imagesDesc(size, count));
        if (count > 0) {
            layers.blocks = graph.create(kBlocksLabel, blocksDesc(size, pairsOf(count, bool(solid))));
            layers.depth = graph.create(kDepthLabel, depthDesc(size, true));
        }
    }
    TextureId done;
    for (int layer = 0; layer < count; ++layer) {
        graph::Query* query = layer == count - 1 ? queries.last : nullptr;
        if (Status s = recordPeel(graph, context, eye, glass, size, layers, layer, done, query); !s)
            return s.error();
    }
    if (count > 0 && queries.behind)
        if (Status s = recordBehind(graph, context, layers, *queries.behind); !s) return s.error();
    if (count > 0)
        if (Status s = recordSkipping(graph, context, viewBlock(eye, size), layers, solid, size); !s)
            return s.error();
    if (kept) kept->current = count > 0;
    return layers;
}

void sampleLayers(graph::PassBuilder& pass, const Layers& layers) {
    pass.sample(layers.images);
    sampleTriangles(pass, layers.triangles);
    pass.sample(layers.blocks);
}

std::vector<graph::Binding> layerBindings(const graph::Resources& resources, const Layers& layers) {
    std::vector<graph::Binding> list = triangleBindings(resources, layers.triangles);
    list.push_back({"uLayers", resources[layers.images]});
    list.push_back({"uBlocks", resources[layers.blocks]});
    return list;
}

} // namespace lucent::views
