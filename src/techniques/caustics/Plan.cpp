// What is drawn for each light sample: views of what bends its light and of what receives it.
#include "techniques/caustics/Caustics.h"

#include "techniques/caustics/LightPasses.h"
#include "views/Glass.h"
#include "views/Surface.h"

#include <algorithm>
#include <cmath>

namespace lucent::caustics {

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

// All directions from a point as one paraboloid towards what receives, and one away from it if any of
// that lies there.
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
// Whether an object does not lie behind itself, and light that leaves it outside does not meet it again:
// one surface that bends nowhere away from any lamp.
bool isConvex(const scene::Object& object) {
    return object.wave.amplitude == vec3(0) && (std::holds_alternative<scene::Plane>(object.shape) ||
                                                std::holds_alternative<scene::Box>(object.shape) ||
                                                std::holds_alternative<scene::Sphere>(object.shape));
}
// How far apart two receivers lie at most that a light sees behind each other.
Result<graph::TextureId> recordApart(graph::FrameGraph& graph, gl::Context& context,
                                     const views::ShadowViews& views, const views::Drawables& receivers,
                                     float time) {
    Result<views::Drawables> posed = views::recordPose(graph, context, receivers, time);
    if (!posed) return posed.error();
    const views::Bounds bounds = boundsOfAll(receivers);
    Result<graph::TextureId> depths = views::recordShadow(graph, context, views, *posed, bounds);
    if (!depths) return depths.error();
    Result<graph::TextureId> behind = views::recordShadow(graph, context, views, *posed, bounds, *depths);
    if (!behind) return behind.error();
    const graph::TextureId target =
        graph.create("caustics.apart", {.size = views.imageSize(), .format = graph::Format::RGBA32F});
    const bool fromPlace = views.faces.front().perspective;
    const gl::Program* program = context.program(
        "caustics/apart", fromPlace ? std::vector<std::string>{"PERSPECTIVE"} : std::vector<std::string>{});
    graph.addPass("caustics.apart", [&](graph::PassBuilder& pass) -> graph::Execute {
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
    return target;
}

// A few pixels for each ray, because surfaces stand in these pixels and because what no beam carries has
// a ray for each of them. Their number for a ray is odd: it runs through the middle one.
constexpr int kLeastView = 384;
constexpr int kLeastPreview = 192;
constexpr int kPreviewLayers = 4; // nobody waits for their number
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

// All that the views of each light sample go by.
struct Subject {
    Subject(const scene::Scene& of, const views::Bounds& where, const views::Drawables& drawables,
            const Settings& settings, bool isPreview)
        : scene(of), receiving(where), asked(settings), leastView(isPreview ? kLeastPreview : kLeastView),
          glass(refractive(drawables)), solids(opaque(drawables)), mirrors(mirrorsOf(solids)),
          traced(tracedMirrorsOf(solids)), receivers(receiversOf(solids)), everything(boundsOfAll(drawables)),
          glassBox(boundsOfAll(glass)), mirrorBox(boundsOfAll(mirrors)), throwing(glassBox),
          thickness(thicknessOf(glass)),
          meetsAgain(mirrors.size() + glass.size() > 1 ||
                     (mirrors.size() == 1 && !isConvex(*mirrors.front()->object))) {
        throwing.add(mirrorBox);
    }
    const scene::Scene& scene;
    const views::Bounds& receiving;
    const Settings& asked;
    const int leastView;
    const views::Drawables glass, solids, mirrors, traced, receivers;
    const views::Bounds everything; // what stands before glass and mirrors hides them
    const views::Bounds glassBox, mirrorBox;
    views::Bounds throwing;
    const float thickness;
    const bool meetsAgain; // light that a mirror sends may meet one again
};

// What must be drawn to know how a light sample's views are drawn.
class Questions {
public:
    Questions(views::Readings* readings, graph::TexturePool& pool, gl::Context& context, float time,
              std::string light)
        : readings_(readings), pool_(pool), context_(context), time_(time), light_(std::move(light)) {}

    // How many surfaces lie behind each other in a view of a lamp. Of one convex thing that is known
    // without a look.
    Result<int> surfacesIn(const std::string& view, const views::Eye& face, const views::Drawables& glass,
                           int size) const {
        if (glass.size() == 1 && isConvex(*glass.front()->object)) return 2;
        if (!readings_) return kPreviewLayers;
        return views::countLayers(*readings_, light_ + view, pool_, context_, face, glass, time_,
                                  ivec2(size));
    }

    // Whether a light sees receivers behind others, farther than where one pixel of its map cannot tell.
    // False while that is not known, and in previews.
    Result<bool> liesBehind(views::ShadowViews views, const views::Drawables& receivers) const {
        if (!readings_ || (receivers.size() == 1 && isConvex(*receivers.front()->object))) return false;
        constexpr int kLooked = 128; // pixels a side: smaller things are not looked for
        views.size = std::min(views.size, kLooked);
        const auto apart = readings_->most(light_, pool_, context_, [&](graph::FrameGraph& graph) {
            return recordApart(graph, context_, views, receivers, time_);
        });
        if (!apart) return apart.error();
        return apart->value_or(0) > 2 * views.faces.front().halfExtent.x / float(views.size);
    }

private:
    views::Readings* const readings_; // null: a preview, which asks nothing
    graph::TexturePool& pool_;
    gl::Context& context_;
    const float time_;
    const std::string light_;
};

// The views that a light sample has of what bends light, or of what mirrors it.
std::vector<views::Eye> viewsOf(const Subject& of, const Plan::Light& light, const views::Drawables& bending,
                                const views::Bounds& bounds) {
    return views::shadowViews(aimedAt(light.lamp.source, bending, bounds), of.everything, bounds,
                              light.viewSize)
        .faces;
}

Status addGlass(const Subject& of, const Questions& questions, Plan::Light& light) {
    const std::vector<views::Eye> faces = viewsOf(of, light, of.glass, of.glassBox);
    for (const views::Eye& face : faces) {
        const std::string view = " face " + std::to_string(&face - faces.data());
        const Result<int> count = questions.surfacesIn(view, face, of.glass, light.viewSize);
        if (!count) return count.error();
        if (*count > 0) light.glass.push_back({face, *count, borderOf(faces, light.viewSize)});
    }
    return Done{};
}

Status addMirrors(const Subject& of, const Questions& questions, Plan::Light& light) {
    const std::vector<views::Eye> faces = viewsOf(of, light, of.mirrors, of.mirrorBox);
    for (const views::Eye& face : faces) {
        light.mirrors.push_back({face, 0, borderOf(faces, light.viewSize)});
        if (!of.meetsAgain || of.traced.empty()) continue;
        const std::string view = " mirror " + std::to_string(&face - faces.data());
        const Result<int> count = questions.surfacesIn(view, face, of.traced, light.viewSize);
        if (!count) return count.error();
        light.mirrors.back().layers = *count;
    }
    return Done{};
}

// What is drawn for one light sample; nothing where it throws no light.
Result<std::optional<Plan::Light>> lightOf(const Subject& of, const views::LampPoint& sample,
                                           const Questions& questions) {
    const std::optional<Plan::Light> none;
    const views::LampPoint lamp = views::facing(sample, of.throwing.center());
    views::ShadowSource around = lamp.source; // light leaves the cone of a spot where it is bent
    around.tangent = views::ShadowSource().tangent;
    const auto mapOf = [&](int size) { return views::shadowViews(around, of.receiving, of.receiving, size); };
    Plan::Light light{.lamp = lamp, .receivers = mapOf(of.asked.mapSize)};
    if (light.receivers.faces.empty()) return none;
    const int coarseness = coarsenessOf(lamp, of.throwing.radius(), light.receivers);
    const Settings settings = light.settings = coarser(of.asked, coarseness);
    if (coarseness > 1) light.receivers = mapOf(settings.mapSize);
    light.within = 0.5f * of.thickness;
    if (settings.pointMap == PointMap::Paraboloids && light.receivers.faces.size() > 1)
        light.halves = paraboloidsOf(vec3(lamp.source.place), of.receiving, settings.mapSize);
    light.viewSize = viewSizeOf(settings.grid, of.leastView / coarseness);
    if (beginsOnWater(settings, lamp, of.glass, of.solids))
        light.water = {views::shadowViews(lamp.source, hidingFrom(lamp, of.glassBox, of.solids), of.glassBox,
                                          settings.mapSize)};
    else if (Status s = addGlass(of, questions, light); !s)
        return s.error();
    if (Status s = addMirrors(of, questions, light); !s) return s.error();
    if (!light.water && light.glass.empty() && light.mirrors.empty()) return none;
    if (settings.receiverLayers > 1 && settings.intersect == Intersect::Hybrid) {
        const Result<bool> lies =
            questions.liesBehind(light.receivers, withoutBlendedBefore(lamp, of.throwing, of.receivers));
        if (!lies) return lies.error();
        light.hasBehind = *lies;
    }
    return std::optional(std::move(light));
}

} // namespace

Status Caustics::plan(Plan& plan, views::Readings& readings, graph::TexturePool& pool,
                      const scene::Scene& scene, const views::Bounds& receiving,
                      const views::Drawables& drawables, const Settings& settings, bool isPreview) const {
    constexpr std::size_t kAhead = 4; // light samples that ask before the first one is answered
    const Subject of(scene, receiving, drawables, settings, isPreview);
    if (Status legal = checkLimits(of.glass, of.mirrors, settings); !legal) return legal;
    if (plan.samples.empty()) {
        views::Sampling sampling = views::samplingOf(scene);
        sampling.directions = settings.directions;
        sampling.environment = views::EnvironmentSampling::Importance;
        plan.samples = views::lightSamples(scene, sampling);
    }
    bool waits = false;
    for (std::size_t i = plan.planned; i < std::min(plan.planned + kAhead, plan.samples.size()); ++i) {
        const int missing = readings.missing();
        const Questions questions(isPreview ? nullptr : &readings, pool, context_, scene.view.time,
                                  "caustics, light " + std::to_string(i + 1));
        std::optional<Plan::Light> light;
        if (plan.samples[i].color != vec3(0)) {
            auto found = lightOf(of, plan.samples[i], questions);
            if (!found) return found.error();
            light = std::move(*found);
        }
        waits = waits || readings.missing() > missing;
        if (waits) continue;
        if (light) plan.lights.push_back(std::move(*light));
        ++plan.planned;
    }
    return Done{};
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

} // namespace lucent::caustics
