#include "light/Occlusion.h"

#include "light/FlatWater.h"
#include "shaders/light/Blocks.h"
#include "views/Fields.h"

#include <algorithm>

namespace lucent::views {

using graph::TextureId;

namespace {

constexpr int kMostSamples = 64;    // no draw should hold a desktop up
constexpr int kSamplesPerTexel = 4; // one a channel
constexpr int kPartShare = 2;      // a lamp's view has as many times the texels a side of one of its samples,
constexpr int kDirectionShare = 4; // and of a direction of an environment
constexpr int kLeastShadowSize = 16; // texels a side
constexpr int kThresholds = 8; // of what is blended, over which the shadow of a lamp without size is the mean
constexpr float kGolden = 0.618034f; // parts that its multiples leave of one are never close together

// Pixels that the same things can shade: those of one height field, or of all other shapes.
struct Group {
    const DrawnField* field; // null: other shapes
    Bounds bounds;
    Drawables casters;
};

bool isBlended(const Drawable::Ptr& one) { return one->isBlended(); }

bool isEmpty(const Bounds& bounds) { return glm::any(glm::lessThan(bounds.high, bounds.low)); }

std::vector<Group> groupsOf(const Lit& in) {
    std::vector<Group> groups;
    const auto reached = [&](const Bounds& all) { return in.allAround ? all : seenBy(in.eye, all); };
    const Drawables solids = filtered(opaque(in.drawables), [](const Drawable& one) { return !one.field(); });
    const Drawables seen = visible(solids);
    Bounds bounds = in.beside;
    if (!seen.empty()) bounds.add(reached(boundsOfAll(in.allAround ? solids : seen)));
    if (!isEmpty(bounds)) groups.push_back({nullptr, bounds, in.drawables});
    for (const auto& one : visible(in.drawables))
        if (one->field())
            groups.push_back(
                {one->field(), reached(one->bounds()),
                 filtered(in.drawables, [&](const Drawable& other) { return &other != &*one; })});
    return groups;
}

int copiesOf(std::size_t samples) { return (int(samples) + kSamplesPerTexel - 1) / kSamplesPerTexel; }

int shadowSizeFor(const LampPoint& sample, int size) {
    const int share = sample.isEnvironment ? kDirectionShare : sample.isPart ? kPartShare : 1;
    return std::max(kLeastShadowSize, size / share);
}

// One view whose pixels are shaded.
struct Target {
    const Eye& eye;
    ivec2 size;
    TextureId surface;
    const DrawnField* field; // null: all but fields
    TextureId places{};      // as LitView's
};

light::OcclusionBlock blockOf(const Target& target, const LampPoint& sample, const Shadow& shadow,
                              ivec2 corner, int channel, float share) {
    light::OcclusionBlock block{.view = viewBlock(target.eye, target.size),
                                .faces = facesOf(shadow.views),
                                .source = sample.place,
                                .faceCount = int(shadow.views.faces.size()),
                                .water = shadow.water};
    block.channel[channel] = share;
    block.corner = vec2(corner);
    if (!target.field) return block;
    const scene::Object& object = *target.field->object;
    block.worldFromObject = object.transform.worldFromObject();
    block.texels = vec2(object.field().texels());
    block.texelSize = object.field().texelSize();
    block.object = target.field->index;
    return block;
}

Occlusion emptyFor(const gl::Context& context, ivec2 size, std::span<const LampPoint> samples) {
    const int copies = std::max(1, copiesOf(samples.size()));
    return {.columns = std::clamp(context.caps().maxTextureSize / size.x, 1, copies),
            .byWater = std::any_of(samples.begin(), samples.end(),
                                   [](const LampPoint& sample) { return sample.water != WaterPath::None; })};
}

// Adds what one sample's shadow keeps from a view.
//
// @param share  of the sample that this shadow stands for
Status add(graph::FrameGraph& graph, gl::Context& context, const Target& target, const LampPoint& sample,
           const Shadow& shadow, std::size_t number, std::size_t samples, Occlusion& occlusion,
           float share = 1) {
    std::vector<std::string> defines;
    if (target.field) defines.push_back("OF_FIELD");
    if (target.places) defines.push_back("OF_PLACES");
    if (shadow.way == Way::OverWater) defines.push_back("OVER_WATER");
    if (shadow.way == Way::BelowWater) defines.push_back("BELOW_WATER");
    const gl::Program* program = context.program("light/occlusion", defines);
    const int copy = int(number) / kSamplesPerTexel, copies = copiesOf(samples), columns = occlusion.columns;
    const ivec2 corner = ivec2(copy % columns, copy / columns) * target.size;
    const bool isFirst = !occlusion.texture;
    if (isFirst)
        occlusion.texture = graph.create(
            "light.occlusion", {.size = target.size * ivec2(columns, (copies + columns - 1) / columns)});
    graph.addPass("light.occlusion", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(target.field ? "what keeps a light sample from a height field"
                                 : "what keeps a light sample from surfaces");
        pass.sample(target.surface);
        pass.sample(shadow.map);
        if (target.places) pass.sample(target.places);
        pass.write(occlusion.texture);
        if (isFirst) pass.clear(occlusion.texture, vec4(0));
        return [surface = target.surface, places = target.places, map = shadow.map, program,
                region = ivec4(corner, target.size),
                block = blockOf(target, sample, shadow, corner, int(number) % kSamplesPerTexel, share)](
                   const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uSurface", resources[surface]},
                                                 {"uShadow", resources[map]}};
            if (places) textures.push_back({"uPlaces", resources[places]});
            commands.draw({.program = program,
                           .region = region,
                           .blend = graph::Blend::Add,
                           .block = block,
                           .textures = textures});
        };
    });
    return Done{};
}

// What is kept of a sample's shadow, or a new one.
Result<TextureId> shadowOf(graph::FrameGraph& graph, gl::Context& context, KeptShadows* kept,
                           const ShadowViews& views, const Drawables& casters, const Bounds& receivers) {
    std::vector<int> numbers;
    for (const auto& one : casters)
        numbers.push_back(one->index);
    if (const TextureId known = kept ? kept->find(graph, views, numbers) : TextureId{}) return known;
    Result<TextureId> map = recordShadow(graph, context, views, casters, receivers);
    if (map && kept) kept->keep(graph, views, std::move(numbers), *map);
    return map;
}

// How many shadows of one sample differ: one, unless there is no other sample to differ from it by what it
// sees of what is blended.
int thresholdsFor(const LampPoint& sample, const Drawables& casters) {
    const bool isAlone = !sample.isPart && !sample.isEnvironment;
    return isAlone && std::any_of(casters.begin(), casters.end(), isBlended) ? kThresholds : 1;
}

// Those that can stand in a sample's way to what a group shades. What water bends goes other ways.
Drawables inWayOf(const LampPoint& sample, Drawables casters, const Bounds& receivers) {
    if (sample.water != WaterPath::None) return casters;
    return filtered(std::move(casters), [&](const Drawable& one) {
        return mayShade(sample.source.place, one.bounds(), receivers);
    });
}

// A shadow without its map, and around what may lie in it.
struct Casting {
    Shadow shadow;
    Bounds receivers;
};
// What a sample sees of what stands in its way: straight on; or through water, over that and from where it
// entered on.
std::vector<Casting> castingsOf(const Lit& in, const LampPoint& sample, const Bounds& casters,
                                const Bounds& receivers) {
    const int size = shadowSizeFor(sample, in.shadowSize);
    const auto casting = [&](const ShadowSource& source, const Bounds& reached) {
        return Casting{{shadowViews(source, casters, reached, size)}, reached};
    };
    if (sample.water == WaterPath::None || !in.water) return {casting(sample.source, receivers)};
    Bounds withSurface = surfaceOf(*in.water); // for both of its paths alike: the depths are the same
    withSurface.add(receivers);
    const Casting straight = casting(sample.source, withSurface);
    if (sample.water == WaterPath::Beside) return {straight};
    const vec3 up(in.water->up), bent = bentBy(*in.water, vec3(sample.place));
    if (bent == vec3(0)) return {};
    std::vector<Casting> ways{straight,
                              casting({.place = vec4(bent, 0)}, reachedBelow(*in.water, bent, receivers))};
    ways[0].shadow.way = Way::OverWater;
    ways[1].shadow.way = Way::BelowWater;
    for (Eye& face : ways[1].shadow.views.faces)
        face.cut = vec4(-up, glm::dot(up, vec3(in.water->middle)));
    for (Casting& one : ways)
        one.shadow.water = *in.water;
    return ways;
}

// The same views with thresholds beside those of other samples, of the same one and of the same pixel.
void setThreshold(ShadowViews& views, const Lit& in, const Drawables& casters, std::size_t number, int i,
                  int of) {
    if (std::none_of(casters.begin(), casters.end(), isBlended)) return; // so that they are kept
    for (Eye& face : views.faces)
        face.threshold = glm::fract(float(number) * kGolden + (float(i) + in.eye.threshold) / float(of));
}

} // namespace

int mostSamplesAtOnce(const gl::Context& context, ivec2 size) {
    const ivec2 copies = ivec2(context.caps().maxTextureSize) / size;
    return std::clamp(kSamplesPerTexel * copies.x * copies.y, 1, kMostSamples);
}

std::vector<std::string> Occlusion::defines() const {
    std::vector<std::string> list;
    if (texture) list.push_back("USE_OCCLUSION");
    if (byWater) list.push_back("USE_WATER");
    return list;
}

Result<Occlusion> recordOcclusion(graph::FrameGraph& graph, gl::Context& context, const Lit& in,
                                  std::span<const LampPoint> samples) {
    Occlusion occlusion = emptyFor(context, in.size, samples);
    occlusion.byWater |= in.water.has_value(); // slices of lamps alone are shaded by the same programs
    for (const Group& group : groupsOf(in)) {
        Shadow before; // of the sample before this one
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const LampPoint& sample = samples[i];
            const bool passes = sample.isEnvironment && !in.carriesEnvironment;
            const Drawables casters =
                inWayOf(sample, passes ? opaque(group.casters) : group.casters, group.bounds);
            std::vector<Shadow> shadows;
            for (auto& [shadow, receivers] : castingsOf(in, sample, boundsOfAll(casters), group.bounds)) {
                const int thresholds = shadow.views.faces.empty() ? 0 : thresholdsFor(sample, casters);
                for (int threshold = 0; threshold < thresholds; ++threshold) {
                    setThreshold(shadow.views, in, casters, i, threshold, thresholds);
                    KeptShadows* const kept = sample.isPart && !in.keepsParts ? nullptr : in.kept;
                    const bool isThere = sample.water == WaterPath::Through && shadow.views == before.views;
                    Result<TextureId> map =
                        isThere ? before.map
                                : shadowOf(graph, context, kept, shadow.views, casters, receivers);
                    if (!map) return map.error();
                    shadow.map = *map;
                    const Target target{in.eye, in.size, in.surface, group.field};
                    if (Status s = add(graph, context, target, sample, shadow, i, samples.size(), occlusion,
                                       1 / float(thresholds));
                        !s)
                        return s.error();
                }
                shadows.push_back(std::move(shadow));
            }
            before = shadows.empty() ? Shadow{} : shadows.front();
            if (!group.field) occlusion.shadows.push_back(std::move(shadows));
        }
    }
    return occlusion;
}

Result<Occlusion> recordOcclusion(graph::FrameGraph& graph, gl::Context& context, const LitView& view,
                                  std::span<const LampPoint> samples,
                                  std::span<const std::vector<Shadow>> shadows) {
    Occlusion occlusion = emptyFor(context, view.size, samples);
    const Target target{view.eye, view.size, view.surface, nullptr, view.places};
    for (std::size_t i = 0; i < samples.size(); ++i)
        for (const Shadow& shadow : shadows[i]) {
            if (!shadow.map) continue;
            if (Status s = add(graph, context, target, samples[i], shadow, i, samples.size(), occlusion); !s)
                return s.error();
        }
    return occlusion;
}

} // namespace lucent::views
