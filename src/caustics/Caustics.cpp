#include "caustics/Caustics.h"

#include "caustics/Blocks.h"
#include "views/Glass.h"
#include "views/Surface.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace lucent::caustics {

using graph::Format;
using graph::TextureDesc;
using graph::TextureId;

namespace {

// Pixels of a light's view of what bends its light, a side: a few for each ray, because not every ray's cell
// is full and because surfaces stand in these pixels. Their number for a ray is odd: it runs through the
// middle one.
ivec2 viewSizeOf(int grid) {
    constexpr int kLeast = 384;
    const int pixels = std::max(3, (kLeast + grid - 1) / grid);
    return ivec2(grid * (pixels | 1));
}

constexpr std::string_view kIntersects[] = {"hybrid", "fixed-point", "newton", "secant"};
constexpr std::string_view kDeposits[] = {"beam", "splat"};

const scene::Object& objectOf(const views::DrawnMesh& mesh) { return *mesh.object; }
const scene::Object& objectOf(const views::PosedMesh& mesh) { return *mesh.drawn.object; }

template <class Mesh>
views::Bounds boundsOfAll(const std::vector<Mesh>& meshes) {
    views::Bounds all;
    for (const Mesh& mesh : meshes) {
        const views::Bounds one = views::boundsOf(objectOf(mesh));
        all.add(one.low);
        all.add(one.high);
    }
    return all;
}

template <class Mesh>
std::vector<Mesh> receiversOf(std::vector<Mesh> solids) {
    std::erase_if(solids, [](const Mesh& mesh) { return objectOf(mesh).material.isMirror(); });
    return solids;
}

template <class Mesh>
std::vector<Mesh> mirrorsOf(std::vector<Mesh> solids) {
    std::erase_if(solids, [](const Mesh& mesh) { return !objectOf(mesh).material.isMirror(); });
    return solids;
}

// A point of a light that looks at meshes no wider than their vertices ask for: their box may be too wide for
// one view where they are not. Moving ones are looked at by their box.
views::ShadowSource aimedAt(views::ShadowSource source, const std::vector<views::DrawnMesh>& meshes,
                            const views::Bounds& bounds) {
    const vec3 place(source.place), towards = bounds.center() - place;
    if (source.place.w == 0 || glm::length(towards) == 0) return source;
    const vec3 axis = glm::normalize(towards);
    float tangent = 0;
    for (const views::DrawnMesh& mesh : meshes) {
        if (scene::moves(*mesh.object)) return source;
        const mat4 worldFromObject = mesh.object->transform.worldFromObject();
        for (const vec3& position : views::meshOf(*mesh.object)->positions) {
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

// Where textures of the passes come from: the graph, or from outside where somebody reads them afterwards.
class Targets {
public:
    explicit Targets(graph::FrameGraph& graph, graph::Device* device = nullptr)
        : graph_(graph), device_(device) {}
    TextureId make(const char* label, const TextureDesc& desc) {
        if (!device_) return graph_.create(label, desc);
        kept_.emplace_back(*device_, desc, label);
        const TextureId id = graph_.import(kept_.back().handle(), desc, label);
        graph_.keep(id);
        return id;
    }
    bool keeps() const { return device_ != nullptr; }
    const std::vector<graph::Texture>& kept() const { return kept_; }

private:
    graph::FrameGraph& graph_;
    graph::Device* device_;
    std::vector<graph::Texture> kept_;
};

// The passes of one light.
class LightPasses {
public:
    LightPasses(graph::FrameGraph& graph, gl::Context& context, Targets& targets, const Inputs& in,
                const Plan::Light& light, const Settings& settings)
        : graph_(graph), context_(context), targets_(targets), in_(in), light_(light), settings_(settings),
          receivers_(receiversOf(in.solids)) {}

    Status record(TextureId& sum);
    float unit() const;

private:
    struct Photons {
        TextureId place, direction, flux, landing, share;
    };
    struct Rays {
        views::Eye eye; // of the light
        Photons photons;
    };
    Result<const gl::Program*> program(const char* stem, std::vector<std::string> defines = {}) {
        return context_.program(stem, defines);
    }
    float splatSize(const views::Eye& glass) const;
    TextureDesc gridDesc() const { return {.size = ivec2(settings_.grid), .format = Format::RGBA32F}; }
    ivec2 viewSize() const { return viewSizeOf(settings_.grid); }
    LampBlock lampBlock() const;
    PhotonBlock photonBlock(const Plan::View& view, int channel) const;
    Result<views::Layers> layersOf(const Plan::View& view, TextureId& solid);
    Status trace(const Plan::View& view, int channel, const views::Layers& layers, TextureId solid,
                 Photons& photons);
    Status tracePass(const Plan::View& view, int channel, const views::Layers& layers, TextureId solid,
                     std::vector<TextureId> targets, const char* why, bool book);
    MirrorBlock mirrorBlock(const views::Eye& eye) const;
    Status reflect(const views::Eye& eye, Photons& photons);
    Status reflectPass(const views::Eye& eye, TextureId surface, std::vector<TextureId> targets,
                       const char* why, bool book);
    std::vector<TextureId> makePhotons(Photons& photons);
    std::vector<TextureId> makeBook();
    Status land(Photons& photons);
    Status share(const views::Eye& eye, Photons& photons);
    Status deposit(const std::vector<Rays>& all);
    Status lookUp(TextureId& sum);

    graph::FrameGraph& graph_;
    gl::Context& context_;
    Targets& targets_;
    const Inputs& in_;
    const Plan::Light& light_;
    const Settings& settings_;
    std::vector<views::PosedMesh> receivers_;
    TextureId depths_, map_;
};

// Flux on a texel of the map that the light meets undisturbed: a number that 16-bit floats hold well.
float LightPasses::unit() const {
    const views::Eye& face = light_.receivers.faces.front();
    const vec2 texel = 2.0f * face.halfExtent / float(light_.receivers.size);
    const vec3 color = light_.lamp.color;
    return texel.x * texel.y * std::max({color.r, color.g, color.b});
}

// A splat covers three rays of a light that nothing bends, and at least three texels.
float LightPasses::splatSize(const views::Eye& glass) const {
    const views::Eye& face = light_.receivers.faces.front();
    const float ray = glass.halfExtent.x / float(settings_.grid);
    const float texel = face.halfExtent.x / float(light_.receivers.size);
    return std::clamp(3 * ray / texel, 3.0f, context_.caps().maxPointSize);
}

LampBlock LightPasses::lampBlock() const {
    return {.color = vec4(light_.lamp.color, light_.lamp.exponent),
            .axis = vec4(light_.lamp.axis, light_.lamp.fades),
            .cone = light_.lamp.cone,
            .grid = vec2(float(settings_.grid))};
}

PhotonBlock LightPasses::photonBlock(const Plan::View& view, int channel) const {
    PhotonBlock block{.view = views::viewBlock(view.eye, viewSize()),
                      .lamp = lampBlock(),
                      .glass = {},
                      .count = view.layers,
                      .channel = channel};
    for (std::size_t i = 0; i < in_.glass.size(); ++i)
        block.glass[i] = views::glassBlock(in_.glass[i].drawn.object->material);
    return block;
}

MirrorBlock LightPasses::mirrorBlock(const views::Eye& eye) const {
    MirrorBlock block{.view = views::viewBlock(eye, viewSize()), .lamp = lampBlock()};
    for (const views::PosedMesh& mesh : mirrorsOf(in_.solids))
        block.mirrors[std::size_t(block.count++)] =
            vec4(objectOf(mesh).material.reflectance, float(mesh.drawn.index));
    return block;
}

Result<views::Layers> LightPasses::layersOf(const Plan::View& view, TextureId& solid) {
    const ivec2 size = viewSize();
    if (!in_.solids.empty()) {
        const TextureDesc desc{.size = size, .format = Format::RGBA32F};
        const TextureId surface = graph_.create("caustics.surface", desc);
        solid = graph_.create("caustics.solid", desc);
        Status s = views::recordSurface(graph_, context_, view.eye, {}, in_.solids, surface, size);
        if (s) s = views::recordSolid(graph_, context_, view.eye, {}, in_.solids, surface, solid, size);
        if (!s) return s.error();
    }
    return views::recordLayers(graph_, context_, view.eye, in_.glass, size, view.layers, solid);
}

Status LightPasses::tracePass(const Plan::View& view, int channel, const views::Layers& layers,
                              TextureId solid, std::vector<TextureId> targets, const char* why, bool book) {
    std::vector<std::string> defines;
    if (solid) defines.push_back("USE_SOLID");
    if (book) defines.push_back("WITH_BOOK");
    Result<const gl::Program*> traced = program("caustics/photon", defines);
    if (!traced) return traced.error();
    graph_.addPass("caustics.photon", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(why);
        views::sampleLayers(pass, layers);
        if (solid) pass.sample(solid);
        for (const TextureId target : targets)
            pass.write(target);
        return [=, program = *traced, block = photonBlock(view, channel)](const graph::Resources& resources,
                                                                          graph::Commands& commands) {
            auto textures = views::layerBindings(resources, layers);
            if (solid) textures.push_back({"uSolid", resources[solid]});
            commands.draw({.program = program, .block = block, .textures = std::move(textures)});
        };
    });
    return Done{};
}

std::vector<TextureId> LightPasses::makePhotons(Photons& photons) {
    photons.place = targets_.make("caustics.place", gridDesc());
    photons.direction = targets_.make("caustics.direction", gridDesc());
    photons.flux = targets_.make("caustics.flux", gridDesc());
    return {photons.place, photons.direction, photons.flux};
}

std::vector<TextureId> LightPasses::makeBook() {
    return {targets_.make("caustics.met", gridDesc()), targets_.make("caustics.absorbed", gridDesc()),
            targets_.make("caustics.reflected", gridDesc()), targets_.make("caustics.lost", gridDesc())};
}

Status LightPasses::trace(const Plan::View& view, int channel, const views::Layers& layers, TextureId solid,
                          Photons& photons) {
    if (Status s = tracePass(view, channel, layers, solid, makePhotons(photons),
                             "rays of one point of a light through refractive objects", false);
        !s)
        return s;
    if (!targets_.keeps()) return Done{};
    return tracePass(view, channel, layers, solid, makeBook(), "where their light stays", true);
}

Status LightPasses::reflectPass(const views::Eye& eye, TextureId surface, std::vector<TextureId> targets,
                                const char* why, bool book) {
    Result<const gl::Program*> reflecting =
        program("caustics/mirror", book ? std::vector<std::string>{"WITH_BOOK"} : std::vector<std::string>{});
    if (!reflecting) return reflecting.error();
    graph_.addPass("caustics.mirror", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(why);
        pass.sample(surface);
        for (const TextureId target : targets)
            pass.write(target);
        return [=, program = *reflecting, block = mirrorBlock(eye)](const graph::Resources& resources,
                                                                    graph::Commands& commands) {
            commands.draw(
                {.program = program, .block = block, .textures = {{"uSurface", resources[surface]}}});
        };
    });
    return Done{};
}

Status LightPasses::reflect(const views::Eye& eye, Photons& photons) {
    std::vector<views::PosedMesh> everything = in_.solids; // what refracts hides mirrors too
    everything.insert(everything.end(), in_.glass.begin(), in_.glass.end());
    const TextureId surface =
        graph_.create("caustics.surface", {.size = viewSize(), .format = Format::RGBA32F});
    if (Status s = views::recordSurface(graph_, context_, eye, {}, everything, surface, viewSize()); !s)
        return s;
    if (Status s = reflectPass(eye, surface, makePhotons(photons), "rays of one point of a light off mirrors",
                               false);
        !s)
        return s;
    if (!targets_.keeps()) return Done{};
    return reflectPass(eye, surface, makeBook(), "where their light stays", true);
}

Status LightPasses::land(Photons& photons) {
    static const char* const kVariants[] = {nullptr, "FIXED_POINT", "NEWTON", "SECANT"};
    const char* variant = kVariants[std::size_t(settings_.intersect)];
    Result<const gl::Program*> landing =
        program("caustics/land", variant ? std::vector<std::string>{variant} : std::vector<std::string>{});
    if (!landing) return landing.error();
    const views::Bounds box = boundsOfAll(receivers_);
    const float margin = 1e-3f * box.radius();
    photons.landing = targets_.make("caustics.landing", gridDesc());
    const TextureId effort =
        targets_.make("caustics.effort", {.size = ivec2(settings_.grid), .format = Format::RG32F});
    graph_.addPass("caustics.land", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("where these rays meet receivers, by " +
                    std::string(kIntersects[std::size_t(settings_.intersect)]));
        pass.sample(photons.place);
        pass.sample(photons.direction);
        pass.sample(depths_);
        pass.write(photons.landing);
        pass.write(effort);
        const LandBlock block{.faces = Faces(light_.receivers),
                              .low = vec4(box.low - margin, 0),
                              .high = vec4(box.high + margin, 0),
                              .faceCount = int(light_.receivers.faces.size()),
                              .steps = settings_.steps};
        return [=, program = *landing, depths = depths_](const graph::Resources& resources,
                                                         graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = block,
                           .textures = {{"uPlace", resources[photons.place]},
                                        {"uDirection", resources[photons.direction]},
                                        {"uShadow", resources[depths]}}});
        };
    });
    return Done{};
}

Status LightPasses::share(const views::Eye& eye, Photons& photons) {
    Result<const gl::Program*> sharing = program("caustics/share");
    if (!sharing) return sharing.error();
    graph_.addPass("caustics.share", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("what each ray gives to the triangles between rays");
        pass.sample(photons.place);
        pass.sample(photons.flux);
        pass.sample(photons.landing);
        photons.share = pass.createColor("caustics.share", gridDesc());
        const ShareBlock block{views::viewBlock(eye, viewSize()), vec2(float(settings_.grid))};
        return [photons, block, program = *sharing](const graph::Resources& resources,
                                                    graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = block,
                           .textures = {{"uPlace", resources[photons.place]},
                                        {"uFlux", resources[photons.flux]},
                                        {"uLanding", resources[photons.landing]}}});
        };
    });
    return Done{};
}

Status LightPasses::deposit(const std::vector<Rays>& all) {
    const bool beams = settings_.deposit == Deposit::Beam;
    Result<const gl::Program*> triangles = program("caustics/beam");
    if (!triangles) return triangles.error();
    Result<const gl::Program*> points = program("caustics/beam", {"AS_POINTS"});
    if (!points) return points.error();
    Result<const gl::Program*> splats =
        program("caustics/splat", beams ? std::vector<std::string>{"LONE"} : std::vector<std::string>{});
    if (!splats) return splats.error();
    const Format format = context_.caps().floatBlend ? Format::RGBA32F : Format::RGBA16F;
    map_ = targets_.make("caustics.map", {.size = light_.receivers.imageSize(), .format = format});
    graph_.addPass("caustics.deposit", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("light on the receivers, by " + std::string(kDeposits[std::size_t(settings_.deposit)]));
        for (const auto& [eye, photons] : all) {
            pass.sample(photons.landing);
            pass.sample(photons.share);
        }
        pass.write(map_);
        pass.clear(map_, vec4(0));
        std::vector<DepositBlock> blocks;
        for (const auto& [eye, photons] : all)
            blocks.push_back({.faces = Faces(light_.receivers),
                              .grid = ivec2(settings_.grid),
                              .faceCount = int(light_.receivers.faces.size()),
                              .face = 0,
                              .unit = unit(),
                              .size = splatSize(eye)});
        return [=, triangles = *triangles, points = *points, splats = *splats, views = light_.receivers,
                grid = settings_.grid](const graph::Resources& resources, graph::Commands& commands) {
            const int squares = (grid - 1) * (grid - 1);
            for (int face = 0; face < int(views.faces.size()); ++face)
                for (std::size_t i = 0; i < all.size(); ++i) {
                    DepositBlock block = blocks[i];
                    block.face = face;
                    graph::Draw draw{.region = ivec4(views.corner(face), views.size, views.size),
                                     .blend = graph::Blend::Add,
                                     .block = block,
                                     .textures = {{"uLanding", resources[all[i].photons.landing]},
                                                  {"uShare", resources[all[i].photons.share]}}};
                    const auto add = [&](const gl::Program* program, int vertices, graph::Topology topology) {
                        draw.program = program;
                        draw.vertices = vertices;
                        draw.topology = topology;
                        commands.draw(draw);
                    };
                    if (beams) {
                        add(triangles, 6 * squares, graph::Topology::Triangles);
                        add(points, 2 * squares, graph::Topology::Points);
                    }
                    add(splats, grid * grid, graph::Topology::Points);
                }
        };
    });
    return Done{};
}

Status LightPasses::lookUp(TextureId& sum) {
    Result<const gl::Program*> looking =
        program("caustics/lookup", sum ? std::vector<std::string>{"USE_BEFORE"} : std::vector<std::string>{});
    if (!looking) return looking.error();
    const TextureId before = sum;
    graph_.addPass("caustics.lookup", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("irradiance that one point of a light throws on each pixel by way of glass");
        pass.sample(in_.surface);
        pass.sample(map_);
        pass.sample(depths_);
        if (before) pass.sample(before);
        sum = pass.createColor("caustics.irradiance", {.size = in_.size, .format = Format::RGBA32F});
        const LookupBlock block{.view = views::viewBlock(in_.eye, in_.size),
                                .faces = Faces(light_.receivers),
                                .faceCount = int(light_.receivers.faces.size()),
                                .unit = unit()};
        return [=, program = *looking, surface = in_.surface, map = map_,
                depths = depths_](const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> textures{
                {"uSurface", resources[surface]}, {"uMap", resources[map]}, {"uShadow", resources[depths]}};
            if (before) textures.push_back({"uBefore", resources[before]});
            commands.draw({.program = program, .block = block, .textures = std::move(textures)});
        };
    });
    return Done{};
}

Status LightPasses::record(TextureId& sum) {
    Result<TextureId> depths =
        views::recordShadow(graph_, context_, light_.receivers, receivers_, boundsOfAll(receivers_));
    if (!depths) return depths.error();
    depths_ = *depths;
    const bool disperses = views::disperses(in_.glass);
    std::vector<Rays> all;
    const auto carry = [&](const views::Eye& eye, Photons photons) -> Status {
        if (Status s = land(photons); !s) return s;
        if (Status s = share(eye, photons); !s) return s;
        all.push_back({eye, photons});
        return Done{};
    };
    for (const Plan::View& view : light_.glass) {
        TextureId solid;
        Result<views::Layers> layers = layersOf(view, solid);
        if (!layers) return layers.error();
        for (int channel = disperses ? 0 : 3; channel < (disperses ? 3 : 4); ++channel) {
            Photons photons;
            if (Status s = trace(view, channel, *layers, solid, photons); !s) return s;
            if (Status s = carry(view.eye, photons); !s) return s;
        }
    }
    for (const views::Eye& eye : light_.mirrors) {
        Photons photons;
        if (Status s = reflect(eye, photons); !s) return s;
        if (Status s = carry(eye, photons); !s) return s;
    }
    if (Status s = deposit(all); !s) return s;
    if (targets_.keeps()) return Done{};
    return lookUp(sum);
}

} // namespace

const ParamTable& Caustics::params() {
    static const Param list[] = {
        declare(&Settings::intersect,
                {.id = "intersect",
                 .label = "Intersection",
                 .group = Group::Light,
                 .doc =
                     "How the place is found where light meets a receiver: within a bracket that secants or "
                     "halving shrink; by the dissertation's fixed point; by Newton's method; by secants.",
                 .choices = kIntersects}),
        declare(&Settings::deposit,
                {.id = "deposit",
                 .label = "Deposit",
                 .group = Group::Light,
                 .doc = "What light leaves on receivers: the triangles between rays, with flux over area; or "
                        "the dissertation's Gaussian points.",
                 .choices = kDeposits}),
        declare(&Settings::grid, {.id = "grid",
                                  .label = "Rays of a light",
                                  .min = 2,
                                  .max = 1024,
                                  .low = 32,
                                  .high = 512,
                                  .logarithmic = true,
                                  .group = Group::Light,
                                  .doc = "Rays along a side of what a light sees of refractive objects and "
                                         "mirrors."}),
        declare(&Settings::mapSize, {.id = "mapSize",
                                     .label = "Caustic map",
                                     .unit = "texels",
                                     .min = 16,
                                     .max = 4096,
                                     .low = 128,
                                     .high = 2048,
                                     .logarithmic = true,
                                     .group = Group::Light,
                                     .doc = "Texels along a side of the image in which light adds up."}),
        declare(&Settings::steps, {.id = "steps",
                                   .label = "Steps",
                                   .min = 1,
                                   .max = 256,
                                   .low = 1,
                                   .high = 64,
                                   .logarithmic = true,
                                   .group = Group::Light,
                                   .doc = "Looks at the receivers' image, at most, to find where a ray meets "
                                          "them."}),
        declare(&Settings::lightSamples,
                {.id = "lightSamples",
                 .label = "Points of a lamp in caustics",
                 .min = 1,
                 .max = 256,
                 .low = 1,
                 .high = 64,
                 .logarithmic = true,
                 .group = Group::Light,
                 .doc = "How many points stand for a lamp that has a size, each with "
                        "its own views."}),
    };
    static const ParamTable table = tableOf<Settings>("caustics", list);
    return table;
}

std::optional<std::string> Caustics::need(const scene::Scene& scene) {
    const auto find = [&](auto wanted) -> const scene::Object* {
        const auto found = std::find_if(scene.objects.begin(), scene.objects.end(), [&](const auto& one) {
            return !one.isField() && wanted(one.material);
        });
        return found == scene.objects.end() ? nullptr : &*found;
    };
    const scene::Object* bends =
        find([](const scene::Material& m) { return m.isRefractive() || m.isMirror(); });
    const scene::Object* receives =
        find([](const scene::Material& m) { return !m.isRefractive() && !m.isMirror(); });
    if (scene.lights.empty() || !bends || !receives) return std::nullopt;
    return "object \"" + bends->name + "\" throws the lamps' light on \"" + receives->name + "\"";
}

Result<Plan> Caustics::plan(graph::TexturePool& pool, const scene::Scene& scene, const views::Eye& eye,
                            const views::DrawnMeshes& meshes, const Settings& settings) const {
    Plan plan;
    const views::Bounds glass = boundsOfAll(meshes.glass), mirrors = boundsOfAll(mirrorsOf(meshes.solid));
    std::vector<views::DrawnMesh> all = meshes.solid; // what stands before glass and mirrors hides them
    all.insert(all.end(), meshes.glass.begin(), meshes.glass.end());
    const views::Bounds everything = boundsOfAll(all);
    const views::Bounds receivers = views::seenBy(eye, boundsOfAll(receiversOf(meshes.solid)));
    for (const views::LampPoint& lamp : views::lampPoints(scene, settings.lightSamples)) {
        if (lamp.color == vec3(0)) continue;
        views::ShadowSource around = lamp.source; // light leaves the cone of a spot where it is bent
        around.tangent = views::ShadowSource().tangent;
        Plan::Light light{lamp, {}, {}, views::shadowViews(around, receivers, receivers, settings.mapSize)};
        if (light.receivers.faces.empty()) continue;
        const int size = viewSizeOf(settings.grid).x;
        for (const views::Eye& face :
             views::shadowViews(aimedAt(lamp.source, meshes.glass, glass), everything, glass, size).faces) {
            Result<int> count =
                views::countLayers(pool, context_, face, meshes.glass, scene.view.time, ivec2(size));
            if (!count) return count.error();
            if (*count > 0) light.glass.push_back({face, *count});
        }
        light.mirrors = views::shadowViews(aimedAt(lamp.source, mirrorsOf(meshes.solid), mirrors), everything,
                                           mirrors, size)
                            .faces;
        if (!light.glass.empty() || !light.mirrors.empty()) plan.lights.push_back(std::move(light));
    }
    return plan;
}

Result<TextureId> Caustics::record(graph::FrameGraph& graph, const Inputs& in, const Plan& plan,
                                   const Settings& settings) const {
    if (in.glass.size() > views::kMostGlass)
        return Error{"caustics: " + std::to_string(in.glass.size()) +
                         " refractive objects; must be at most " + std::to_string(views::kMostGlass),
                     Fault::Machine};
    if (const std::size_t count = mirrorsOf(in.solids).size(); count > MirrorBlock::kMost)
        return Error{"caustics: " + std::to_string(count) + " mirrors; must be at most " +
                         std::to_string(MirrorBlock::kMost),
                     Fault::Machine};
    if (const int side = viewSizeOf(settings.grid).x; side > context_.caps().maxTextureSize)
        return Error{"caustics: grid is " + std::to_string(settings.grid) + ", for which a lamp's view has " +
                         std::to_string(side) + " pixels a side; must be at most " +
                         std::to_string(context_.caps().maxTextureSize) + " on this GPU",
                     Fault::Machine};
    TextureId sum;
    Targets targets(graph);
    for (const Plan::Light& light : plan.lights)
        if (Status s = LightPasses(graph, context_, targets, in, light, settings).record(sum); !s)
            return s.error();
    return sum;
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
                                 const views::DrawnMeshes& meshes, const Plan& plan,
                                 const Settings& settings) const {
    Energy energy;
    double rays = 0;
    for (const Plan::Light& light : plan.lights) {
        graph::FrameGraph graph;
        Result<std::vector<views::PosedMesh>> glass =
            views::recordPose(graph, context_, meshes.glass, scene.view.time);
        if (!glass) return glass.error();
        Result<std::vector<views::PosedMesh>> solids =
            views::recordPose(graph, context_, meshes.solid, scene.view.time);
        if (!solids) return solids.error();
        const Inputs in{scene, eye, *glass, *solids, {}, {}};
        Targets targets(graph, &context_.device());
        TextureId none;
        LightPasses passes(graph, context_, targets, in, light, settings);
        if (Status s = passes.record(none); !s) return s.error();
        if (Status s = graph.compile(); !s) return s.error();
        graph.execute(pool);
        Ledger ledger(context_.device(), targets);
        energy.met += ledger.sum("caustics.met");
        energy.absorbed += ledger.sum("caustics.absorbed");
        energy.reflected += ledger.sum("caustics.reflected");
        energy.lost += ledger.sum("caustics.lost");
        energy.received += double(passes.unit()) * ledger.sum("caustics.map");
        const std::vector<Image> flux = ledger.all("caustics.flux"), landing = ledger.all("caustics.landing"),
                                 effort = ledger.all("caustics.effort");
        for (std::size_t image = 0; image < flux.size(); ++image)
            for (std::size_t i = 0; i < flux[image].pixels.size(); i += 4) {
                const float* f = &flux[image].pixels[i];
                const bool landed = landing[image].pixels[i + 3] > 0;
                const bool isAstray = std::abs(effort[image].pixels[i + 1]) > 2;
                if (!landed) energy.missed += dvec3(f[0], f[1], f[2]);
                if (landed && isAstray) energy.astray += dvec3(f[0], f[1], f[2]);
                energy.looks += double(effort[image].pixels[i]);
                rays += f[3];
            }
    }
    if (std::string error = context_.takeError(); !error.empty()) return Error{error, Fault::Machine};
    if (rays > 0) energy.looks /= rays;
    return energy;
}

} // namespace lucent::caustics
