// A picture as it grows: its settings, its stages, and the slices of work of each.
#include "frame/RendererState.h"

#include "views/Surface.h"

#include <algorithm>
#include <chrono>

namespace lucent::frame {

using graph::Format;
using graph::TextureDesc;
using scene::Aov;

namespace {

using views::hasEnvironment;

// Light itself, which may be found in several ways, not how one of them finds it.
bool showsLight(const scene::Scene& scene) {
    return scene.view.show == Aov::Color || scene.view.show == Aov::Illumination;
}

// Whether the scene wants an error kept that settings could miss.
bool limited(const scene::Scene& scene) {
    return scene.quality.maxError > 0 && showsLight(scene) && Budget::matters(scene);
}

bool limitedGlass(const scene::Scene& scene) {
    return scene.quality.maxError > 0 && scene.view.show == Aov::Color && GlassBudget::matters(scene);
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

// A transfer holds what one field keeps of all directions, not what other objects do.
bool standsAlone(const scene::Scene& scene) {
    return scene.objects.size() == 1 && scene.objects.front().isField();
}

// Of which a first look takes fewer samples.
bool hasLargeLamp(const scene::Scene& scene) {
    return views::lampPoints(scene, 2).size() > views::lampPoints(scene, 1).size();
}

double now() {
    using namespace std::chrono;
    return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

} // namespace

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
    atOnce = effort == Effort::Final;
    const bool glass = limitedGlass(scene);
    planning = (limited(scene) || glass) && !dragged;
    choosing = false;
    if (!glass) glassChoice.reset();
    if (glass && planning) glassBudget.start(scene, size);
    if (!limited(scene)) {
        choice.reset();
        return;
    }
    const relief::Settings own = settings;
    settings.method = relief::Method::Transfer;
    settings.terms = relief::kMostTerms;
    if (planning) budget.start(scene, size);
    if (hasEnvironment(scene) && transfers.ready(scene, settings)) {
        planning = glass && planning;
    } else if (effort == Effort::Coarse && choice) {
        settings = choice->settings;
    } else {
        settings = own;
        settings.method = relief::Method::Hierarchy;
        choosing = planning;
    }
}

void Renderer::State::addStages(const scene::Scene& scene, Effort effort) {
    const bool manyLights = (relief::Relief::need(scene) || brdf::Brdf::need(scene)) &&
                            hasEnvironment(scene) && !isGeometric(scene.view.show);
    const int wanted = settings.environmentLights;
    const bool transfer =
        manyLights && settings.method == relief::Method::Transfer && showsLight(scene) && standsAlone(scene);
    const bool atOnce = effort == Effort::Final || (transfer && transfers.ready(scene, settings));
    const int summed = transfer ? kFirstStage * kStageFactor : wanted; // while the transfer is made
    for (int count = kFirstStage; manyLights && !atOnce && count * 2 < summed; count *= kStageFactor)
        stages.push_back({count, false});
    if (transfer)
        stages.push_back({seesWalls(scene) ? wanted : 0, true});
    else
        stages.push_back({manyLights ? wanted : 0, false});
    coarse = effort == Effort::Coarse && (stages.size() > 1 || limited(scene) || hasLargeLamp(scene) ||
                                          need(scene, "brdf") || need(scene, "subsurface"));
    if (coarse) stages.resize(1);
}

// Chooses the settings for one slice of time, and goes on with them when they are known.
Status Renderer::State::plan(const scene::Scene& scene) {
    const double before = now();
    const auto chooses = [&] { return choosing && !budget.done(); };
    while (chooses() && now() - before < kSliceMs)
        if (Status stepped = budget.step(scene); !stepped) return stepped;
    while (!chooses() && !glassBudget.done() && now() - before < kSliceMs)
        if (Status stepped = glassBudget.step(scene); !stepped) return stepped;
    workMs += now() - before;
    planMs += now() - before;
    if (chooses() || !glassBudget.done()) return Done{};
    if (limitedGlass(scene)) glassChoice = glassBudget.choice();
    if (choosing) {
        choice = budget.choice();
        settings = choice->settings;
    }
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
    planning = choosing = true;
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
    lights = views::lightSamples(scene, samplingOf(scene));
    placed = int(std::count_if(lights.begin(), lights.end(),
                               [](const views::LampPoint& light) { return !light.isEnvironment; }));
    const Image table = views::sampleTable(lights);
    const TextureDesc desc{.size = table.size(), .format = Format::RGBA32F};
    if (!lightTable || lightTable.desc() != desc)
        lightTable = graph::Texture(context.device(), desc, "light.samples");
    context.device().upload(lightTable.handle(), 0, table.pixels);
}

int Renderer::State::sliceEnd() const {
    const int count = int(lights.size()), most = views::mostSamplesAtOnce(context, size);
    if (atOnce) return std::min(count, next + most);
    const double affordable = msPerLight > 0 ? std::max(1.0, kSliceMs / msPerLight) : 1;
    const int end = std::min(count, next + int(std::min(affordable, double(most))));
    // Every point and distant light belongs to the first look: they are few.
    return next == 0 ? std::min(count, std::max(end, std::min(4, most))) : end;
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

views::Sampling Renderer::State::samplingOf(const scene::Scene& scene) const {
    const scene::Scene used = chosen(scene);
    const bool onFields = relief::Relief::need(scene).has_value();
    const int own = used.technique.at("brdf").as<brdf::Settings>().lightSamples;
    const int lamp = onFields ? settings.lightSamples : own;
    return {.lamp = coarse || dragged ? std::min(lamp, kCoarseLampSamples) : lamp,
            .directions = stages[stage].directions,
            .environment = settings.environmentSampling};
}

Status Renderer::State::recordSlice(graph::FrameGraph& graph, const scene::Scene& scene,
                                    const views::Eye& eye, const Drawn& drawn, int end) {
    const graph::TextureId surfaceId = import(graph, surfaceShown ? shownSurface : surface);
    const graph::TextureId targetId = import(graph, next > 0 ? scratch : sum);
    graph.keep(targetId);
    Result<Posed> posed = pose(graph, scene);
    if (!posed) return posed.error();
    std::vector<views::PosedMesh> solids = posed->visible(posed->solid);
    if (isGeometric(scene.view.show)) {
        const std::vector<views::PosedMesh> glass = posed->visible(posed->glass);
        solids.insert(solids.end(), glass.begin(), glass.end());
    }
    if (!surfaceDrawn && !solids.empty()) graph.keep(surfaceId); // read after this graph
    if (!surfaceDrawn)
        if (Status s = views::recordSurface(graph, context, eye, drawn.fields, solids, surfaceId, size); !s)
            return s;
    if (isGeometric(scene.view.show))
        return views::recordGeometry(graph, context, eye, drawn.fields, solids, surfaceId, targetId,
                                     scene.view.show, size);
    return recordLight(graph, scene, eye, drawn, *posed, surfaceId, targetId, end);
}

void Renderer::State::recordClear(graph::FrameGraph& graph, graph::TextureId target) {
    graph.addPass("frame.clear", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("nothing is lit yet");
        pass.write(target);
        pass.clear(target, vec4(0));
        return [](const graph::Resources&, graph::Commands&) {};
    });
}

// Light of one slice of the samples on everything that is lit where it is seen.
Status Renderer::State::recordLight(graph::FrameGraph& graph, const scene::Scene& scene,
                                    const views::Eye& eye, const Drawn& drawn, const Posed& posed,
                                    graph::TextureId surfaceId, graph::TextureId targetId, int end) {
    const std::vector<views::PosedMesh> solids = posed.visible(posed.solid);
    std::vector<views::PosedMesh> matt = solids;
    std::erase_if(matt, [](const views::PosedMesh& mesh) {
        const scene::Material& material = mesh.drawn.object->material;
        return material.isMirror() || (material.isScattering() && !mesh.drawn.paint);
    });
    const bool showsMatt = scene.view.show == Aov::Color || scene.view.show == Aov::Irradiance;
    if (drawn.fields.empty() && (matt.empty() || !showsMatt)) {
        recordClear(graph, targetId);
        return Done{};
    }
    graph::TextureId flux;
    if (next == 0) {
        const scene::Scene used = chosen(scene);
        Result<graph::TextureId> caustics =
            compose.recordCaustics(graph, composeInputs(used, eye, drawn), posed, surfaceId);
        if (!caustics) return caustics.error();
        flux = *caustics;
    }
    const views::Lit lit{.eye = eye,
                         .size = size,
                         .surface = surfaceId,
                         .fields = drawn.fields,
                         .solids = solids,
                         .casters = posed.fields,
                         .opaque = posed.solid,
                         .refractive = posed.glass,
                         .shadowSize = scene.technique.at("brdf").as<brdf::Settings>().shadowSize};
    const std::span<const views::LampPoint> slice(lights.data() + next, std::size_t(end - next));
    Result<views::Occlusion> occlusion = views::recordOcclusion(graph, context, lit, slice);
    if (!occlusion) return occlusion.error();
    const graph::TextureId before = next > 0 ? import(graph, sum) : graph::TextureId{};
    const graph::TextureId table = import(graph, lightTable);
    if (!drawn.fields.empty()) {
        Result<std::vector<relief::Transferred>> transferred = recordTransferred(graph, drawn);
        if (!transferred) return transferred.error();
        const relief::Inputs in{.eye = eye,
                                .objects = drawn.fields,
                                .scene = scene,
                                .lights = lights,
                                .surface = surfaceId,
                                .sum = before,
                                .target = targetId,
                                .lightTable = table,
                                .first = next,
                                .end = end,
                                .placed = placed,
                                .transferred = std::move(*transferred),
                                .show = scene.view.show,
                                .occlusion = *occlusion,
                                .flux = flux,
                                .size = size};
        if (Status s = relief.record(graph, in, settings); !s) return s;
    }
    if (!showsMatt) return Done{};
    return brdf.record(graph, {.scene = scene,
                               .eye = eye,
                               .size = size,
                               .solids = matt,
                               .surface = surfaceId,
                               .lightTable = table,
                               .first = next,
                               .end = end,
                               .occlusion = *occlusion,
                               .flux = flux,
                               .sum = before,
                               .target = targetId,
                               .show = scene.view.show,
                               .clears = drawn.fields.empty()});
}

// What the transfers bring, one for each field; none without them. Slices after the first add light to walls
// only.
Result<std::vector<relief::Transferred>> Renderer::State::recordTransferred(graph::FrameGraph& graph,
                                                                            const Drawn& drawn) {
    if (!stages[stage].transfer) return std::vector<relief::Transferred>();
    if (next == 0) return transfers.record(graph);
    return std::vector<relief::Transferred>(drawn.fields.size());
}

Result<Posed> Renderer::State::pose(graph::FrameGraph& graph, const scene::Scene& scene) {
    return posedOf(graph, context, scene, images, compose.waters());
}

// All that is no height field, over the finished light on the fields.
Status Renderer::State::addOthers(const scene::Scene& scene, const Drawn& drawn) {
    composed = Compose::replaces(scene, drawn) && !isGeometric(scene.view.show);
    if (!Compose::isNeeded(scene, drawn) || isGeometric(scene.view.show)) return Done{};
    const double before = now();
    const views::Eye eye = views::makeEye(scene, float(size.x) / float(size.y));
    const scene::Scene used = chosen(scene);
    const Compose::Inputs in = composeInputs(used, eye, drawn);
    const Status added = runGraph([&](graph::FrameGraph& graph) { return compose.record(graph, in); });
    context.device().wait(picture().handle());
    workMs += now() - before;
    return added;
}

// Draws the complete picture again where it turns out to lack surfaces of refractive objects.
Status Renderer::State::settle(const scene::Scene& scene) {
    Result<Drawn> drawn = drawnOf(scene, images, compose.waters());
    if (!drawn) return drawn.error();
    const views::Eye eye = views::makeEye(scene, float(size.x) / float(size.y));
    const scene::Scene used = chosen(scene);
    const Result<bool> again = compose.settle(composeInputs(used, eye, *drawn));
    if (!again) return again.error();
    return *again ? addOthers(scene, *drawn) : Status(Done{});
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
    if (next == 0 && !geometric) {
        if (!surfaceShown) compose.forget();
        const scene::Scene used = chosen(scene);
        if (Status prepared = compose.prepare(composeInputs(used, eye, *drawn)); !prepared) return prepared;
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
    }
    surfaceShown = true;
    if (Status added = addOthers(scene, *drawn); !added) return added;
    stats.lights = int(lights.size());
    ++stage;
    startStage(scene);
    if (stage >= stages.size()) {
        stats.milliseconds = workMs;
        stats.technique = chosen(scene).technique;
        *static_cast<relief::Settings*>(stats.technique.at("relief").data()) = settings;
        stats.planMilliseconds = planMs;
        stats.draws = context.device().drawCount() - drawsBefore;
        stats.passes = passes;
        images.trim();
        pool.trim();
    }
    return Done{};
}
Result<Progress> Renderer::State::advance(const scene::Scene& scene, std::uint64_t newRevision, ivec2 newSize,
                                          Effort effort) {
    if (!started || revision != newRevision || size != newSize || (coarse && effort != Effort::Coarse))
        start(scene, newRevision, newSize, effort);
    if (!complete() || !settled(effort)) {
        const Status status = complete() ? settle(scene) : stage < stages.size() ? slice(scene) : plan(scene);
        if (!status) {
            started = false;
            return status.error();
        }
    }
    Progress progress;
    progress.complete = complete() && settled(effort);
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

} // namespace lucent::frame
