#include "light/Occlusion.h"

#include "shaders/light/Blocks.h"

#include <algorithm>

namespace lucent::views {

using graph::TextureId;

namespace {

constexpr int kMostSamples = 64;    // no draw should hold a desktop up
constexpr int kSamplesPerTexel = 4; // one a channel
constexpr int kPartShare = 2;      // a lamp's view has as many times the texels a side of one of its samples,
constexpr int kDirectionShare = 4; // and of a direction of an environment
constexpr int kLeastShadowSize = 16; // texels a side

// Pixels that the same things can shade: those of one height field, or of all other shapes.
struct Group {
    const DrawnObject* field; // null: other shapes
    Bounds bounds;
    std::vector<DrawnObject> casters;
};

std::vector<Group> groupsOf(const Lit& in) {
    std::vector<Group> groups;
    if (!in.solids.empty()) groups.push_back({nullptr, seenBy(in.eye, boundsOfAll(in.solids)), in.casters});
    for (const DrawnObject& field : in.fields) {
        std::vector<DrawnObject> others;
        std::copy_if(in.casters.begin(), in.casters.end(), std::back_inserter(others),
                     [&](const DrawnObject& caster) { return caster.index != field.index; });
        groups.push_back({&field, seenBy(in.eye, boundsOf(*field.object)), std::move(others)});
    }
    return groups;
}

int shadowSizeFor(const LampPoint& sample, int size) {
    const int share = sample.isEnvironment ? kDirectionShare : sample.isPart ? kPartShare : 1;
    return std::max(kLeastShadowSize, size / share);
}

light::OcclusionBlock blockOf(const Lit& in, const Group& group, const LampPoint& sample,
                              const ShadowViews& views, ivec2 corner, int channel) {
    light::OcclusionBlock block{.view = viewBlock(in.eye, in.size),
                                .faces = facesOf(views),
                                .source = sample.place,
                                .faceCount = int(views.faces.size())};
    block.channel[channel] = 1;
    block.corner = vec2(corner);
    if (!group.field) return block;
    const scene::Object& object = *group.field->object;
    block.worldFromObject = object.transform.worldFromObject();
    block.texels = vec2(object.field().texels());
    block.texelSize = object.field().texelSize();
    block.object = group.field->index;
    return block;
}

} // namespace

int mostSamplesAtOnce(const gl::Context& context, ivec2 size) {
    const ivec2 copies = ivec2(context.caps().maxTextureSize) / size;
    return std::clamp(kSamplesPerTexel * copies.x * copies.y, 1, kMostSamples);
}

Result<Occlusion> recordOcclusion(graph::FrameGraph& graph, gl::Context& context, const Lit& in,
                                  std::span<const LampPoint> samples) {
    std::vector<PosedMesh> all = in.opaque;
    all.insert(all.end(), in.refractive.begin(), in.refractive.end());
    const int copies = (int(samples.size()) + kSamplesPerTexel - 1) / kSamplesPerTexel;
    const int columns = std::clamp(context.caps().maxTextureSize / in.size.x, 1, std::max(1, copies));
    Occlusion occlusion{{}, columns};
    for (const Group& group : groupsOf(in)) {
        const gl::Program* program =
            context.program("light/occlusion",
                            group.field ? std::vector<std::string>{"OF_FIELD"} : std::vector<std::string>{});
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const LampPoint& sample = samples[i];
            const std::vector<PosedMesh>& meshes = sample.isEnvironment ? in.opaque : all;
            const ShadowViews views = shadowViews(sample.source, boundsOfAll(meshes, group.casters),
                                                  group.bounds, shadowSizeFor(sample, in.shadowSize));
            if (views.faces.empty()) continue;
            Result<TextureId> shadow =
                recordShadow(graph, context, views, meshes, group.bounds, group.casters);
            if (!shadow) return shadow.error();
            const int copy = int(i) / kSamplesPerTexel;
            const ivec2 corner = ivec2(copy % columns, copy / columns) * in.size;
            const bool isFirst = !occlusion.texture;
            if (isFirst)
                occlusion.texture = graph.create(
                    "light.occlusion", {.size = in.size * ivec2(columns, (copies + columns - 1) / columns)});
            graph.addPass("light.occlusion", [&](graph::PassBuilder& pass) -> graph::Execute {
                pass.reason(group.field ? "what keeps a light sample from a height field"
                                        : "what keeps a light sample from visible surfaces");
                pass.sample(in.surface);
                pass.sample(*shadow);
                pass.write(occlusion.texture);
                if (isFirst) pass.clear(occlusion.texture, vec4(0));
                return [=, surface = in.surface, shadow = *shadow, region = ivec4(corner, in.size),
                        block = blockOf(in, group, sample, views, corner, int(i) % kSamplesPerTexel)](
                           const graph::Resources& resources, graph::Commands& commands) {
                    commands.draw(
                        {.program = program,
                         .region = region,
                         .blend = graph::Blend::Add,
                         .block = block,
                         .textures = {{"uSurface", resources[surface]}, {"uShadow", resources[shadow]}}});
                };
            });
        }
    }
    return occlusion;
}

} // namespace lucent::views
