#include "techniques/subsurface/TemporalHistory.h"

#include "shaders/subsurface/Blocks.h"

#include <algorithm>
#include <cmath>

namespace lucent::subsurface {

using graph::Format;
using graph::TextureId;

namespace {

// By how much a lamp or the environment may turn between pictures that follow each other: 10 degrees, or of a
// lamp that has a place, so much of its distance from the bodies.
constexpr float kTurn = 0.17f;
constexpr double kSquare = 8;                 // distances of points, a square over which light changes evenly
constexpr int kLeastSide = 4, kMostSide = 64; // pixels, of a square

Moment momentOf(const Inputs& in, const Plan::State& plan, const Settings& settings) {
    Moment moment{.size = in.size,
                  .eye = in.eye,
                  .settings = settings,
                  .bodies = {},
                  .lamps = views::lampPoints(in.scene, views::samplingOf(in.scene).lamp),
                  .map = nullptr};
    for (const Plan::State::Object& object : plan.objects) {
        const scene::Object& body = in.scene.objects[std::size_t(object.index)];
        moment.bodies.push_back({object.index, views::objectKey(body, in.scene.view.time), body.painting,
                                 diffusion::mediaOf(body.material), body.material.translucent().thickness});
    }
    if (in.environment != graph::TextureHandle::None) {
        moment.map = in.scene.environment->map;
        moment.sky = vec4(in.scene.environment->rotation, in.scene.environment->intensity);
    }
    return moment;
}

bool isNear(const views::LampPoint& a, const views::LampPoint& b, const std::vector<Moment::Body>& bodies) {
    if (a.color != b.color || a.place.w != b.place.w || a.fades != b.fades || a.cone != b.cone ||
        a.exponent != b.exponent || glm::distance(a.axis, b.axis) > kTurn)
        return false;
    float reach = a.place.w == 0 ? 1 : 1e30f;
    if (a.place.w != 0)
        for (const Moment::Body& body : bodies)
            reach = std::min(reach, glm::distance(vec3(a.place), vec3(body.key.worldFromObject[3])));
    return glm::distance(vec3(a.place), vec3(b.place)) <= kTurn * reach;
}

// Nothing of the two tells them apart.
bool isSame(const Moment& a, const Moment& b) {
    const auto stands = [](const views::LampPoint& one, const views::LampPoint& other) {
        return one.place == other.place && one.axis == other.axis;
    };
    return a.eye.clipFromWorld == b.eye.clipFromWorld && a.bodies == b.bodies && a.sky == b.sky &&
           std::equal(a.lamps.begin(), a.lamps.end(), b.lamps.begin(), b.lamps.end(), stands);
}

// What carries the light of an object over; nothing where it bends, which no matrix does.
std::optional<mat4> thenFromNow(const views::ObjectKey& now, const views::ObjectKey& then) {
    if (now.own != then.own) return std::nullopt;
    return then.worldFromObject * glm::inverse(now.worldFromObject);
}

// Pixels a side of a square over which the points' light is even.
int sideOf(const Inputs& in, const Plan::State& plan) {
    double side = kLeastSide;
    for (const Plan::State::Object& object : plan.objects) {
        const views::Bounds bounds = views::boundsOf(in.scene.objects[std::size_t(object.index)]);
        const float depth = glm::dot(bounds.center() - in.eye.position, in.eye.forward);
        const float pixel = 2 * in.eye.halfExtent.y / float(in.size.y) *
                            (in.eye.perspective ? std::max(depth, in.eye.nearest) : 1.0f);
        side = std::max(side, kSquare * object.profile->kernel.bands.front().spacing / double(pixel));
    }
    return int(std::min(std::ceil(side), double(kMostSide)));
}

// The passes of one picture.
class Steady {
public:
    Steady(graph::FrameGraph& graph, gl::Context& context, const Inputs& in, const Radiosity& now,
           const std::shared_ptr<TemporalHistory>& history, int side)
        : graph_(graph), context_(context), in_(in), now_(now), history_(history), block_{side, now.unit},
          light_(import(history->light)), places_(import(history->places)) {}

    Status carry(const Moment& moment);
    Status change();
    Result<Radiosity> record(Moment moment);

private:
    TextureId import(const graph::Texture& texture) {
        const TextureId id = graph_.import(texture.handle(), texture.desc(), texture.label());
        graph_.keep(id);
        return id;
    }

    graph::FrameGraph& graph_;
    gl::Context& context_;
    const Inputs& in_;
    const Radiosity& now_;
    const std::shared_ptr<TemporalHistory>& history_;
    const ChangeBlock block_;
    const TextureId light_, places_;
    TextureId carried_, change_;
};

Status Steady::carry(const Moment& moment) {
    const gl::Program* program = context_.program("subsurface/carried");
    const Moment& then = history_->moment;
    std::vector<graph::Block> blocks;
    for (std::size_t i = 0; i < moment.bodies.size(); ++i)
        if (const auto matrix = thenFromNow(moment.bodies[i].key, then.bodies[i].key))
            blocks.push_back(CarriedBlock{.view = views::viewBlock(then.eye, then.size),
                                          .thenFromNow = *matrix,
                                          .object = moment.bodies[i].index});
    graph_.addPass("subsurface.carried", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("what left in the picture before, where it is now");
        for (const TextureId id : {now_.places, light_, places_})
            pass.sample(id);
        carried_ = pass.createColor("subsurface.carried", {.size = in_.size, .format = Format::RGBA32F});
        pass.clear(carried_, vec4(0));
        return [=, now = now_.places, light = light_, then = places_](const graph::Resources& resources,
                                                                      graph::Commands& commands) {
            for (const graph::Block& block : blocks)
                commands.draw({.program = program,
                               .block = block,
                               .textures = {{"uPlaces", resources[now]},
                                            {"uThen", resources[then]},
                                            {"uLight", resources[light]}}});
        };
    });
    return Done{};
}

Status Steady::change() {
    const gl::Program* program = context_.program("subsurface/change");
    graph_.addPass("subsurface.change", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("how light has changed over squares of " + std::to_string(block_.side) + " pixels");
        for (const TextureId id : {now_.places, now_.light, carried_})
            pass.sample(id);
        change_ = pass.createColor("subsurface.change", {.size = (in_.size + block_.side - 1) / block_.side,
                                                         .format = Format::RGBA32F});
        return [program, now = now_, carried = carried_, block = block_](const graph::Resources& resources,
                                                                         graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = block,
                           .textures = {{"uPlaces", resources[now.places]},
                                        {"uNow", resources[now.light]},
                                        {"uCarried", resources[carried]}}});
        };
    });
    return Done{};
}

Result<Radiosity> Steady::record(Moment moment) {
    const bool follows = bool(carried_);
    const gl::Program* program = context_.program(
        "subsurface/steady", follows ? std::vector<std::string>{"FOLLOWS"} : std::vector<std::string>{});
    graph_.addPass("subsurface.steady", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(follows ? "light that leaves, mixed with that of the picture before"
                            : "light that leaves, kept for the next picture");
        for (const TextureId id : {now_.places, now_.light})
            pass.sample(id);
        if (follows)
            for (const TextureId id : {carried_, change_})
                pass.sample(id);
        pass.write(light_);
        pass.write(places_);
        return [=, now = now_, carried = carried_, change = change_, block = block_, history = history_,
                moment = std::move(moment)](const graph::Resources& resources, graph::Commands& commands) {
            graph::Draw draw{
                .program = program,
                .block = block,
                .textures = {{"uPlaces", resources[now.places]}, {"uNow", resources[now.light]}}};
            if (follows) {
                draw.textures.push_back({"uCarried", resources[carried]});
                draw.textures.push_back({"uChange", resources[change]});
            }
            commands.draw(draw);
            history->moment = moment;
            history->drawn = true;
        };
    });
    return Radiosity{light_, 1, now_.places};
}

} // namespace

bool follows(const Moment& now, const Moment& then) {
    const auto isOne = [](const Moment::Body& a, const Moment::Body& b) {
        return a.index == b.index && a.painting == b.painting && a.media == b.media &&
               a.thickness == b.thickness;
    };
    const auto isNearOne = [&](const views::LampPoint& a, const views::LampPoint& b) {
        return isNear(a, b, now.bodies);
    };
    return now.size == then.size && now.eye.shift == then.eye.shift && now.settings == then.settings &&
           now.eye.perspective == then.eye.perspective && now.map == then.map && now.sky.w == then.sky.w &&
           glm::distance(vec3(now.sky), vec3(then.sky)) <= glm::degrees(kTurn) &&
           std::equal(now.bodies.begin(), now.bodies.end(), then.bodies.begin(), then.bodies.end(), isOne) &&
           std::equal(now.lamps.begin(), now.lamps.end(), then.lamps.begin(), then.lamps.end(), isNearOne) &&
           !isSame(now, then);
}

Result<Radiosity> recordSteady(graph::FrameGraph& graph, gl::Context& context, const Inputs& in,
                               const Plan::State& plan, const Radiosity& now, const Settings& settings,
                               const std::shared_ptr<TemporalHistory>& history) {
    const graph::TextureDesc desc{.size = in.size, .format = Format::RGBA32F};
    if (!history->light || history->light.desc() != desc) {
        history->light = graph::Texture(context.device(), desc, "subsurface.history");
        history->places = graph::Texture(context.device(), desc, "subsurface.historyPlaces");
        history->drawn = false;
    }
    Moment moment = momentOf(in, plan, settings);
    Steady steady(graph, context, in, now, history, sideOf(in, plan));
    if (history->drawn && follows(moment, history->moment)) {
        if (Status s = steady.carry(moment); !s) return s.error();
        if (Status s = steady.change(); !s) return s.error();
    }
    return steady.record(std::move(moment));
}

} // namespace lucent::subsurface
