#include "techniques/subsurface/Entering.h"

#include "light/Occlusion.h"
#include "shaders/subsurface/Blocks.h"

#include <algorithm>
#include <cstddef>
#include <map>

namespace lucent::subsurface {

using graph::Format;
using graph::TextureId;

namespace {

constexpr int kMostTexels = 1 << 22; // of occlusion at once: 64 MiB

struct WholeKey {
    std::array<diffusion::Medium, 3> media;
    diffusion::Shape shape;
    double thickness;
    bool operator==(const WholeKey&) const = default;
};

// Share of the light that entered which leaves again, of each colour: known, as each picture asks for it.
vec3 wholeOf(const Kept& known, const scene::Material& material, const Settings& settings) {
    const WholeKey key{diffusion::mediaOf(material), settings.profile,
                       double(material.translucent().thickness)};
    return known.of<vec3>(key, [&] {
        vec3 whole;
        for (int i = 0; i < 3; ++i)
            whole[i] =
                float(diffusion::totalReflectance(key.media[std::size_t(i)], key.shape, key.thickness));
        return whole;
    });
}

void fit(gl::Context& context, graph::Texture& texture, ivec2 size, const char* label) {
    const graph::TextureDesc desc{.size = size, .format = Format::RGBA32F};
    if (!texture || texture.desc() != desc) texture = graph::Texture(context.device(), desc, label);
}

TextureId import(graph::FrameGraph& graph, const graph::Texture& texture) {
    return graph.import(texture.handle(), texture.desc(), texture.label());
}

// Adds some samples in one view to a sum. The blocks are those of its objects.
Status recordEnter(graph::FrameGraph& graph, gl::Context& context, Entered& sum, TextureId surface,
                   TextureId table, const views::Occlusion& occlusion, TextureId flux,
                   const std::vector<EnterBlock>& blocks, bool ofLayer, const char* reason) {
    const int first = blocks.front().firstLight;
    std::vector<std::string> defines = occlusion.defines();
    if (ofLayer) defines.push_back("OF_LAYER");
    if (flux) defines.push_back("USE_FLUX");
    if (first > 0) defines.push_back("USE_SUM");
    const gl::Program* program = context.program("subsurface/enter", defines);
    const int next = 1 - sum.now;
    const ivec2 size(blocks.front().view.size);
    fit(context, sum.light[next], size, "subsurface.entered");
    fit(context, sum.other[next], size, "subsurface.beside");
    const TextureId light = import(graph, sum.light[next]), other = import(graph, sum.other[next]);
    TextureId lightBefore, otherBefore;
    if (first > 0) {
        lightBefore = import(graph, sum.light[sum.now]);
        otherBefore = import(graph, sum.other[sum.now]);
    }
    graph.keep(light);
    graph.keep(other);
    sum.now = next;
    graph.addPass("subsurface.enter", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(reason);
        for (const TextureId id : {surface, table, flux, occlusion.texture, lightBefore, otherBefore})
            if (id) pass.sample(id);
        for (const TextureId id : {light, other}) {
            pass.write(id);
            pass.clear(id, vec4(0));
        }
        return [=, shade = occlusion.texture](const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uSurface", resources[surface]},
                                                 {"uLights", resources[table]}};
            if (shade) textures.push_back({"uOcclusion", resources[shade]});
            if (flux) textures.push_back({"uFlux", resources[flux]});
            if (lightBefore) textures.push_back({"uEntered", resources[lightBefore]});
            if (otherBefore) textures.push_back({"uOther", resources[otherBefore]});
            for (const EnterBlock& block : blocks)
                commands.draw({.program = program, .block = block, .textures = textures});
        };
    });
    return Done{};
}

bool hasWater(const Arriving& in) {
    return std::any_of(in.casters.begin(), in.casters.end(),
                       [](const auto& one) { return one->mesh() && one->mesh()->water; });
}

EnteredKey keyOf(const Arriving& in, const Plan::State& plan) {
    EnteredKey key{.samples = in.samples, .shadowSize = views::samplingOf(in.scene).shadowSize};
    for (const auto& one : in.casters) {
        key.objects.push_back(views::objectKey(*one->object, in.scene.view.time));
        key.paintings.push_back(one->object->painting);
    }
    for (const Plan::State::Object& object : plan.objects)
        key.bodies.push_back({in.scene.objects[std::size_t(object.index)].material.translucent().surfaceIor(),
                              object.layers, object.sizes});
    return key;
}

} // namespace

const LitBody* Entering::of(int object) const {
    const auto found = bodies_.find(object);
    return onLayers_ && found != bodies_.end() ? &found->second : nullptr;
}

// Layers of all objects, to be lit.
Status Entering::peel(graph::FrameGraph& graph, gl::Context& context, const Arriving& in,
                      const Plan::State& plan) {
    std::map<int, LitBody> before = std::move(bodies_);
    bodies_.clear();
    for (const Plan::State::Object& object : plan.objects)
        for (const views::DrawnMesh& mesh : in.solids) {
            if (mesh.index != object.index) continue;
            LitBody& body = bodies_[object.index] = std::move(before[object.index]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                body.layers[axis].resize(std::size_t(object.layers[axis]));
                TextureId last;
                for (LitLayer& layer : body.layers[axis]) {
                    fit(context, layer.surface, object.sizes[axis], "subsurface.layer");
                    if (mesh.paint)
                        fit(context, layer.paint, object.sizes[axis], "subsurface.paint");
                    else
                        layer.paint = graph::Texture();
                    const TextureId surface = import(graph, layer.surface);
                    const TextureId paint = mesh.paint ? import(graph, layer.paint) : TextureId{};
                    for (const TextureId id : {surface, paint})
                        if (id) graph.keep(id);
                    if (Status s = recordPeel(graph, context, object.axes[axis], mesh, object.sizes[axis],
                                              last, surface, paint);
                        !s)
                        return s;
                    last = surface;
                }
            }
        }
    return Done{};
}

Status Entering::addTo(graph::FrameGraph& graph, gl::Context& context, const Arriving& in,
                       const Plan::State::Object& object, int axis, LitLayer& layer) {
    const views::Eye& eye = object.axes[std::size_t(axis)];
    const ivec2 size = object.sizes[std::size_t(axis)];
    const TextureId surface = import(graph, layer.surface);
    const int most =
        std::clamp(4 * (kMostTexels / (size.x * size.y)), 4, views::mostSamplesAtOnce(context, size));
    for (int first = in.first; first == in.first || first < in.end; first += most) {
        const int end = std::min(in.end, first + most);
        const auto from = std::size_t(first), count = std::size_t(end - first);
        Result<views::Occlusion> occlusion = views::recordOcclusion(
            graph, context, {eye, size, surface}, std::span(in.samples).subspan(from, count),
            std::span(in.occlusion.shadows).subspan(from - std::size_t(in.first), count));
        if (!occlusion) return occlusion.error();
        const EnterBlock block{
            .view = views::viewBlock(eye, size),
            .share = vec4(1),
            .object = object.index,
            .ior = in.scene.objects[std::size_t(object.index)].material.translucent().surfaceIor(),
            .firstLight = first,
            .endLight = end,
            .placed = in.placed,
            .columns = occlusion->columns};
        Result<TextureId> flux =
            first == in.first && in.fluxOn ? in.fluxOn({eye, size, surface}) : TextureId{};
        if (!flux) return flux.error();
        if (Status s = recordEnter(graph, context, layer.entered, surface, in.table, *occlusion, *flux,
                                   {block}, true, "light that enters a layer of an object");
            !s)
            return s;
    }
    return Done{};
}

Status Entering::addSeen(graph::FrameGraph& graph, gl::Context& context, const Arriving& in,
                         const Settings& settings) {
    std::vector<EnterBlock> blocks;
    for (const views::DrawnMesh& mesh : in.solids) {
        const scene::Material& material = mesh.object->material;
        blocks.push_back(
            {.view = views::viewBlock(in.eye, in.size),
             .share = vec4(in.irradiance ? vec3(1) : wholeOf(wholes_, material, settings), 0),
             .object = mesh.index,
             .ior = in.irradiance ? 1 : material.translucent().surfaceIor(), // at 1 all of it enters
             .roughness = material.translucent().roughness,
             .firstLight = in.first,
             .endLight = in.end,
             .placed = in.placed,
             .columns = in.occlusion.columns});
    }
    if (blocks.empty()) return Done{};
    return recordEnter(graph, context, *seen_, in.surface, in.table, in.occlusion, in.flux, blocks, false,
                       "light that scattering objects mirror, or take in where it is seen");
}

Status Entering::add(graph::FrameGraph& graph, gl::Context& context, const Arriving& in,
                     const Plan::State& plan, const Settings& settings) {
    const bool takesInSeen = in.irradiance || settings.method == Method::Lambert;
    if (in.first == 0) {
        samples_ = in.samples;
        onLayers_ = !takesInSeen && plan.onLayers;
        const bool shines = !in.radiosity && in.placed > 0;
        if (!takesInSeen && !shines)
            seen_.reset();
        else if (!seen_)
            seen_.emplace();
        std::optional<EnteredKey> key;
        if (!in.fluxOn && !hasWater(in)) key = keyOf(in, plan); // others may change unseen
        if (key) key->onLayers = onLayers_;
        isKept_ = key && key == key_;
        key_.reset();
        wanted_ = std::move(key);
        if (!onLayers_)
            bodies_.clear();
        else if (!isKept_)
            if (Status s = peel(graph, context, in, plan); !s) return s;
    }
    if (seen_)
        if (Status s = addSeen(graph, context, in, settings); !s) return s;
    for (const Plan::State::Object& object : plan.objects) {
        if (!onLayers_ || isKept_ || !bodies_.count(object.index)) continue;
        LitBody& body = bodies_[object.index];
        for (int axis = 0; axis < 3; ++axis)
            for (LitLayer& layer : body.layers[std::size_t(axis)])
                if (Status s = addTo(graph, context, in, object, axis, layer); !s) return s;
    }
    if (in.end == int(in.samples.size())) key_ = std::move(wanted_);
    return Done{};
}

} // namespace lucent::subsurface
