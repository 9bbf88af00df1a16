#include "techniques/caustics/Caustics.h"

#include "techniques/caustics/LightPasses.h"
#include "views/Glass.h"
#include "views/Surface.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace lucent::caustics {

namespace {

constexpr std::string_view kIntersects[] = {"hybrid", "fixed-point", "newton", "secant"};
constexpr std::string_view kDeposits[] = {"beam", "splat", "lines"};
constexpr std::string_view kPointMaps[] = {"cube", "paraboloids"};

// A point of a light that looks at meshes no wider than their vertices ask for: their box may be too wide for
// one view where they are not. Moving ones are looked at by their box.
views::ShadowSource aimedAt(views::ShadowSource source, const views::Drawables& bending,
                            const views::Bounds& bounds) {
    const vec3 place(source.place), towards = bounds.center() - place;
    if (source.place.w == 0 || glm::length(towards) == 0) return source;
    const vec3 axis = glm::normalize(towards);
    float tangent = 0;
    for (const auto& one : bending) {
        if (scene::moves(*one->object)) return source;
        const mat4 worldFromObject = one->object->transform.worldFromObject();
        for (const vec3& position : scene::meshOf(*one->object)->positions) {
            const vec3 v = vec3(worldFromObject * vec4(position, 1)) - place;
            const float depth = glm::dot(v, axis);
            if (depth <= 0) return source;
            tangent = std::max(tangent, glm::length(v - depth * axis) / depth);
        }
    }
    if (tangent >= source.tangent) return source;
    source.axis = axis;
    source.tangent = tangent;
    return source;
}

// Faces of a cube show a little more than a sixth of everything: light there would count twice.
int borderOf(const std::vector<views::Eye>& faces, int size) {
    if (faces.size() == 1) return 0;
    return int(std::lround(0.5f * float(size) * (1 - 1 / faces.front().halfExtent.x)));
}

} // namespace

// All of what scatters light to where it is shown, too, and a little around: beams that end beside the map
// are no beams, and so are frayed where it ends.
views::Bounds Caustics::receiving(const views::Eye* eye, const views::Drawables& drawables,
                                  const Settings& settings) {
    constexpr float kMargin = 1.0f / 16, kRays = 4; // of the longest side; at least
    const views::Drawables receivers = receiversOf(opaque(drawables));
    const views::Drawables glass = refractive(drawables);
    const float ray =
        glass.empty() ? 0 : 2 * boundsOfAll(glass).radius() / float(settings.grid); // m between two
    views::Bounds seen;
    for (const auto& one : receivers) {
        const bool isWhole = !eye || (one->isVisible() && one->object->material.isScattering());
        seen.add(isWhole ? one->bounds() : views::seenBy(*eye, one->bounds()));
    }
    const views::Bounds all = boundsOfAll(receivers);
    const vec3 size = seen.high - seen.low;
    const vec3 margin(std::max(kMargin * std::max({size.x, size.y, size.z}), kRays * ray));
    return {glm::max(seen.low - margin, all.low), glm::min(seen.high + margin, all.high)};
}

namespace {

// All directions from a point as one paraboloid towards what receives, and one away from it if any of that
// lies there.
views::ShadowViews paraboloidsOf(const vec3& place, const views::Bounds& receivers, int size) {
    const vec3 towards = receivers.center() - place;
    views::Eye eye{.position = place,
                   .forward = glm::length(towards) > 0 ? glm::normalize(towards) : vec3(0, -1, 0),
                   .perspective = true,
                   .halfExtent = vec2(float(size) / float(size - 4))}; // texels around what lies on the rim
    eye.right = glm::normalize(
        glm::cross(eye.forward, std::abs(eye.forward.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0)));
    eye.up = glm::cross(eye.right, eye.forward);
    views::Eye back = eye;
    back.forward = -eye.forward;
    back.right = -eye.right;
    const vec3 nearest = glm::mix(receivers.low, receivers.high, glm::lessThan(eye.forward, vec3(0)));
    const bool isAllBefore = glm::dot(nearest - place, eye.forward) > 0;
    return {.faces = isAllBefore ? std::vector{eye} : std::vector{eye, back}, .size = size};
}

// Whether an object does not lie behind itself, and light that leaves it outside does not meet it again: one
// surface that bends nowhere away from any lamp.
bool isConvex(const scene::Object& object) {
    return object.wave.amplitude == vec3(0) && (std::holds_alternative<scene::Plane>(object.shape) ||
                                                std::holds_alternative<scene::Box>(object.shape) ||
                                                std::holds_alternative<scene::Sphere>(object.shape));
}

// Depths of the first and the second receivers that a light sees.
Result<graph::Texture> recordBoth(graph::FrameGraph& graph, gl::Context& context,
                                  const views::ShadowViews& views, const views::Drawables& receivers,
                                  float time) {
    Result<views::Drawables> posed = views::recordPose(graph, context, receivers, time);
    if (!posed) return posed.error();
    const views::Bounds bounds = boundsOfAll(receivers);
    Result<graph::TextureId> depths = views::recordShadow(graph, context, views, *posed, bounds);
    if (!depths) return depths.error();
    Result<graph::TextureId> behind = views::recordShadow(graph, context, views, *posed, bounds, *depths);
    if (!behind) return behind.error();
    const graph::TextureDesc desc{.size = views.imageSize(), .format = graph::Format::RG32F};
    graph::Texture both(context.device(), desc, "caustics.both");
    const graph::TextureId target = graph.import(both.handle(), desc, both.label());
    graph.keep(target);
    const gl::Program* program = context.program("caustics/both");
    graph.addPass("caustics.both", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("whether receivers lie behind others");
        pass.sample(*depths);
        pass.sample(*behind);
        pass.write(target);
        return [program, depths = *depths, behind = *behind](const graph::Resources& resources,
                                                             graph::Commands& commands) {
            commands.draw({.program = program,
                           .textures = {{"uShadow", resources[depths]}, {"uBehind", resources[behind]}}});
        };
    });
    return both;
}

// Whether a light sees receivers behind others, farther than where one pixel of its map cannot tell. False
// while that is not known.
Result<bool> liesBehind(views::Readings& readings, const std::string& question, graph::TexturePool& pool,
                        gl::Context& context, views::ShadowViews views, const views::Drawables& receivers,
                        float time) {
    if (receivers.size() == 1 && isConvex(*receivers.front()->object)) return false;
    constexpr int kLooked = 128; // pixels a side: smaller things are not looked for
    views.size = std::min(views.size, kLooked);
    const Result<const Image*> both = readings.of(question, pool, context, [&](graph::FrameGraph& graph) {
        return recordBoth(graph, context, views, receivers, time);
    });
    if (!both) return both.error();
    if (!*both) return false;
    const Image& image = **both;
    const views::Eye& face = views.faces.front();
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        const float depth = image.pixels[i], next = image.pixels[i + 1];
        const float texel = 2 * face.halfExtent.x / float(views.size) * (face.perspective ? depth : 1);
        if (next < 1e29f && next - depth > texel) return true;
    }
    return false;
}

// How many surfaces lie behind each other in a view of a lamp. Of one convex thing that is known without a
// look; pictures are read back for all others.
Result<int> surfacesIn(views::Readings& readings, const std::string& question, graph::TexturePool& pool,
                       gl::Context& context, const views::Eye& face, const views::Drawables& glass,
                       float time, int size) {
    if (glass.size() == 1 && isConvex(*glass.front()->object)) return 2;
    return views::countLayers(readings, question, pool, context, face, glass, time, ivec2(size));
}

// A few pixels for each ray, because surfaces stand in these pixels and because what no beam carries has a
// ray for each of them. Their number for a ray is odd: it runs through the middle one.
constexpr int kLeastView = 384;
int viewSizeOf(int grid, int least = kLeastView) {
    const int pixels = std::max(3, (least + grid - 1) / grid);
    return grid * (pixels | 1);
}

constexpr int kMostCoarse = 4;

// For samples of an environment, whose size blurs what they throw: coarser by up to four times a side, as
// long as what is left of a map's texels is finer than the blur.
//
// @param reach  m that light goes from where it is bent, about
int coarsenessOf(const views::LampPoint& lamp, float reach, const views::ShadowViews& map) {
    if (!lamp.isEnvironment) return 1;
    const vec2 half = map.faces.front().halfExtent;
    const float blur = spreadOf(lamp) * reach * float(map.size) / (2 * std::max(half.x, half.y)); // texels
    int coarseness = 1;
    while (coarseness < kMostCoarse && blur >= 2 * coarseness)
        coarseness *= 2;
    return coarseness;
}
Settings coarser(Settings settings, int coarseness) {
    constexpr int kLeastGrid = 16, kLeastMap = 64;
    settings.grid = std::max(settings.grid / coarseness, std::min(settings.grid, kLeastGrid));
    settings.mapSize = std::max(settings.mapSize / coarseness, std::min(settings.mapSize, kLeastMap));
    return settings;
}

// How far light goes through refractive objects, about: by the least side of each.
float thicknessOf(const views::Drawables& glass) {
    float sum = 0;
    for (const auto& one : glass) {
        const vec3 size = one->bounds().high - one->bounds().low;
        sum += std::min({size.x, size.y, size.z});
    }
    return glass.empty() ? 0 : sum / float(glass.size());
}

// Around all ways from a box to a lamp.
views::Bounds waysTo(const views::LampPoint& lamp, views::Bounds box) {
    const vec3 place(lamp.place);
    if (lamp.place.w != 0) {
        box.add(place);
        return box;
    }
    constexpr float kFar = 1e30f;
    box.low = glm::mix(box.low, vec3(-kFar), glm::lessThan(place, vec3(0)));
    box.high = glm::mix(box.high, vec3(kFar), glm::greaterThan(place, vec3(0)));
    return box;
}

// Around what may stand between a lamp and what lies in a box; empty where nothing does.
views::Bounds hidingFrom(const views::LampPoint& lamp, const views::Bounds& box,
                         const views::Drawables& solids) {
    const views::Bounds ways = waysTo(lamp, box);
    views::Bounds hiding;
    for (const auto& solid : solids) {
        const views::Bounds one = solid->bounds();
        if (glm::all(glm::greaterThanEqual(one.high, ways.low)) &&
            glm::all(glm::lessThanEqual(one.low, ways.high)))
            hiding.add(one);
    }
    return hiding;
}

} // namespace

std::string_view nameOf(Intersect intersect) { return kIntersects[std::size_t(intersect)]; }
std::string_view nameOf(Deposit deposit) { return kDeposits[std::size_t(deposit)]; }

const ParamTable& Caustics::params() {
    static const Param list[] = {
        declare(
            &Settings::intersect,
            {.id = "intersect",
             .label = "Intersection",
             .group = Group::Caustics,
             .doc =
                 "How the place is found where a ray intersects a receiver: within a bracket that secants or "
                 "halving shrink; by the dissertation's fixed point; by Newton's method; by secants.",
             .choices = kIntersects}),
        declare(&Settings::deposit,
                {.id = "deposit",
                 .label = "Deposit",
                 .group = Group::Caustics,
                 .doc = "What light leaves on receivers: the triangles between rays, with flux over area; "
                        "the dissertation's Gaussian points; or rays as lines that intersect what the "
                        "picture shows, "
                        "whose light is gathered there.",
                 .choices = kDeposits}),
        declare(&Settings::grid, {.id = "grid",
                                  .label = "Rays a side",
                                  .min = 2,
                                  .max = 1024,
                                  .low = 32,
                                  .high = 512,
                                  .logarithmic = true,
                                  .group = Group::Caustics,
                                  .doc = "Rays along a side of what a light sees of refractive objects and "
                                         "mirrors. More draw finer lines of light."}),
        declare(&Settings::refine,
                {.id = "refine",
                 .label = "Adaptive refinement",
                 .group = Group::Caustics,
                 .doc =
                     "Where neighbouring rays part, as at outlines, light is traced by single pixels of the "
                     "lamp's view rather than by cells of the grid of rays. Of beams, and of lamps without "
                     "size."}),
        declare(&Settings::mapSize, {.id = "mapSize",
                                     .label = "Caustic map",
                                     .unit = "texels",
                                     .min = 16,
                                     .max = 4096,
                                     .low = 128,
                                     .high = 2048,
                                     .logarithmic = true,
                                     .group = Group::Caustics,
                                     .doc = "Texels along a side of the image in which light adds up. More "
                                            "are sharper, and need more rays."}),
        declare(&Settings::pointMap,
                {.id = "pointMap",
                 .label = "Map of a point light",
                 .group = Group::Caustics,
                 .doc =
                     "How the image in which light adds up lies about a lamp with receivers all around: as "
                     "up to six faces of a cube; or as two paraboloids, coarser in a third of the memory.",
                 .choices = kPointMaps}),
        declare(&Settings::steps, {.id = "steps",
                                   .label = "Steps",
                                   .min = 1,
                                   .max = 256,
                                   .low = 1,
                                   .high = 64,
                                   .logarithmic = true,
                                   .group = Group::Caustics,
                                   .doc = "How often, at most, the receivers' image is looked up to find "
                                          "where a ray meets them. Too few put light beside its place."}),
        declare(&Settings::receiverLayers,
                {.id = "receiverLayers",
                 .label = "Receiver layers",
                 .min = 1,
                 .max = 2,
                 .group = Group::Caustics,
                 .doc =
                     "2: light that passes an edge of what the lamp sees first, as under a table, falls on "
                     "what lies behind. Of the hybrid intersection; where nothing lies behind, it costs "
                     "nothing."}),
        declare(&Settings::wavelengths,
                {.id = "wavelengths",
                 .label = "Wavelengths",
                 .min = 3,
                 .max = 64,
                 .low = 3,
                 .high = 32,
                 .group = Group::Caustics,
                 .doc = "Kinds of light that glass with dispersion bends differently: 3 stand for red, green "
                        "and blue, more for as many parts of the spectrum, whose colours then run into each "
                        "other as in a rainbow."}),
        declare(&Settings::directions,
                {.id = "environmentDirections",
                 .label = "Directions of the environment",
                 .min = 0,
                 .max = 1024,
                 .low = 0,
                 .high = 64,
                 .group = Group::Caustics,
                 .doc =
                     "How many directions, more of them where the map is bright, stand for the environment "
                     "whose light glass, water and mirrors throw, each blurred by how much of the map it "
                     "stands for; 0: it passes glass straight on."}),
    };
    static const ParamTable table = tableOf<Settings>("caustics", list, "Caustics");
    return table;
}

bool carriesEnvironment(const scene::Scene& scene) {
    const auto settings = scene.technique.find("caustics");
    return views::hasEnvironment(scene) && settings != scene.technique.end() &&
           settings->second.as<Settings>().directions > 0;
}

std::optional<std::string> Caustics::need(const scene::Scene& scene) {
    return scene.lights.empty() && !carriesEnvironment(scene) ? std::nullopt : thrown(scene);
}

std::optional<std::string> Caustics::thrown(const scene::Scene& scene) {
    const auto find = [&](auto wanted) -> const scene::Object* {
        const auto found = std::find_if(scene.objects.begin(), scene.objects.end(),
                                        [&](const auto& one) { return wanted(one); });
        return found == scene.objects.end() ? nullptr : &*found;
    };
    const auto bendsLight = [](const scene::Object& one) {
        return !one.isField() && (one.material.isRefractive() || one.material.isMirror());
    };
    const scene::Object* bends = find(bendsLight);
    const scene::Object* receives = find([&](const scene::Object& one) { return !bendsLight(one); });
    if (!bends || !receives) return std::nullopt;
    return "object \"" + bends->name + "\" casts a caustic on \"" + receives->name + "\"";
}

Result<Plan> Caustics::plan(views::Readings& readings, graph::TexturePool& pool, const scene::Scene& scene,
                            const views::Bounds& receiving, const views::Drawables& drawables,
                            const Settings& asked) const {
    Plan plan;
    const views::Drawables glass = refractive(drawables), solids = opaque(drawables),
                           mirrors = mirrorsOf(solids), receivers = receiversOf(solids);
    if (Status legal = checkLimits(glass, mirrors, asked); !legal) return legal.error();
    const views::Bounds glassBox = boundsOfAll(glass), mirrorBox = boundsOfAll(mirrors);
    const views::Drawables traced = tracedMirrorsOf(solids);
    const bool meetsAgain =
        mirrors.size() + glass.size() > 1 || (mirrors.size() == 1 && !isConvex(*mirrors.front()->object));
    // what stands before glass and mirrors hides them
    const views::Bounds everything = boundsOfAll(drawables);
    views::Bounds throwing = glassBox;
    throwing.add(mirrorBox);
    const views::Sampling sampling{.lamp = views::samplingOf(scene).lamp,
                                   .directions = asked.directions,
                                   .environment = views::EnvironmentSampling::Importance};
    int number = 0;
    for (const views::LampPoint& point : views::lightSamples(scene, sampling)) {
        const std::string question = "caustics, light " + std::to_string(++number);
        if (point.color == vec3(0)) continue;
        const views::LampPoint lamp = views::facing(point, throwing.center());
        views::ShadowSource around = lamp.source; // light leaves the cone of a spot where it is bent
        around.tangent = views::ShadowSource().tangent;
        const auto mapOf = [&](int size) { return views::shadowViews(around, receiving, receiving, size); };
        Plan::Light light{.lamp = lamp, .receivers = mapOf(asked.mapSize)};
        if (light.receivers.faces.empty()) continue;
        const int coarseness = coarsenessOf(lamp, throwing.radius(), light.receivers);
        const Settings settings = light.settings = coarser(asked, coarseness);
        if (coarseness > 1) light.receivers = mapOf(settings.mapSize);
        light.within = 0.5f * thicknessOf(glass);
        if (settings.pointMap == PointMap::Paraboloids && light.receivers.faces.size() > 1)
            light.halves = paraboloidsOf(vec3(lamp.source.place), receiving, settings.mapSize);
        const int size = light.viewSize = viewSizeOf(settings.grid, kLeastView / coarseness);
        const auto viewsOf = [&](const views::Drawables& bending, const views::Bounds& bounds) {
            return views::shadowViews(aimedAt(lamp.source, bending, bounds), everything, bounds, size).faces;
        };
        const bool isOnWater = beginsOnWater(settings, lamp, glass, solids);
        if (isOnWater)
            light.water = {views::shadowViews(lamp.source, hidingFrom(lamp, glassBox, solids), glassBox,
                                              settings.mapSize)};
        const std::vector<views::Eye> faces =
            isOnWater ? std::vector<views::Eye>{} : viewsOf(glass, glassBox);
        for (const views::Eye& face : faces) {
            const std::string seen = question + " face " + std::to_string(&face - faces.data());
            const Result<int> count =
                surfacesIn(readings, seen, pool, context_, face, glass, scene.view.time, size);
            if (!count) return count.error();
            if (*count > 0) light.glass.push_back({face, *count, borderOf(faces, size)});
        }
        const std::vector<views::Eye> mirroring = viewsOf(mirrors, mirrorBox);
        for (const views::Eye& face : mirroring) {
            light.mirrors.push_back({face, 0, borderOf(mirroring, size)});
            if (!meetsAgain || traced.empty()) continue;
            const std::string seen = question + " mirror " + std::to_string(&face - mirroring.data());
            const Result<int> count =
                surfacesIn(readings, seen, pool, context_, face, traced, scene.view.time, size);
            if (!count) return count.error();
            light.mirrors.back().layers = *count;
        }
        if (!light.water && light.glass.empty() && light.mirrors.empty()) continue;
        if (settings.receiverLayers > 1 && settings.intersect == Intersect::Hybrid) {
            Result<bool> lies = liesBehind(readings, question, pool, context_, light.receivers,
                                           withoutBlendedBefore(lamp, throwing, receivers), scene.view.time);
            if (!lies) return lies.error();
            light.hasBehind = *lies;
        }
        plan.lights.push_back(std::move(light));
        if (!readings.areThere()) return plan; // what the next light asks would hold up the answers
    }
    return plan;
}

Status Caustics::checkLimits(const views::Drawables& glass, const views::Drawables& mirrors,
                             const Settings& settings) const {
    if (glass.size() > views::kMostGlass)
        return Error{"caustics: " + std::to_string(glass.size()) + " refractive objects; must be at most " +
                         std::to_string(views::kMostGlass),
                     Fault::Machine};
    if (mirrors.size() > kMostMirrors)
        return Error{"caustics: " + std::to_string(mirrors.size()) + " mirrors; must be at most " +
                         std::to_string(kMostMirrors),
                     Fault::Machine};
    if (const int side = viewSizeOf(settings.grid); side > context_.caps().maxTextureSize)
        return Error{"caustics: grid is " + std::to_string(settings.grid) + ", for which a lamp's view has " +
                         std::to_string(side) + " pixels a side; must be at most " +
                         std::to_string(context_.caps().maxTextureSize) + " on this GPU",
                     Fault::Machine};
    return Done{};
}

Result<Carried> Caustics::record(graph::FrameGraph& graph, const Inputs& in,
                                 std::span<const Plan::Light> lights, std::vector<Map> known) const {
    Carried carried{.irradiance = {}, .maps = std::move(known)};
    const std::size_t made = carried.maps.size();
    Targets targets(graph);
    Inputs all = in;
    const bool hasFields = std::any_of(in.solids.begin(), in.solids.end(),
                                       [](const auto& one) { return one->field() != nullptr; });
    if (hasFields && !lights.empty()) {
        all.solid = graph.create("caustics.shown", {.size = in.size, .format = graph::Format::RGBA32F});
        if (Status s = views::recordSolid(graph, context_, in.eye, in.solids, in.surface, all.solid, in.size);
            !s)
            return s.error();
    }
    for (std::size_t i = 0; i < lights.size(); ++i) {
        LightPasses passes(graph, context_, targets, all, lights[i], pictureOf_);
        Status s =
            i < made ? passes.lookUp(carried.maps[i], carried.irradiance) : passes.record(carried.irradiance);
        if (!s) return s.error();
        if (i >= made && lights[i].settings.deposit != Deposit::Lines) carried.maps.push_back(passes.map());
    }
    return carried;
}

Result<graph::TextureId> Caustics::lookUp(graph::FrameGraph& graph, const Inputs& in,
                                          std::span<const Plan::Light> lights,
                                          const std::vector<Map>& maps) const {
    graph::TextureId sum;
    Targets targets(graph);
    for (std::size_t i = 0; i < maps.size(); ++i)
        if (Status s = LightPasses(graph, context_, targets, in, lights[i], pictureOf_).lookUp(maps[i], sum);
            !s)
            return s.error();
    return sum;
}

Result<Map> Caustics::recordMap(graph::FrameGraph& graph, const Inputs& in, const Plan::Light& light) const {
    graph::TextureId none;
    Targets targets(graph);
    LightPasses passes(graph, context_, targets, in, light, pictureOf_);
    if (Status s = passes.record(none); !s) return s.error();
    return passes.map();
}

namespace {

// Sums the textures of one measured light.
class Ledger {
public:
    Ledger(gl::Device& device, const Targets& targets) : device_(device), targets_(targets) {}

    dvec3 sum(std::string_view label) {
        dvec3 total(0);
        each(label, [&](const Image& image) {
            for (std::size_t i = 0; i < image.pixels.size(); i += 4)
                total += dvec3(image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]);
        });
        return total;
    }
    void each(std::string_view label, const std::function<void(const Image&)>& visit) {
        for (const graph::Texture& texture : targets_.kept())
            if (texture.label() == label) visit(device_.read(texture.handle()));
    }
    std::vector<Image> all(std::string_view label) {
        std::vector<Image> list;
        each(label, [&](const Image& image) { list.push_back(image); });
        return list;
    }

private:
    gl::Device& device_;
    const Targets& targets_;
};

} // namespace

Result<Energy> Caustics::measure(graph::TexturePool& pool, const scene::Scene& scene, const views::Eye& eye,
                                 const views::Drawables& drawables, const Plan& plan) const {
    Energy energy;
    double rays = 0;
    for (const Plan::Light& light : plan.lights) {
        graph::FrameGraph graph;
        Result<views::Drawables> posed = views::recordPose(graph, context_, drawables, scene.view.time);
        if (!posed) return posed.error();
        const Inputs in{scene, eye, refractive(*posed), opaque(*posed), {}, {}};
        Targets targets(graph, &context_.device());
        graph::TextureId none;
        LightPasses passes(graph, context_, targets, in, light, pictureOf_);
        if (Status s = passes.record(none); !s) return s.error();
        if (Status s = graph.compile(); !s) return s.error();
        graph.execute(pool);
        Ledger ledger(context_.device(), targets);
        energy.incident += ledger.sum("caustics.incident");
        energy.absorbed += ledger.sum("caustics.absorbed");
        energy.reflected += ledger.sum("caustics.reflected");
        energy.lost += ledger.sum("caustics.lost");
        energy.received += double(passes.unit()) * ledger.sum("caustics.map");
        const std::vector<Image> flux = ledger.all("caustics.flux"), landing = ledger.all("caustics.landing"),
                                 effort = ledger.all("caustics.effort"),
                                 met = ledger.all("caustics.incident");
        for (std::size_t image = 0; image < flux.size(); ++image)
            for (std::size_t i = 0; i < flux[image].pixels.size(); i += 4) {
                const float* f = &flux[image].pixels[i];
                const dvec3 carried = double(met[image].pixels[i + 3]) * dvec3(f[0], f[1], f[2]);
                const bool landed = landing[image].pixels[i + 3] > 0;
                const bool isAstray = std::abs(effort[image].pixels[i + 1]) > 2;
                if (!landed) energy.missed += carried;
                if (landed && isAstray) energy.astray += carried;
                energy.looks += double(effort[image].pixels[i]);
                if (f[3] > 0) ++rays;
            }
    }
    if (std::string error = context_.takeError(); !error.empty()) return Error{error, Fault::Machine};
    if (rays > 0) energy.looks /= rays;
    return energy;
}

} // namespace lucent::caustics
