#include "frame/Renderer.h"

#include "graph/FrameGraph.h"
#include "relief/Relief.h"
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

bool isGeometric(Aov aov) { return aov == Aov::Normal || aov == Aov::Depth || aov == Aov::Position; }

// How a quantity is shown as a picture. Light is exposed and encoded; the rest is brought into [0, 1].
DisplayBlock displayOf(const scene::Scene& scene, const views::Eye& eye) {
    DisplayBlock block;
    switch (scene.view.show) {
    case Aov::Color:
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
    case Aov::Normal:
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

double now() {
    using namespace std::chrono;
    return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

} // namespace

std::span<const ParamTable* const> techniques() {
    static const ParamTable* const list[] = {&relief::Relief::params()};
    return list;
}

// A picture is made in stages: first with few directions of the environment, then with more. A stage is
// summed in slices that take about kSliceMs each; the last complete stage is what is shown.
struct Renderer::State {
    static constexpr double kSliceMs = 40;
    static constexpr int kFirstStage = 20; // directions
    static constexpr int kStageFactor = 4;

    explicit State(gl::Context& gl) : context(gl), pool(gl.device()), images(gl), relief(gl) {}

    gl::Context& context;
    graph::TexturePool pool;
    views::ImageCache images;
    relief::Relief relief;
    graph::Texture surface, shownSurface, shown, sum, scratch, lightTable;

    // the picture being made
    std::uint64_t revision = 0;
    ivec2 size{0};
    bool started = false, coarse = false;
    bool surfaceDrawn = false, surfaceShown = false; // of this picture
    std::vector<int> stages;                         // numbers of environment directions
    std::size_t stage = 0;
    std::vector<relief::LightSource> lights; // of this stage
    int next = 0;                            // light
    double msPerLight = 0;
    double workMs = 0;
    int drawsBefore = 0, passes = 0;
    Stats stats;

    static const relief::Settings& settings(const scene::Scene& scene) {
        return scene.technique.at("relief").as<relief::Settings>();
    }

    void start(const scene::Scene& scene, std::uint64_t newRevision, ivec2 newSize, bool isCoarse);
    void makeTargets();
    void startStage(const scene::Scene& scene);
    Status slice(const scene::Scene& scene);
    Status recordSlice(graph::FrameGraph& graph, const scene::Scene& scene, const views::Eye& eye,
                       const std::vector<views::DrawnObject>& objects, int end);
    std::string leftOut(const scene::Scene& scene, const std::vector<views::DrawnObject>& objects) const;
    Status runGraph(const std::function<Status(graph::FrameGraph&)>& record);
    Result<Image> display(const scene::Scene& scene, bool linear);
    Status recordDisplay(graph::FrameGraph& graph, const scene::Scene& scene, graph::TextureId target,
                         bool linear);
    bool complete() const { return started && stage >= stages.size(); }
    int sliceEnd() const;
};

void Renderer::State::start(const scene::Scene& scene, std::uint64_t newRevision, ivec2 newSize,
                            bool isCoarse) {
    started = true;
    revision = newRevision;
    size = newSize;
    surfaceDrawn = surfaceShown = false;
    stage = 0;
    workMs = 0;
    drawsBefore = context.device().drawCount();
    passes = 0;
    stages.clear();
    const bool manyLights = scene.environment && scene.environment->enabled && !isGeometric(scene.view.show);
    const int wanted = settings(scene).environmentLights;
    for (int count = kFirstStage; manyLights && count * 2 < wanted; count *= kStageFactor)
        stages.push_back(count);
    stages.push_back(wanted);
    coarse = isCoarse && stages.size() > 1;
    if (coarse) stages.resize(1);
    makeTargets();
    startStage(scene);
}

void Renderer::State::makeTargets() {
    const TextureDesc desc{.size = size, .format = Format::RGBA32F};
    if (surface && surface.desc() == desc) return;
    gl::Device& device = context.device();
    surface = graph::Texture(device, desc, "frame.surface");
    shownSurface = graph::Texture(device, desc, "frame.shownSurface");
    shown = graph::Texture(device, desc, "frame.shown");
    sum = graph::Texture(device, desc, "frame.sum");
    scratch = graph::Texture(); // made when a sum takes more than one slice
}

void Renderer::State::startStage(const scene::Scene& scene) {
    next = 0;
    if (stage >= stages.size()) return;
    lights = relief::Relief::lights(scene, settings(scene), stages[stage]);
    const Image table = relief::Relief::lightTable(lights);
    const TextureDesc desc{.size = table.size(), .format = Format::RGBA32F};
    if (!lightTable || lightTable.desc() != desc)
        lightTable = graph::Texture(context.device(), desc, "relief.lights");
    context.device().upload(lightTable.handle(), 0, table.pixels);
}

int Renderer::State::sliceEnd() const {
    const int count = int(lights.size());
    const int affordable = msPerLight > 0 ? std::max(1, int(kSliceMs / msPerLight)) : 1;
    const int end = std::min(count, next + affordable);
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
                                    const views::Eye& eye, const std::vector<views::DrawnObject>& objects,
                                    int end) {
    const auto import = [&](const graph::Texture& texture) {
        return graph.import(texture.handle(), texture.desc(), texture.label());
    };
    const graph::TextureId surfaceId = import(surfaceShown ? shownSurface : surface);
    const graph::TextureId targetId = import(next > 0 ? scratch : sum);
    graph.keep(targetId);
    if (!surfaceDrawn)
        if (Status s = views::recordSurface(graph, context, eye, objects, surfaceId, size); !s) return s;
    if (isGeometric(scene.view.show))
        return views::recordGeometry(graph, context, eye, objects, surfaceId, targetId, scene.view.show);
    const relief::Inputs in{.eye = eye,
                            .objects = objects,
                            .lights = lights,
                            .surface = surfaceId,
                            .sum = next > 0 ? import(sum) : graph::TextureId{},
                            .target = targetId,
                            .lightTable = import(lightTable),
                            .first = next,
                            .end = end,
                            .show = scene.view.show};
    return relief.record(graph, in, settings(scene));
}

Status Renderer::State::slice(const scene::Scene& scene) {
    Result<std::vector<views::DrawnObject>> objects = views::drawnObjects(scene, images);
    if (!objects) return objects.error();
    const views::Eye eye = views::makeEye(scene, float(size.x) / float(size.y));
    const bool geometric = isGeometric(scene.view.show);
    const int end = geometric ? int(lights.size()) : sliceEnd();
    const bool more = end < int(lights.size());
    if ((more || next > 0) && !scratch)
        scratch = graph::Texture(context.device(), sum.desc(), "frame.scratch");
    const double before = now();

    const Status status =
        runGraph([&](graph::FrameGraph& graph) { return recordSlice(graph, scene, eye, *objects, end); });
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
    if (!surfaceShown) std::swap(surface, shownSurface);
    surfaceShown = true;
    stats.lights = int(lights.size());
    ++stage;
    startStage(scene);
    if (stage >= stages.size()) {
        stats.milliseconds = workMs;
        stats.draws = context.device().drawCount() - drawsBefore;
        stats.passes = passes;
        images.trim();
        pool.trim();
    }
    return Done{};
}

Status Renderer::State::recordDisplay(graph::FrameGraph& graph, const scene::Scene& scene,
                                      graph::TextureId target, bool linear) {
    Result<const gl::Program*> program = context.program(
        "frame/display", linear ? std::vector<std::string>{"LINEAR"} : std::vector<std::string>{});
    if (!program) return program.error();
    const views::Eye eye = views::makeEye(scene, float(size.x) / float(size.y));
    DisplayBlock block = displayOf(scene, eye);
    if (linear) {
        block.scale = vec4(1);
        block.shift = vec4(0);
    }
    const graph::TextureId surfaceId =
        graph.import(shownSurface.handle(), shownSurface.desc(), shownSurface.label());
    const graph::TextureId shownId = graph.import(shown.handle(), shown.desc(), shown.label());
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

// --- public

Renderer::Renderer(gl::Context& context) : state_(std::make_unique<State>(context)) {}
Renderer::~Renderer() = default;

Result<Progress> Renderer::advance(const scene::Scene& scene, std::uint64_t revision, ivec2 size,
                                   bool coarse) {
    State& s = *state_;
    if (!s.started || s.revision != revision || s.size != size || (s.coarse && !coarse))
        s.start(scene, revision, size, coarse);
    if (!s.complete())
        if (Status status = s.slice(scene); !status) {
            s.started = false;
            return status.error();
        }
    Progress progress;
    progress.complete = s.complete();
    float total = 0, done = 0;
    for (std::size_t i = 0; i < s.stages.size(); ++i) {
        total += float(s.stages[i]);
        if (i < s.stage)
            done += float(s.stages[i]);
        else if (i == s.stage)
            done += float(s.stages[i]) * float(s.next) / float(std::max<std::size_t>(1, s.lights.size()));
    }
    progress.fraction = progress.complete ? 1 : done / total;
    return progress;
}

Status Renderer::finish(const scene::Scene& scene, std::uint64_t revision, ivec2 size) {
    for (;;) {
        Result<Progress> progress = advance(scene, revision, size);
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

void Renderer::wait() { state_->context.device().wait(state_->shown.handle()); }

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
    stats.bytes = state_->context.device().textureBytes();
    return stats;
}

std::string Renderer::State::leftOut(const scene::Scene& scene,
                                     const std::vector<views::DrawnObject>& objects) const {
    std::string text;
    const auto line = [&](const std::string& what) { text += "  " + what + "\n"; };
    if (objects.size() < 2) line("views.depth: one visible object cannot hide another");
    if (objects.size() < scene.objects.size())
        line(std::to_string(scene.objects.size() - objects.size()) +
             " object(s): not visible, and relief casts no "
             "light on other objects");
    if (std::none_of(objects.begin(), objects.end(),
                     [](const auto& o) { return o.alpha != graph::TextureHandle::None; }))
        line("alpha: no object has an alpha image");
    if (!scene.environment)
        line("environment: the scene names none");
    else if (!scene.environment->enabled)
        line("environment: switched off");
    if (scene.lights.empty()) line("point and distant lights: the scene names none");
    if (scene.maxError) line("quality.maxError: hierarchy is exact, there is nothing to trade");
    return text;
}

Result<std::string> Renderer::explain(const scene::Scene& scene, ivec2 size) {
    State& s = *state_;
    s.start(scene, s.revision + 1, size, false);
    s.stage = s.stages.size() - 1; // the last stage has every light
    s.startStage(scene);
    Result<std::vector<views::DrawnObject>> objects = views::drawnObjects(scene, s.images);
    if (!objects) return objects.error();
    const views::Eye eye = views::makeEye(scene, float(size.x) / float(size.y));
    graph::FrameGraph graph;
    const TextureDesc screen{.size = size, .format = Format::RGBA8};
    if (Status r = s.recordSlice(graph, scene, eye, *objects, int(s.lights.size())); !r) return r.error();
    if (Status r = s.recordDisplay(graph, scene, graph.import(graph::TextureHandle::Screen, screen, "screen"),
                                   false);
        !r)
        return r.error();
    if (Status compiled = graph.compile(); !compiled) return compiled.error();
    s.started = false;

    std::string text = "techniques\n";
    if (const auto reason = relief::Relief::need(scene)) text += "  relief: " + *reason + "\n";
    text += "passes, in the order they run\n" + graph.dump();
    text += "textures that stay\n";
    const auto line = [&](const std::string& label, std::size_t bytes) {
        text += "  " + label + ", " + std::to_string(bytes) + " bytes\n";
    };
    for (const graph::Texture* texture : {&s.surface, &s.shownSurface, &s.shown, &s.sum, &s.lightTable})
        line(texture->label() + " " + std::to_string(texture->desc().size.x) + "x" +
                 std::to_string(texture->desc().size.y) + " " + graph::name(texture->desc().format),
             texture->desc().bytes());
    line("heights, pyramids and maps of the objects", s.images.bytes());
    const std::string left = s.leftOut(scene, *objects);
    return text + "left out\n" + (left.empty() ? "  nothing\n" : left);
}

void Renderer::release() {
    State& s = *state_;
    for (graph::Texture* texture : {&s.surface, &s.shownSurface, &s.shown, &s.sum, &s.scratch, &s.lightTable})
        *texture = graph::Texture();
    s.images.clear();
    s.pool.trim();
    s.pool.trim();
    s.started = false;
}

} // namespace lucent::frame
