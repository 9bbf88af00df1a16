#include "frame/Renderer.h"

#include "frame/Budget.h"
#include "frame/Compose.h"
#include "graph/FrameGraph.h"
#include "relief/Relief.h"
#include "relief/Transfers.h"
#include "views/Surface.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>

namespace lucent::frame {

using graph::Format;
using graph::TextureDesc;
using scene::Aov;

namespace {

struct DisplayBlock {
    vec4 scale{1}, shift{0};
    int isScalar = 0, encode = 0;
    int padding[2] = {};

    static const graph::BlockLayout& layout() {
        static const graph::BlockLayout::Member members[] = {{"scale", offsetof(DisplayBlock, scale)},
                                                             {"shift", offsetof(DisplayBlock, shift)},
                                                             {"isScalar", offsetof(DisplayBlock, isScalar)},
                                                             {"encode", offsetof(DisplayBlock, encode)}};
        static const graph::BlockLayout layout{"DisplayBlock", sizeof(DisplayBlock), members};
        return layout;
    }
};

struct BesideBlock {
    vec4 scale{1}, shift{0};
    vec2 corner{0};
    float pixelsPerTexel = 1, divider = 0, full = 1;
    int encode = 0, right = 0;
    int padding = 0;

    static const graph::BlockLayout& layout() {
        static const graph::BlockLayout::Member members[] = {
            {"scale", offsetof(BesideBlock, scale)},
            {"shift", offsetof(BesideBlock, shift)},
            {"corner", offsetof(BesideBlock, corner)},
            {"pixelsPerTexel", offsetof(BesideBlock, pixelsPerTexel)},
            {"divider", offsetof(BesideBlock, divider)},
            {"full", offsetof(BesideBlock, full)},
            {"encode", offsetof(BesideBlock, encode)},
            {"right", offsetof(BesideBlock, right)}};
        static const graph::BlockLayout layout{"BesideBlock", sizeof(BesideBlock), members};
        return layout;
    }
};

bool hasEnvironment(const scene::Scene& scene) { return scene.environment && scene.environment->enabled; }

// Light itself, which may be found in several ways, not how one of them finds it.
bool showsLight(const scene::Scene& scene) {
    return scene.view.show == Aov::Color || scene.view.show == Aov::Illumination;
}

// Whether the scene wants an error kept that settings could miss.
bool limited(const scene::Scene& scene) {
    return scene.quality.maxError > 0 && showsLight(scene) && Budget::matters(scene);
}

// Only an eye that looks straight down on every field sees no side wall.
bool seesWalls(const scene::Scene& scene) {
    if (scene.camera.type == scene::Camera::Type::Perspective) return true;
    const vec3 forward = glm::normalize(scene.camera.target - scene.camera.eye);
    return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const scene::Object& object) {
        const vec3 down = rotationFromDegrees(object.transform.rotate) * vec3(0, 0, -1);
        return object.visible && object.isField() && glm::length(forward - down) > 1e-6f;
    });
}

bool isGeometric(Aov aov) { return aov == Aov::Normal || aov == Aov::Depth || aov == Aov::Position; }

// How a quantity is shown as a picture. Light is exposed and encoded; the rest is brought into [0, 1].
DisplayBlock displayOf(const scene::Scene& scene, const views::Eye& eye) {
    DisplayBlock block;
    switch (scene.view.show) {
    case Aov::Color:
    case Aov::Irradiance:
        block.scale = vec4(std::exp2(scene.view.exposure));
        block.encode = 1;
        break;
    case Aov::Illumination:
    case Aov::Visibility:
        block.isScalar = 1;
        block.encode = 1;
        break;
    case Aov::Iterations: // white at 128 steps
        block.isScalar = 1;
        block.scale = vec4(1.0f / 128);
        break;
    case Aov::Layers: // white at 16 interfaces
        block.scale = vec4(1.0f / 16);
        break;
    case Aov::Normal:
    case Aov::Direction:
        block.scale = vec4(0.5f);
        block.shift = vec4(0.5f);
        break;
    case Aov::Depth:
    case Aov::Position: { // over the objects' extent: nearest or lowest black, farthest or highest white
        views::Bounds bounds;
        for (const scene::Object& object : scene.objects) {
            const views::Bounds one = views::boundsOf(object);
            bounds.add(one.low);
            bounds.add(one.high);
        }
        vec3 low = bounds.low, high = bounds.high;
        if (scene.view.show == Aov::Depth) {
            const float middle = glm::dot(bounds.center() - eye.position, eye.forward);
            low = vec3(middle - bounds.radius());
            high = vec3(middle + bounds.radius());
        }
        const vec3 extent = glm::max(high - low, vec3(1e-9f));
        block.scale = vec4(1.0f / extent, 1);
        block.shift = vec4(-low / extent, 0);
        break;
    }
    }
    return block;
}

// What the images of a view depend on.
struct SurfaceKey {
    struct Object {
        std::shared_ptr<const void> shape, mask;
        std::vector<float> numbers;
        mat4 worldFromObject;
        bool visible;
        bool operator==(const Object&) const = default;
    };
    std::vector<Object> objects;
    mat4 clipFromWorld;
    ivec2 size;
    bool showsGlass;      // its surface, not what is behind
    std::uint64_t waters; // Waters::changes()
    bool operator==(const SurfaceKey&) const = default;
};

SurfaceKey::Object keyOf(const scene::Object& object, float time) {
    SurfaceKey::Object key{nullptr, nullptr, {}, object.transform.worldFromObject(), object.visible};
    if (object.isField()) {
        const scene::HeightField& field = object.field();
        key.shape = field.heights;
        key.mask = field.alpha;
        key.numbers = {field.width, field.heightScale};
        return key;
    }
    const std::shared_ptr<const scene::Mesh> mesh = views::meshOf(object);
    const scene::Wave& wave = object.wave;
    const bool waved = wave.amplitude != vec3(0);
    key.shape = mesh;
    key.numbers = {float(object.material.isRefractive()), waved || mesh->moves() ? time : 0};
    if (waved)
        for (float value : {wave.amplitude.x, wave.amplitude.y, wave.amplitude.z, wave.direction.x,
                            wave.direction.y, wave.direction.z, wave.wavelength, wave.period})
            key.numbers.push_back(value);
    return key;
}

SurfaceKey surfaceKey(const scene::Scene& scene, ivec2 size, std::uint64_t waters) {
    SurfaceKey key{{},
                   views::makeEye(scene, float(size.x) / float(size.y)).clipFromWorld,
                   size,
                   isGeometric(scene.view.show),
                   waters};
    for (const scene::Object& object : scene.objects)
        key.objects.push_back(keyOf(object, scene.view.time));
    return key;
}

double now() {
    using namespace std::chrono;
    return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

} // namespace

std::span<const ParamTable* const> techniques() {
    static const ParamTable* const list[] = {&relief::Relief::params(), &brdf::Brdf::params(),
                                             &caustics::Caustics::params(), &refract::Refract::params()};
    return list;
}

std::optional<std::string> need(const scene::Scene& scene, std::string_view technique) {
    if (technique == "relief") return relief::Relief::need(scene);
    if (technique == "brdf") return brdf::Brdf::need(scene);
    if (technique == "caustics") return caustics::Caustics::need(scene);
    if (technique == "refract") return refract::Refract::need(scene);
    return std::nullopt;
}

// A picture is made in stages: first with few directions of the environment, then with more. A stage is
// summed in slices that take about kSliceMs each; the last complete stage is what is shown.
struct Renderer::State {
    static constexpr double kSliceMs = 40;
    static constexpr int kFirstStage = 20; // directions
    static constexpr int kStageFactor = 4;

    struct Stage {
        int directions; // of the environment
        bool transfer;  // they only light walls; the rest comes from the transfers
    };

    enum class Effort { Coarse, Progressive, Final }; // one first look; looks, then all; all at once

    explicit State(gl::Context& gl)
        : context(gl), pool(gl.device()), images(gl), relief(gl), compose(gl, pool, images), transfers(gl),
          budget(gl, pool, images, relief) {}

    gl::Context& context;
    graph::TexturePool pool;
    views::ImageCache images;
    relief::Relief relief;
    Compose compose;
    graph::Texture surface, shownSurface, shown, sum, scratch, lightTable;
    relief::Transfers transfers;
    Budget budget;
    std::optional<Budget::Choice> choice; // the budget's, for the last picture that had one
    graph::Texture truth;                 // beside the picture
    std::uint64_t truthNumber = 0;

    // the picture being made
    std::uint64_t revision = 0;
    ivec2 size{0};
    bool started = false, coarse = false;
    bool dragged = false;
    bool planning = false;                           // the settings are still to be chosen
    relief::Settings settings;                       // that this picture is made with
    bool composed = false;                           // the picture stands in compose.through()
    bool surfaceDrawn = false, surfaceShown = false; // of this picture
    std::optional<SurfaceKey> shownKey;              // what shownSurface was drawn for
    std::vector<Stage> stages;
    std::size_t stage = 0;
    std::vector<relief::LightSource> lights; // of this stage
    int placed = 0;                          // so many of them have a place or a direction of their own
    int next = 0;                            // light
    double msPerLight = 0;
    double workMs = 0, planMs = 0;
    int drawsBefore = 0, passes = 0;
    Stats stats;

    void start(const scene::Scene& scene, std::uint64_t newRevision, ivec2 newSize, Effort effort);
    void chooseSettings(const scene::Scene& scene, Effort effort);
    void addStages(const scene::Scene& scene, Effort effort);
    Status plan(const scene::Scene& scene);
    Result<Progress> advance(const scene::Scene& scene, std::uint64_t newRevision, ivec2 newSize,
                             Effort effort);
    void makeTargets();
    void startStage(const scene::Scene& scene);
    Result<bool> makeTransfers(const std::vector<views::DrawnObject>& objects);
    void lightTransfers(const scene::Scene& scene, const std::vector<views::DrawnObject>& objects);
    Result<bool> prepareTransfers(const scene::Scene& scene, const std::vector<views::DrawnObject>& objects);
    Status slice(const scene::Scene& scene);
    Status recordSlice(graph::FrameGraph& graph, const scene::Scene& scene, const views::Eye& eye,
                       const Drawn& drawn, int end);
    Status recordRelief(graph::FrameGraph& graph, const scene::Scene& scene, const views::Eye& eye,
                        const Drawn& drawn, graph::TextureId surfaceId, graph::TextureId targetId, int end);
    Status addOthers(const scene::Scene& scene, const Drawn& drawn);
    Compose::Inputs composeInputs(const scene::Scene& scene, const views::Eye& eye,
                                  const Drawn& drawn) const {
        return {scene, eye, drawn, shownSurface, shown, coarse || dragged};
    }
    const graph::Texture& picture() const { return composed ? compose.through() : shown; }
    std::string leftOut(const scene::Scene& scene, const Drawn& drawn) const;
    Status runGraph(const std::function<Status(graph::FrameGraph&)>& record);
    Result<Image> display(const scene::Scene& scene, bool linear);
    Status recordDisplay(graph::FrameGraph& graph, const scene::Scene& scene, graph::TextureId target,
                         bool linear);
    Status recordBeside(graph::FrameGraph& graph, const scene::Scene& scene, const Beside& beside,
                        const graph::Texture& linear);
    void takeTruth(const Beside& beside);
    float work(const Stage& of) const;
    float shareOfStage() const;
    bool complete() const { return started && !planning && stage >= stages.size(); }
    int sliceEnd() const;
};

void Renderer::State::start(const scene::Scene& scene, std::uint64_t newRevision, ivec2 newSize,
                            Effort effort) {
    started = true;
    revision = newRevision;
    size = newSize;
    makeTargets();
    surfaceDrawn = surfaceShown =
        shownKey == surfaceKey(scene, newSize, compose.waters().changes()); // light alone may have changed
    stage = 0;
    workMs = planMs = 0;
    drawsBefore = context.device().drawCount();
    passes = 0;
    stages.clear();
    coarse = false;
    chooseSettings(scene, effort);
    if (!planning)
        addStages(scene, effort);
    else if (effort == Effort::Progressive)
        stages.push_back({kFirstStage, false});
    startStage(scene);
}

// The scene's own settings; or, with an error to keep, those the budget chooses: at once where a transfer is
// there already, because then it is the cheapest.
void Renderer::State::chooseSettings(const scene::Scene& scene, Effort effort) {
    settings = scene.technique.at("relief").as<relief::Settings>();
    dragged = effort == Effort::Coarse;
    planning = limited(scene) && !dragged;
    if (!limited(scene)) {
        choice.reset();
        return;
    }
    const relief::Settings own = settings;
    settings.method = relief::Method::Transfer;
    settings.terms = relief::kMostTerms;
    if (planning) budget.start(scene, size);
    if (hasEnvironment(scene) && transfers.ready(scene, settings)) {
        planning = false;
    } else if (effort == Effort::Coarse && choice) {
        settings = choice->settings;
    } else {
        settings = own;
        settings.method = relief::Method::Hierarchy;
    }
}

void Renderer::State::addStages(const scene::Scene& scene, Effort effort) {
    const bool manyLights =
        relief::Relief::need(scene) && hasEnvironment(scene) && !isGeometric(scene.view.show);
    const int wanted = settings.environmentLights;
    const bool transfer = manyLights && settings.method == relief::Method::Transfer && showsLight(scene);
    const bool atOnce = effort == Effort::Final || (transfer && transfers.ready(scene, settings));
    const int summed = transfer ? kFirstStage * kStageFactor : wanted; // while the transfer is made
    for (int count = kFirstStage; manyLights && !atOnce && count * 2 < summed; count *= kStageFactor)
        stages.push_back({count, false});
    if (transfer)
        stages.push_back({seesWalls(scene) ? wanted : 0, true});
    else
        stages.push_back({manyLights ? wanted : 0, false});
    coarse = effort == Effort::Coarse && (stages.size() > 1 || limited(scene) || need(scene, "brdf"));
    if (coarse) stages.resize(1);
}

// Chooses the settings for one slice of time, and goes on with them when they are known.
Status Renderer::State::plan(const scene::Scene& scene) {
    const double before = now();
    while (!budget.done() && now() - before < kSliceMs)
        if (Status stepped = budget.step(scene); !stepped) return stepped;
    workMs += now() - before;
    planMs += now() - before;
    if (!budget.done()) return Done{};
    choice = budget.choice();
    settings = choice->settings;
    planning = false;
    addStages(scene, Effort::Final);
    startStage(scene);
    return Done{};
}

// --- transfers

// Works on the transfers for one slice of time. @return whether all are ready
Result<bool> Renderer::State::makeTransfers(const std::vector<views::DrawnObject>& objects) {
    const double start = now();
    Result<bool> ready = transfers.make(pool, objects, settings, kSliceMs);
    workMs += now() - start;
    return ready;
}

// Brings the scene's environment onto the transfers, with as many terms as the error asks for.
void Renderer::State::lightTransfers(const scene::Scene& scene,
                                     const std::vector<views::DrawnObject>& objects) {
    const views::Eye eye = views::makeEye(scene, float(size.x) / float(size.y));
    transfers.light(scene, eye, objects, settings, Budget::kTransferShare * scene.quality.maxError);
}

// Works until the transfers are there and show this scene's environment, for one slice of time. With an error
// to keep they must keep it on the budget's sample, else the budget goes on without them. @return whether
// they are ready
Result<bool> Renderer::State::prepareTransfers(const scene::Scene& scene,
                                               const std::vector<views::DrawnObject>& objects) {
    const Result<bool> ready = makeTransfers(objects);
    if (!ready || !*ready) return ready;
    const double before = now();
    lightTransfers(scene, objects);
    if (!limited(scene) || dragged) return true;
    const auto record = [this](graph::FrameGraph& graph) { return transfers.record(graph); };
    const Result<float> error = budget.errorOfTransfer(scene, settings, record);
    planMs += now() - before;
    if (!error) return error.error();
    choice = budget.choice();
    choice->settings = settings;
    choice->predicted = *error;
    if (*error <= scene.quality.maxError) return true;
    budget.refuseTransfer();
    planning = true;
    stages.resize(stage);
    return false;
}

// How long a stage takes, in directions.
float Renderer::State::work(const Stage& of) const {
    return float(of.transfer ? 2 * kStageFactor * kStageFactor * kFirstStage : of.directions) + 1;
}

float Renderer::State::shareOfStage() const {
    if (!stages[stage].transfer) return float(next) / float(std::max<std::size_t>(1, lights.size()));
    return transfers.share();
}

// --- one picture

void Renderer::State::makeTargets() {
    const TextureDesc desc{.size = size, .format = Format::RGBA32F};
    if (surface && surface.desc() == desc) return;
    gl::Device& device = context.device();
    shownKey.reset();
    surface = graph::Texture(device, desc, "frame.surface");
    shownSurface = graph::Texture(device, desc, "frame.shownSurface");
    shown = graph::Texture(device, desc, "frame.shown");
    sum = graph::Texture(device, desc, "frame.sum");
    scratch = graph::Texture(); // made when a sum takes more than one slice
}

void Renderer::State::startStage(const scene::Scene& scene) {
    next = 0;
    if (stage >= stages.size()) return;
    lights = relief::Relief::lights(scene, settings, stages[stage].directions);
    placed = int(relief::Relief::lights(scene, settings, 0).size());
    const Image table = relief::Relief::lightTable(lights);
    const TextureDesc desc{.size = table.size(), .format = Format::RGBA32F};
    if (!lightTable || lightTable.desc() != desc)
        lightTable = graph::Texture(context.device(), desc, "relief.lights");
    context.device().upload(lightTable.handle(), 0, table.pixels);
}

int Renderer::State::sliceEnd() const {
    const int count = int(lights.size());
    const double affordable = msPerLight > 0 ? std::max(1.0, kSliceMs / msPerLight) : 1;
    const int end =
        std::min(count, next + int(std::min(affordable, double(relief::Relief::kMostLightsAtOnce))));
    // Every point and distant light belongs to the first look: they are few.
    return next == 0 ? std::min(count, std::max(end, 4)) : end;
}

Status Renderer::State::runGraph(const std::function<Status(graph::FrameGraph&)>& record) {
    graph::FrameGraph graph;
    if (Status recorded = record(graph); !recorded) return recorded;
    if (Status compiled = graph.compile(); !compiled) return compiled;
    graph.execute(pool);
    passes += graph.livePasses();
    if (std::string error = context.takeError(); !error.empty()) return Error{error, Fault::Machine};
    return Done{};
}

Status Renderer::State::recordSlice(graph::FrameGraph& graph, const scene::Scene& scene,
                                    const views::Eye& eye, const Drawn& drawn, int end) {
    const auto import = [&](const graph::Texture& texture) {
        return graph.import(texture.handle(), texture.desc(), texture.label());
    };
    const graph::TextureId surfaceId = import(surfaceShown ? shownSurface : surface);
    const graph::TextureId targetId = import(next > 0 ? scratch : sum);
    graph.keep(targetId);
    std::vector<views::DrawnMesh> meshes = drawn.meshes.solid;
    if (isGeometric(scene.view.show))
        meshes.insert(meshes.end(), drawn.meshes.glass.begin(), drawn.meshes.glass.end());
    Result<std::vector<views::PosedMesh>> solids = views::recordPose(graph, context, meshes, scene.view.time);
    if (!solids) return solids.error();
    if (!surfaceDrawn && !solids->empty()) graph.keep(surfaceId); // read after this graph
    if (!surfaceDrawn)
        if (Status s = views::recordSurface(graph, context, eye, drawn.fields, *solids, surfaceId, size); !s)
            return s;
    if (isGeometric(scene.view.show))
        return views::recordGeometry(graph, context, eye, drawn.fields, *solids, surfaceId, targetId,
                                     scene.view.show, size);
    if (!drawn.fields.empty()) return recordRelief(graph, scene, eye, drawn, surfaceId, targetId, end);
    graph.addPass("frame.clear", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("no height field draws there");
        pass.write(targetId);
        pass.clear(targetId, vec4(0));
        return [](const graph::Resources&, graph::Commands&) {};
    });
    return Done{};
}

Status Renderer::State::recordRelief(graph::FrameGraph& graph, const scene::Scene& scene,
                                     const views::Eye& eye, const Drawn& drawn, graph::TextureId surfaceId,
                                     graph::TextureId targetId, int end) {
    const auto import = [&](const graph::Texture& texture) {
        return graph.import(texture.handle(), texture.desc(), texture.label());
    };
    std::vector<relief::Transferred> transferred;
    if (stages[stage].transfer) {
        transferred.resize(drawn.fields.size()); // slices after the first add light to walls only
        if (next == 0) {
            auto recorded = transfers.record(graph);
            if (!recorded) return recorded.error();
            transferred = std::move(*recorded);
        }
    }
    const relief::Inputs in{.eye = eye,
                            .objects = drawn.fields,
                            .lights = lights,
                            .surface = surfaceId,
                            .sum = next > 0 ? import(sum) : graph::TextureId{},
                            .target = targetId,
                            .lightTable = import(lightTable),
                            .first = next,
                            .end = end,
                            .placed = placed,
                            .transferred = std::move(transferred),
                            .show = scene.view.show};
    return relief.record(graph, in, settings);
}

// All that is no height field, over the finished light on the fields.
Status Renderer::State::addOthers(const scene::Scene& scene, const Drawn& drawn) {
    composed = Compose::replaces(scene, drawn) && !isGeometric(scene.view.show);
    if (drawn.count() == drawn.fields.size() || isGeometric(scene.view.show)) return Done{};
    const double before = now();
    const views::Eye eye = views::makeEye(scene, float(size.x) / float(size.y));
    const Compose::Inputs in = composeInputs(scene, eye, drawn);
    if (Status prepared = compose.prepare(in); !prepared) return prepared;
    const Status added = runGraph([&](graph::FrameGraph& graph) { return compose.record(graph, in); });
    context.device().wait(picture().handle());
    workMs += now() - before;
    return added;
}

Status Renderer::State::slice(const scene::Scene& scene) {
    const double beforeWater = now();
    const Result<bool> still = compose.waters().advance(scene);
    workMs += now() - beforeWater;
    if (!still) return still.error();
    if (!*still) return Done{};
    if (surfaceShown && shownKey != surfaceKey(scene, size, compose.waters().changes()))
        surfaceShown = surfaceDrawn = false; // water has moved
    Result<Drawn> drawn = drawnOf(scene, images, compose.waters());
    if (!drawn) return drawn.error();
    const views::Eye eye = views::makeEye(scene, float(size.x) / float(size.y));
    const bool geometric = isGeometric(scene.view.show);
    if (stages[stage].transfer && next == 0) {
        const Result<bool> ready = prepareTransfers(scene, drawn->fields);
        if (!ready) return ready.error();
        if (!*ready) return Done{};
    }
    const int end = geometric ? int(lights.size()) : sliceEnd();
    const bool more = end < int(lights.size());
    if ((more || next > 0) && !scratch)
        scratch = graph::Texture(context.device(), sum.desc(), "frame.scratch");
    const double before = now();

    const Status status =
        runGraph([&](graph::FrameGraph& graph) { return recordSlice(graph, scene, eye, *drawn, end); });
    if (!status) return status;
    surfaceDrawn = true;
    if (next > 0) std::swap(sum, scratch);
    context.device().wait(sum.handle()); // so that what is reported as time is time
    const double took = now() - before;
    workMs += took;
    if (end > next) msPerLight = took / (end - next);
    next = end;
    if (more) return Done{};
    std::swap(sum, shown);
    if (!surfaceShown) {
        std::swap(surface, shownSurface);
        shownKey = surfaceKey(scene, size, compose.waters().changes());
        compose.forget();
    }
    surfaceShown = true;
    if (Status added = addOthers(scene, *drawn); !added) return added;
    stats.lights = int(lights.size());
    ++stage;
    startStage(scene);
    if (stage >= stages.size()) {
        stats.milliseconds = workMs;
        stats.technique = scene.technique;
        *static_cast<relief::Settings*>(stats.technique.at("relief").data()) = settings;
        stats.planMilliseconds = planMs;
        stats.draws = context.device().drawCount() - drawsBefore;
        stats.passes = passes;
        images.trim();
        pool.trim();
    }
    return Done{};
}

Status Renderer::State::recordDisplay(graph::FrameGraph& graph, const scene::Scene& scene,
                                      graph::TextureId target, bool linear) {
    std::vector<std::string> defines;
    if (linear) defines.push_back("LINEAR");
    if (composed) defines.push_back("COMPOSED");
    Result<const gl::Program*> program = context.program("frame/display", defines);
    if (!program) return program.error();
    const views::Eye eye = views::makeEye(scene, float(size.x) / float(size.y));
    DisplayBlock block = displayOf(scene, eye);
    if (linear) {
        block.scale = vec4(1);
        block.shift = vec4(0);
    }
    const graph::TextureId surfaceId =
        graph.import(shownSurface.handle(), shownSurface.desc(), shownSurface.label());
    const graph::TextureId shownId = graph.import(picture().handle(), picture().desc(), picture().label());
    graph.addPass("frame.display", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(linear ? "linear values for a file" : "exposure, clamp and sRGB curve for the display");
        pass.sample(surfaceId);
        pass.sample(shownId);
        pass.write(target);
        return [=, program = *program](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = block,
                           .textures = {{"uSurface", resources[surfaceId]}, {"uSum", resources[shownId]}}});
        };
    });
    graph.keep(target);
    return Done{};
}

void Renderer::State::takeTruth(const Beside& beside) {
    const TextureDesc desc{.size = beside.truth.size(), .format = Format::RGBA32F};
    const bool fits = truth && truth.desc() == desc;
    if (fits && truthNumber == beside.number) return;
    if (!fits) truth = graph::Texture(context.device(), desc, "frame.truth");
    context.device().upload(truth.handle(), 0, beside.truth.pixels);
    truthNumber = beside.number;
}

Status Renderer::State::recordBeside(graph::FrameGraph& graph, const scene::Scene& scene,
                                     const Beside& beside, const graph::Texture& linear) {
    Result<const gl::Program*> program = context.program("frame/beside", {});
    if (!program) return program.error();
    const auto import = [&](const graph::Texture& texture) {
        return graph.import(texture.handle(), texture.desc(), texture.label());
    };
    const graph::TextureId pictureId = import(linear), truthId = import(truth);
    const TextureDesc screen{.size = beside.screen, .format = Format::RGBA8};
    const graph::TextureId target = graph.import(graph::TextureHandle::Screen, screen, "screen");
    if (Status recorded = recordDisplay(graph, scene, pictureId, true); !recorded) return recorded;

    const DisplayBlock shown = displayOf(scene, views::makeEye(scene, float(size.x) / float(size.y)));
    BesideBlock block;
    block.scale = shown.scale;
    block.shift = shown.shift;
    block.encode = shown.encode;
    block.corner = {beside.corner.x,
                    float(beside.screen.y) - beside.corner.y - float(size.y) * beside.pixelsPerTexel};
    block.pixelsPerTexel = beside.pixelsPerTexel;
    block.divider = beside.divider;
    block.full = beside.full;
    block.right = int(beside.right);
    graph.addPass("frame.beside", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("the picture beside its truth");
        pass.sample(pictureId);
        pass.sample(truthId);
        pass.write(target);
        return [=, program = *program](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = block,
                           .textures = {{"uPicture", resources[pictureId]}, {"uTruth", resources[truthId]}}});
        };
    });
    graph.keep(target);
    return Done{};
}

Result<Image> Renderer::State::display(const scene::Scene& scene, bool linear) {
    const graph::Texture target(context.device(),
                                {.size = size, .format = linear ? Format::RGBA32F : Format::RGBA8},
                                "frame.picture");
    const Status status = runGraph([&](graph::FrameGraph& graph) {
        return recordDisplay(graph, scene, graph.import(target.handle(), target.desc(), target.label()),
                             linear);
    });
    if (!status) return status.error();
    return context.device().read(target.handle());
}

Result<Progress> Renderer::State::advance(const scene::Scene& scene, std::uint64_t newRevision, ivec2 newSize,
                                          Effort effort) {
    if (!started || revision != newRevision || size != newSize || (coarse && effort != Effort::Coarse))
        start(scene, newRevision, newSize, effort);
    if (!complete())
        if (Status status = stage < stages.size() ? slice(scene) : plan(scene); !status) {
            started = false;
            return status.error();
        }
    Progress progress;
    progress.complete = complete();
    float total = planning ? float(settings.environmentLights) : 0, done = 0;
    for (std::size_t i = 0; i < stages.size(); ++i) {
        total += work(stages[i]);
        if (i < stage)
            done += work(stages[i]);
        else if (i == stage)
            done += work(stages[i]) * shareOfStage();
    }
    progress.fraction = progress.complete ? 1 : done / total;
    return progress;
}

// --- public

Renderer::Renderer(gl::Context& context) : state_(std::make_unique<State>(context)) {}
Renderer::~Renderer() = default;

Result<Progress> Renderer::advance(const scene::Scene& scene, std::uint64_t revision, ivec2 size,
                                   bool coarse) {
    return state_->advance(scene, revision, size,
                           coarse ? State::Effort::Coarse : State::Effort::Progressive);
}

Status Renderer::finish(const scene::Scene& scene, std::uint64_t revision, ivec2 size) {
    for (;;) {
        Result<Progress> progress = state_->advance(scene, revision, size, State::Effort::Final);
        if (!progress) return progress.error();
        if (progress->complete) return Done{};
    }
}
Status Renderer::present(const scene::Scene& scene) {
    State& s = *state_;
    assert(s.shown && "present() before the first advance()");
    s.context.device().setScreenSize(s.size);
    return s.runGraph([&](graph::FrameGraph& graph) {
        const TextureDesc screen{.size = s.size, .format = Format::RGBA8};
        return s.recordDisplay(graph, scene, graph.import(graph::TextureHandle::Screen, screen, "screen"),
                               false);
    });
}

Status Renderer::present(const scene::Scene& scene, const Beside& beside) {
    State& s = *state_;
    assert(s.shown && "present() before the first advance()");
    assert(beside.truth.size() == s.size && beside.truth.channels == 4);
    s.takeTruth(beside);
    s.context.device().setScreenSize(beside.screen);
    const graph::Texture linear(s.context.device(), {.size = s.size, .format = Format::RGBA32F},
                                "frame.linear");
    return s.runGraph([&](graph::FrameGraph& graph) { return s.recordBeside(graph, scene, beside, linear); });
}

void Renderer::wait() { state_->context.device().wait(state_->picture().handle()); }

Result<Image> Renderer::read(const scene::Scene& scene, Aov aov) {
    State& s = *state_;
    if (scene.view.show == aov && s.complete()) return s.display(scene, true);
    scene::Scene other = scene;
    other.view.show = aov;
    s.started = false;
    if (Status finished = finish(other, s.revision, s.size); !finished) return finished.error();
    s.started = false; // what is shown now belongs to the copy
    return s.display(other, true);
}

Result<Image> Renderer::readDisplay(const scene::Scene& scene) {
    Result<Image> image = state_->display(scene, false);
    if (!image) return image;
    for (std::size_t i = 0; i < image->pixels.size(); i += 4) {
        const float coverage = image->pixels[i + 3];
        for (int channel = 0; channel < 3 && coverage > 0; ++channel)
            image->pixels[i + channel] = std::min(1.0f, image->pixels[i + channel] / coverage);
    }
    return image;
}

Stats Renderer::stats() const {
    Stats stats = state_->stats;
    stats.bytes = state_->context.device().textureBytes() + state_->context.device().indexBytes();
    if (state_->choice) {
        stats.settings = state_->choice->text();
        stats.predicted = state_->choice->predicted;
    }
    return stats;
}

std::string Renderer::State::leftOut(const scene::Scene& scene, const Drawn& drawn) const {
    const std::vector<views::DrawnObject>& objects = drawn.fields;
    std::string text;
    const auto line = [&](const std::string& what) { text += "  " + what + "\n"; };
    if (drawn.count() < 2) line("views.depth: one visible object cannot hide another");
    const auto hidden = std::count_if(scene.objects.begin(), scene.objects.end(),
                                      [](const scene::Object& object) { return !object.visible; });
    if (hidden > 0) line(std::to_string(hidden) + " object(s): hidden from the camera");
    for (std::size_t i = 0; i < scene.lights.size() && !objects.empty(); ++i)
        if (!std::holds_alternative<scene::PointLight>(scene.lights[i]) &&
            !std::holds_alternative<scene::DistantLight>(scene.lights[i]))
            line("light " + std::to_string(i) + ": relief knows point and distant lights only");
    if (drawn.meshes.glass.empty()) line("refract: no object that is seen lets light through");
    if (std::none_of(objects.begin(), objects.end(),
                     [](const auto& o) { return o.alpha != graph::TextureHandle::None; }))
        line("alpha: no object has an alpha image");
    if (!scene.environment)
        line("environment: the scene names none");
    else if (!scene.environment->enabled)
        line("environment: switched off");
    if (scene.lights.empty()) line("point and distant lights: the scene names none");
    if (scene.quality.maxError > 0 && !Budget::matters(scene))
        line("quality.maxError: every light is a point or a direction, and hierarchy is exact for them");
    return text;
}

Result<std::string> Renderer::explain(const scene::Scene& scene, ivec2 size) {
    State& s = *state_;
    s.shownKey.reset(); // explained as if nothing were there yet
    s.start(scene, s.revision + 1, size, State::Effort::Final);
    while (s.planning)
        if (Status planned = s.plan(scene); !planned) return planned.error();
    for (bool still = false; !still;) {
        const Result<bool> advanced = s.compose.waters().advance(scene);
        if (!advanced) return advanced.error();
        still = *advanced;
    }
    Result<Drawn> drawn = drawnOf(scene, s.images, s.compose.waters());
    if (!drawn) return drawn.error();
    const views::Eye eye = views::makeEye(scene, float(size.x) / float(size.y));
    while (s.stages.back().transfer) { // how many coefficients are used shows once they are there
        const Result<bool> ready = s.makeTransfers(drawn->fields);
        if (!ready) return ready.error();
        if (!*ready) continue;
        s.lightTransfers(scene, drawn->fields);
        break;
    }
    graph::FrameGraph graph;
    const TextureDesc screen{.size = size, .format = Format::RGBA8};
    if (Status r = s.recordSlice(graph, scene, eye, *drawn, int(s.lights.size())); !r) return r.error();
    s.composed = Compose::replaces(scene, *drawn) && !isGeometric(scene.view.show);
    if (!isGeometric(scene.view.show)) {
        const Compose::Inputs in = s.composeInputs(scene, eye, *drawn);
        if (Status r = s.compose.prepare(in); !r) return r.error();
        if (Status r = s.compose.record(graph, in); !r) return r.error();
    }
    if (Status r = s.recordDisplay(graph, scene, graph.import(graph::TextureHandle::Screen, screen, "screen"),
                                   false);
        !r)
        return r.error();
    if (Status compiled = graph.compile(); !compiled) return compiled.error();
    s.started = false;

    std::string text = s.choice ? "quality.maxError chose\n  " + s.choice->text() + "\n" : "";
    text += "techniques\n";
    for (const char* technique : {"relief", "caustics", "brdf", "refract"})
        if (const auto reason = need(scene, technique))
            text += std::string("  ") + technique + ": " + *reason + "\n";
    text += "passes, in the order they run\n" + graph.dump();
    text += "textures that stay\n";
    const auto line = [&](const std::string& label, std::size_t bytes) {
        text += "  " + label + ", " + std::to_string(bytes) + " bytes\n";
    };
    for (const graph::Texture* texture : {&s.surface, &s.shownSurface, &s.shown, &s.sum, &s.lightTable})
        line(texture->label() + " " + std::to_string(texture->desc().size.x) + "x" +
                 std::to_string(texture->desc().size.y) + " " + graph::name(texture->desc().format),
             texture->desc().bytes());
    line("heights, pyramids, meshes and maps of the objects", s.images.bytes());
    if (s.transfers.bytes() > 0)
        line("relief.coefficients, the transfers of all objects", s.transfers.bytes());
    const std::string left = s.leftOut(scene, *drawn);
    return text + "left out\n" + (left.empty() ? "  nothing\n" : left);
}

void Renderer::release() {
    State& s = *state_;
    for (graph::Texture* texture :
         {&s.surface, &s.shownSurface, &s.shown, &s.sum, &s.scratch, &s.lightTable, &s.truth})
        *texture = graph::Texture();
    s.shownKey.reset();
    s.compose.clear();
    s.transfers.clear();
    s.images.clear();
    s.pool.trim();
    s.pool.trim();
    s.started = false;
}

} // namespace lucent::frame
