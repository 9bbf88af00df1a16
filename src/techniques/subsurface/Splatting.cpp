#include "techniques/subsurface/Splatting.h"

#include "light/ShadowMap.h"
#include "shaders/subsurface/Blocks.h"
#include "techniques/subsurface/Entering.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace lucent::subsurface {

using graph::Format;
using graph::TextureId;

namespace {

// Where surfaces are steeper than kTilt says, levels of twice and four times the resolution take over: down
// to 10 degrees from edge-on, where hardly any light enters. Near lamps show things in perspective, too
// coarse at their far side: half of that resolution goes down to 20 degrees. Six scenes of the gallery in
// which it is up to 1.6 times too coarse look the same when it is twice as fine (FLIP 0.003 at most).
constexpr int kRefined = 2;
constexpr float kSpare = 2;
constexpr int kMostScale = 6;               // 64 pixels
constexpr float kHalfOfGaussian = 1.17741f; // deviations, in the plane: sqrt(2 ln 2)
constexpr double kBalls = 3;                // along a side of a splat, about
// Pixels of a splat in the middle of the picture that is drawn as a point. Devices with WebGL2 draw points of
// 255 at least; the rest is for what a wide view stretches at its sides.
constexpr int kMostPoint = 64;
// Points that are gathered at once. A sum of halves keeps 11 bits of each part, so that more points are no
// more parts; a software driver ends a shader's loops after 65535 rounds.
constexpr int kLeastGathered = 4096, kMostGathered = 60000, kParts = 32;

// M_d lies above half of two to this power and not above it.
int octaveOf(float sharpness) { return int(std::ceil(std::log2(sharpness))); }

// Lowest and highest pixel that a box may cover in a picture.
vec4 pixelsOf(const views::Eye& eye, const views::Bounds& box, ivec2 size) {
    const vec4 whole(0, 0, vec2(size));
    vec2 low(1e30f), high(-1e30f);
    for (int i = 0; i < 8; ++i) {
        const vec3 corner(i & 1 ? box.high.x : box.low.x, i & 2 ? box.high.y : box.low.y,
                          i & 4 ? box.high.z : box.low.z);
        const vec4 clip = eye.clipFromWorld * vec4(corner, 1);
        if (clip.w <= 0) return whole;
        const vec2 pixel = (0.5f * vec2(clip) / clip.w + 0.5f) * vec2(size);
        low = glm::min(low, pixel);
        high = glm::max(high, pixel);
    }
    return glm::clamp(vec4(glm::floor(low) - 1.0f, glm::ceil(high) + 1.0f), vec4(0),
                      vec4(vec2(size), vec2(size)));
}

// Points of M_d above the one and up to the other, which leave their light at places of one density: so many
// times is the picture halved for them.
struct Part {
    float bluntest, sharpest;
    int scale;
};

// The passes of one picture.
class Splatter {
public:
    Splatter(graph::FrameGraph& graph, gl::Context& context, const Inputs& in, const Plan::State& plan,
             const Entering& entering, const Settings& settings)
        : graph_(graph), context_(context), in_(in), plan_(plan), entering_(entering), settings_(settings) {}

    Result<Radiosity> record();

private:
    // Places of the picture, one for a square of pixels, and the light that leaves there.
    struct Places {
        TextureId place, light;
        ivec2 size{0};
        int side = 1;
        std::map<int, TextureId> balls{}; // by the places along a side of their squares
    };
    struct Target {
        const Plan::State::Object& plan;
        const views::DrawnMesh& mesh;
        views::Bounds bounds;
        Layout layout;
    };
    Status recordPlaces(int scale);
    Result<TextureId> ballsOf(Places& places, int side);
    Status lit(const Target& target, const views::LampPoint& lamp);
    Status onLayers(const Target& target, const LitBody& body);
    Status splat(const Target& target, const Points& points, int coarser);
    Status splatPart(const Target& target, const Points& points, int coarser, std::size_t band,
                     const Part& part);
    Status spread(std::size_t from);
    double pixelOf(const Target& target) const;
    int scaleOf(const Target& target, double pixel) const;
    std::vector<Part> partsOf(const Target& target, const Band& band) const;
    SplatBlock blockOf(const Target& target, const Band& band) const;

    graph::FrameGraph& graph_;
    gl::Context& context_;
    const Inputs& in_;
    const Plan::State& plan_;
    const Entering& entering_;
    const Settings& settings_;
    bool splats() const { return context_.caps().floatBlend; }
    float brightest() const;

    std::vector<Places> places_; // by scale
    float unit_ = 1;
};

Status Splatter::recordPlaces(int scale) {
    const gl::Program* program = context_.program("subsurface/receivers");
    Places places;
    places.side = 1 << scale;
    places.size = (in_.size + places.side - 1) / places.side;
    const graph::TextureDesc desc{.size = places.size, .format = Format::RGBA32F};
    graph_.addPass("subsurface.receivers", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("places that light leaves to, one for " + std::to_string(places.side) + " x " +
                    std::to_string(places.side) + " pixel(s)");
        pass.sample(in_.surface);
        places.place = pass.createColor("subsurface.receivers", desc);
        return [program, surface = in_.surface, side = places.side,
                view = views::viewBlock(in_.eye, in_.size)](const graph::Resources& resources,
                                                            graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = ReceiversBlock{view, side},
                           .textures = {{"uSurface", resources[surface]}}});
        };
    });
    graph_.addPass("subsurface.dark", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("before any light leaves there");
        places.light =
            pass.createColor("subsurface.radiosity",
                             {.size = places.size, .format = splats() ? Format::RGBA32F : Format::RGBA16F});
        pass.clear(places.light, vec4(0));
        return [](const graph::Resources&, graph::Commands&) {};
    });
    places_.push_back(places);
    return Done{};
}

Result<TextureId> Splatter::ballsOf(Places& places, int side) {
    TextureId& balls = places.balls[side];
    if (balls) return balls;
    const gl::Program* program = context_.program("subsurface/balls");
    graph_.addPass("subsurface.balls", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("balls around " + std::to_string(side) + " x " + std::to_string(side) +
                    " places, which most splats miss");
        pass.sample(places.place);
        balls = pass.createColor("subsurface.balls",
                                 {.size = (places.size + side - 1) / side, .format = Format::RGBA32F});
        return [program, place = places.place, side](const graph::Resources& resources,
                                                     graph::Commands& commands) {
            commands.draw(
                {.program = program, .block = BallsBlock{side}, .textures = {{"uPlaces", resources[place]}}});
        };
    });
    return balls;
}

// Metres that a pixel is wide on the object, where it is nearest.
double Splatter::pixelOf(const Target& target) const {
    const float nearest =
        glm::dot(target.bounds.center() - in_.eye.position, in_.eye.forward) - target.bounds.radius();
    return double(2 * in_.eye.halfExtent.y / float(in_.size.y) *
                  (in_.eye.perspective ? std::max(nearest, in_.eye.nearest) : 1.0f));
}

// So many times is the picture halved for places that lie so far apart [m]; 0 m: not at all.
int Splatter::scaleOf(const Target& target, double wanted) const {
    if (!(wanted > 0)) return 0;
    return std::clamp(int(std::floor(std::log2(wanted / pixelOf(target)))), 0, kMostScale);
}

// All points of an object that is not painted; else those of each octave of M_d, but as one where their
// places lie equally dense.
std::vector<Part> Splatter::partsOf(const Target& target, const Band& band) const {
    constexpr float kAny = 1e30f;
    if (!target.mesh.paint) return {{0, kAny, scaleOf(target, band.pixel)}};
    const views::Paint& paint = *target.mesh.paint;
    const float most = target.layout.grid.sharpness.most;
    const int first = octaveOf(std::min(paint.bluntest, most)),
              last = octaveOf(std::min(paint.sharpest, most));
    std::vector<Part> parts;
    for (int octave = first; octave <= last; ++octave) {
        const float sharpest = std::exp2(float(octave));
        const int scale = scaleOf(target, band.pixel / double(sharpest));
        if (!parts.empty() && parts.back().scale == scale)
            parts.back().sharpest = sharpest;
        else
            parts.push_back({parts.empty() ? 0 : parts.back().sharpest, sharpest, scale});
    }
    parts.back().sharpest = kAny; // whatever rounding made of the largest
    return parts;
}

SplatBlock Splatter::blockOf(const Target& target, const Band& band) const {
    SplatBlock block;
    block.object = target.plan.index;
    block.widest = float(band.spacing);
    block.reach = float(band.reach);
    const auto media = diffusion::mediaOf(target.mesh.object->material);
    std::size_t count = 0;
    for (int c = 0; c < 3; ++c) {
        const auto channel = std::size_t(c);
        block.transport[c] = float(media[channel].transport());
        block.albedo[c] = float(media[channel].albedo());
        const std::vector<diffusion::Pole>& poles = target.plan.profile->poles[channel];
        count = std::max(count, poles.size());
        for (std::size_t i = 0; i < kMostPoles; ++i) {
            const bool is = i < poles.size();
            block.depths[i][c] = is ? float(poles[i].depth) : 1.0f;
            block.weights[i][c] = is ? float(poles[i].weight) : 0.0f;
        }
    }
    block.depths[0].a = float(count);
    return block;
}

Status Splatter::splatPart(const Target& target, const Points& points, int coarser, std::size_t number,
                           const Part& part) {
    const Band& band = target.plan.profile->kernel.bands[number];
    const bool offset =
        settings_.dipoleGeometry == DipoleGeometry::Offset && !target.plan.profile->poles[0].empty();
    const bool painted = target.mesh.paint.has_value();
    std::vector<std::string> defines;
    if (offset) defines.push_back("OFFSET");
    if (painted) defines.push_back("PAINTED");
    const gl::Program* program =
        context_.program(splats() ? "subsurface/splat" : "subsurface/gather", defines);
    Places& places = places_[std::size_t(part.scale)];
    // Of the largest splat, places along a side.
    const double bluntest = painted ? std::max(part.bluntest, scene::kLeastSharpness) : 1;
    const double widest = 2 * band.reach / (bluntest * pixelOf(target) * places.side) + 2;
    const int square = 1 << std::clamp(int(std::ceil(std::log2(widest / kBalls))), 0, kMostScale);
    TextureId balls;
    if (splats()) {
        Result<TextureId> found = ballsOf(places, square);
        if (!found) return found.error();
        balls = *found;
    }
    const int last = std::min(int(number) + coarser, int(points.size()) - 1);
    const int first = std::min(int(number), last);
    const graph::Texture& table = target.plan.profile->tables[number];
    const TextureId tableId = graph_.import(table.handle(), table.desc(), table.label());
    graph_.addPass("subsurface.splat", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(
            "what leaves object \"" + target.mesh.object->name + "\" within " + std::to_string(band.reach) +
            " m of points " + std::to_string(band.spacing) + " m apart" +
            (painted ? "; where M_d is painted up to " + std::to_string(part.sharpest) + ", over M_d" : ""));
        for (int i = first; i <= last; ++i) {
            const Level& level = points[std::size_t(i)];
            for (const TextureId id : {level.place, level.flux, level.normal})
                pass.sample(id);
            if (painted) pass.sample(level.sharpness);
        }
        pass.sample(places.place);
        if (balls) pass.sample(balls);
        pass.sample(tableId);
        pass.write(places.light);
        SplatBlock block = blockOf(target, band);
        block.view = views::viewBlock(in_.eye, in_.size);
        // A place stands for a square of pixels.
        const auto side = float(places.side);
        block.view.right = vec4(side * vec3(block.view.right), block.view.right.w);
        block.view.up = vec4(side * vec3(block.view.up), block.view.up.w);
        block.view.size /= side;
        block.view.middle /= side;
        const vec4 pixels = pixelsOf(in_.eye, target.bounds, in_.size) / side;
        block.bounds = vec4(glm::floor(vec2(pixels)), glm::ceil(vec2(pixels.z, pixels.w)));
        block.unit = unit_;
        block.bluntest = part.bluntest;
        block.sharpest = part.sharpest;
        const ivec4 region(ivec2(block.bounds), ivec2(block.bounds.z, block.bounds.w) - ivec2(block.bounds));
        block.side = square;
        block.corners = std::min(widest, double(std::max(region.z, region.w))) <= kMostPoint ? 1 : 6;
        if (region.z <= 0 || region.w <= 0) return [](const graph::Resources&, graph::Commands&) {};
        return [=, splats = splats()](const graph::Resources& resources, graph::Commands& commands) {
            for (int i = first; i <= last; ++i) {
                const Level& level = points[std::size_t(i)];
                const Level& coarser = points[std::size_t(std::min(i + 1, last))];
                SplatBlock one = block;
                one.columns = level.size.x;
                one.isFinest = i == first;
                one.isCoarsest = i == last;
                graph::Draw draw{.program = program,
                                 .blend = graph::Blend::Add,
                                 .textures = {{"uPlace", resources[level.place]},
                                              {"uFlux", resources[level.flux]},
                                              {"uNormal", resources[level.normal]},
                                              {"uCoarser", resources[coarser.normal]},
                                              {"uReceivers", resources[places.place]},
                                              {"uTable", resources[tableId]}}};
                if (painted) draw.textures.push_back({"uSharpness", resources[level.sharpness]});
                const int count = level.size.x * level.size.y;
                if (splats) {
                    draw.vertices = one.corners * count;
                    if (one.corners == 1) draw.topology = graph::Topology::Points;
                    draw.textures.push_back({"uBalls", resources[balls]});
                    draw.block = one;
                    commands.draw(draw);
                    continue;
                }
                draw.region = region;
                const int gathered = std::clamp((count + kParts - 1) / kParts, kLeastGathered, kMostGathered);
                for (one.first = 0; one.first < count; one.first += gathered) {
                    one.count = std::min(gathered, count - one.first);
                    draw.block = one;
                    commands.draw(draw);
                }
            }
        };
    });
    return Done{};
}

Status Splatter::splat(const Target& target, const Points& points, int coarser) {
    const std::vector<Band>& bands = target.plan.profile->kernel.bands;
    for (std::size_t band = 0; band < bands.size(); ++band)
        for (const Part& part : partsOf(target, bands[band]))
            if (Status s = splatPart(target, points, coarser, band, part); !s) return s;
    return Done{};
}

Status Splatter::lit(const Target& target, const views::LampPoint& lamp) {
    if (lamp.color == vec3(0)) return Done{};
    const views::ShadowViews views =
        views::shadowViews(lamp.source, boundsOfAll(in_.casters), target.bounds, target.layout.grid.most);
    for (const views::Eye& face : views.faces) {
        Result<Points> points =
            recordLit(graph_, context_, lamp, face, {target.mesh, target.layout.grid, false, in_.pictureOf},
                      in_.casters);
        if (!points) return points.error();
        if (Status s = splat(target, *points, target.layout.coarser); !s) return s;
    }
    return Done{};
}

Status Splatter::onLayers(const Target& target, const LitBody& body) {
    const Layout layout = target.layout.alongAxes();
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const LitLayer& layer : body.layers[axis]) {
            Result<Points> points =
                recordLayer(graph_, context_, target.plan.axes[axis], {target.mesh, layout.grid}, layer);
            if (!points) return points.error();
            if (Status s = splat(target, *points, layout.coarser); !s) return s;
        }
    return Done{};
}

// Carries what stands on few places over to twice as many a side.
Status Splatter::spread(std::size_t from) {
    const gl::Program* program = context_.program("subsurface/spread");
    const Places few = places_[from], many = places_[from - 1];
    const views::ViewBlock view = views::viewBlock(in_.eye, in_.size);
    const SpreadBlock block{.side = many.side,
                            .width = std::max(glm::length(vec3(view.right)), glm::length(vec3(view.up))),
                            .perspective = in_.eye.perspective,
                            .eye = vec4(in_.eye.position, 0),
                            .forward = vec4(in_.eye.forward, 0)};
    graph_.addPass("subsurface.spread", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("what left at one place for " + std::to_string(few.side) + " x " +
                    std::to_string(few.side) + " pixels, smooth between them");
        for (const TextureId id : {few.place, few.light, many.place})
            pass.sample(id);
        pass.write(many.light);
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program,
                           .blend = graph::Blend::Add,
                           .block = block,
                           .textures = {{"uCoarse", resources[few.place]},
                                        {"uFine", resources[many.place]},
                                        {"uRadiosity", resources[few.light]}}});
        };
    });
    return Done{};
}

// W/m² that may enter.
float Splatter::brightest() const {
    float most = 0;
    for (const views::LampPoint& sample : entering_.samples())
        for (const views::DrawnMesh& mesh : in_.solids) {
            const views::Bounds bounds = views::boundsOf(*mesh.object);
            const vec3 nearest = glm::clamp(vec3(sample.place), bounds.low, bounds.high);
            const float away = std::max(glm::distance(vec3(sample.place), nearest), 0.1f * bounds.radius());
            most +=
                std::max({sample.color.r, sample.color.g, sample.color.b}) / (sample.fades ? away * away : 1);
        }
    return most;
}

Result<Radiosity> Splatter::record() {
    // 16-bit floats then hold a millionth of the brightest light.
    if (const float most = splats() ? 0 : brightest(); most > 0) unit_ = most / 256;
    std::vector<Target> targets;
    for (const Plan::State::Object& object : plan_.objects)
        for (const views::DrawnMesh& mesh : in_.solids)
            if (mesh.index == object.index)
                targets.push_back(
                    {object, mesh, views::boundsOf(*mesh.object),
                     layoutOf(*object.profile, mesh, settings_, context_.caps().maxTextureSize)});
    int scales = 0;
    for (const Target& target : targets)
        for (const Band& band : target.plan.profile->kernel.bands)
            for (const Part& part : partsOf(target, band))
                scales = std::max(scales, part.scale);
    for (int scale = 0; scale <= scales; ++scale)
        if (Status s = recordPlaces(scale); !s) return s.error();
    for (const Target& target : targets) {
        if (const LitBody* body = entering_.of(target.plan.index)) {
            if (Status s = onLayers(target, *body); !s) return s.error();
            continue;
        }
        for (const views::LampPoint& lamp : entering_.samples())
            if (Status s = lit(target, lamp); !s) return s.error();
    }
    for (std::size_t scale = places_.size() - 1; scale > 0; --scale)
        if (Status s = spread(scale); !s) return s.error();
    return Radiosity{places_.front().light, unit_, places_.front().place};
}

} // namespace

Layout Layout::alongAxes() const {
    Layout layout = *this;
    layout.grid.pixel *= float(1 << refined);
    layout.grid.most >>= refined;
    layout.grid.levels = std::max(1, layout.grid.levels - refined);
    layout.coarser -= refined;
    layout.refined = 0;
    return layout;
}

Layout layoutOf(const Profiled& profile, const views::DrawnMesh& mesh, const Settings& settings,
                int maxTextureSize) {
    const Kernel& kernel = profile.kernel;
    const bool bound = settings.splats == Splats::Bound;
    const int bands = int(kernel.bands.size()), refined = bound ? kRefined : 0;
    Layout layout{.grid = {.pixel = float(kernel.bands.front().spacing) * (bound ? kTilt : 1),
                           .levels = bands + refined,
                           .most = std::min(settings.mostSplats << refined, maxTextureSize),
                           .spare = bound ? kSpare : 1},
                  .coarser = refined,
                  .refined = refined};
    Grid& grid = layout.grid;
    grid.pixel /= float(1 << refined);
    if (!mesh.paint) return layout;
    Sharpness& sharpness = grid.sharpness;
    sharpness.paper = settings.blurEnergy == BlurEnergy::Paper;
    if (!bound) return layout;
    sharpness.most = std::max(1.0f, float(kernel.sharpest));
    if (kernel.sharpest < 1) {
        sharpness.spread = float(kernel.spread);
        sharpness.blur = kHalfOfGaussian * float(kernel.blur);
    }
    // By octaves: a stroke in progress seldom changes them.
    const float sharpest = std::min(std::exp2(float(octaveOf(mesh.paint->sharpest))), sharpness.most);
    const float bluntest = std::exp2(float(octaveOf(mesh.paint->bluntest)));
    grid.pixel /= std::max(1.0f, sharpest);
    layout.coarser += int(std::log2(std::max(1.0f, sharpest) / std::min(1.0f, bluntest)));
    // What lies between points of the coarsest level is the object's shape.
    const float widest = kTilt * 2 * views::boundsOf(*mesh.object).radius() / float(kLeastPoints);
    grid.levels = std::max(grid.levels + int(std::ceil(std::log2(std::max(1.0f, sharpest)))),
                           std::min(bands + layout.coarser, int(std::log2(widest / grid.pixel)) + 1));
    return layout;
}

Result<Radiosity> recordRadiosity(graph::FrameGraph& graph, gl::Context& context, const Inputs& in,
                                  const Plan::State& plan, const Entering& entering,
                                  const Settings& settings) {
    return Splatter(graph, context, in, plan, entering, settings).record();
}

} // namespace lucent::subsurface
