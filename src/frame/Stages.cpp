// A picture as it grows: its settings, its stages, and the slices of work of each.
#include "frame/RendererState.h"
#include "light/FlatWater.h"
#include "scene/CoarseMesh.h"

#include <algorithm>

namespace lucent::frame {

using graph::Format;
using graph::TextureDesc;
using technique::Guest;

namespace {

using views::hasEnvironment;

constexpr int kFewestDirections = 6; // of the environment
constexpr int kPreviewCells = 64;    // of meshes, along their longest side
constexpr int kShadowTexels = 2;     // of a preview, for each pixel along its longer side

bool shareShapes(const std::vector<views::ObjectKey>& some, const std::vector<views::ObjectKey>& others) {
    return std::any_of(some.begin(), some.end(), [&](const views::ObjectKey& one) {
        return std::any_of(others.begin(), others.end(),
                           [&](const views::ObjectKey& other) { return one.own.shape == other.own.shape; });
    });
}

} // namespace

// --- settings

// The scene with what its error chose, and with all knobs turned down for a preview.
scene::Scene Renderer::State::chosen(const scene::Scene& scene) const {
    scene::Scene used = scene;
    budget.apply(used);
    if (!isCoarse()) return used;
    turnDown(used, hasFewPixels());
    int& shadowSize = views::samplingOf(used).shadowSize; // finer shadows would not be seen in few pixels
    shadowSize = std::min(shadowSize, kShadowTexels * std::max(size.x, size.y));
    return used;
}

// Begins to choose, where there is an error to keep; who draws for others keeps none.
void Renderer::State::startChoosing(const scene::Scene& scene) {
    if (own && scene.quality.maxError > 0 && budget.matters(scene))
        budget.start(scene, dragged);
    else
        budget.forget();
    planning = !dragged && !budget.done();
}

// Chooses for one slice of time, and goes on with the settings when they are known.
Status Renderer::State::plan(const scene::Scene& scene) {
    const Result<bool> areThere = takeObjects(scene); // a budget's pictures would take them all at once
    if (!areThere) return areThere.error();
    if (!*areThere) return Done{};
    const double before = nowMs();
    for (bool waits = false; !budget.done() && !waits && nowMs() - before < kSliceMs; waits = budget.waits())
        if (Status stepped = budget.step(scene); !stepped) return stepped;
    workMs += nowMs() - before;
    planMs += nowMs() - before;
    planning = !budget.done();
    if (planning) return Done{};
    addStages(scene, Effort::Final, true);
    startStage();
    return Done{};
}

// --- stages

void Renderer::State::start(const scene::Scene& asked, std::uint64_t newRevision, ivec2 newSize,
                            Effort effort) {
    const bool previewed = started && coarse && complete() && revision == newRevision;
    if (started && complete())
        rested = taken = 0; // else changes that follow each other fast would let nothing be drawn
    if (started && !complete() && !earlier) earlier.emplace();
    readings.clear();
    drop();
    auto copy = std::make_unique<scene::Scene>(asked);
    runs = pictured && pictured->view.time != asked.view.time;
    // Of a picture with fewer pixels triangles would be smaller than these.
    const bool coarsens = effort == Effort::Coarse && newSize != screen;
    if (std::exchange(coarseMeshes, coarsens) != coarsens) taken = 0;
    if (coarsens) scene::coarsen(*copy, kPreviewCells);
    const bool isFrugal = asked.quality.maxError == 0;
    if (isFrugal) copy->quality.maxError = defaultError;
    pictured = std::move(copy);
    const scene::Scene& scene = *pictured;
    budget.beFrugal(isFrugal);
    started = true;
    revision = newRevision;
    size = newSize;
    if (!own) screen = size;
    if (SceneKey key = sceneryKey(scene); sceneryFor != key) {
        sceneryFor = std::move(key);
        ++scenery;
    }
    std::vector<views::ObjectKey> standing = views::objectKeys(asked);
    if (!objects.empty() && !shareShapes(objects, standing)) { // another scene
        rested = taken = 0;
        isNew = true;
    }
    objects = std::move(standing);
    makeTargets();
    sample = samples = 0;
    wholeMs = 0;
    told = {};
    whole = false;
    surfaceDrawn = surfaceShown = shownKey == surfaceKeyOf(scene); // light alone may have changed
    stage = 0;
    workMs = planMs = 0;
    drawsBefore = context.device().drawCount();
    passes = 0;
    stages.clear();
    coarse = false;
    dragged = effort == Effort::Coarse;
    atOnce = effort == Effort::Final;
    startChoosing(scene);
    if (!planning)
        addStages(scene, effort, previewed);
    else if (effort == Effort::Progressive && !previewed)
        stages.push_back({kFirstStage, false, true});
    startStage();
}

// Who works out the environment's light once for all pictures.
Guest* Renderer::State::baker(const scene::Scene& scene) const {
    for (Guest* guest : needed(scene))
        if (guest->bakes(scene)) return guest;
    return nullptr;
}

// @param previewed  there is a preview already
void Renderer::State::addStages(const scene::Scene& scene, Effort effort, bool previewed) {
    const bool isLit = !views::isGeometric(scene.view.show);
    const scene::Scene used = chosen(scene);
    const std::vector<Guest*> guests = needed(scene);
    const bool shades =
        std::any_of(guests.begin(), guests.end(), [&](const Guest* guest) { return guest->shades(scene); });
    const int directions = isLit && shades && hasEnvironment(scene) ? directionsOfSample(used) : 0;
    Guest* const bakes = isLit ? baker(used) : nullptr;
    const bool isThere = bakes && bakes->isBaked(used);
    const bool turns = technique::knobs(scene).size() > (hasEnvironment(scene) ? 1 : 0); // not its directions
    const bool coarsens = directions > 2 * kFirstStage || bakes || turns;
    const bool limited = scene.quality.maxError > 0 && dragged; // not as exact as is asked for
    const bool isShown = effort == Effort::Coarse || effort == Effort::Progressive;
    const bool hasPreview = isLit && !isThere && isShown && (coarsens || limited);
    // Nothing is kept for a first look, nor of what moves: each direction takes a slow device a shadow map of
    // all that casts one.
    const bool isHurried = isNew || runs || hasFewPixels();
    const int first = isHurried && context.caps().software ? kFewestDirections : kFirstStage;
    if (hasPreview && !previewed) stages.push_back({std::min(directions, first), false, true});
    coarse = dragged && hasPreview;
    if (coarse) return;
    // While something is baked its light is summed.
    const int summed = bakes ? kFirstStage * kStageFactor : directions;
    const bool grows = hasPreview && effort == Effort::Progressive;
    for (int count = kFirstStage * kStageFactor; grows && count * 2 < summed; count *= kStageFactor)
        stages.push_back({count, false, true});
    const bool sums = !bakes || bakes->sumsBesideBake(used);
    stages.push_back({sums ? directions : 0, bakes != nullptr, false});
    if (!dragged) addSamples(scene);
}

// The last stage again for each further sample of the pixels.
void Renderer::State::addSamples(const scene::Scene& scene) {
    const Stage whole = stages.back();
    for (int i = 1; i < pixelSamples(scene); ++i) {
        stages.push_back(whole);
        stages.back().sample = i;
    }
}

// How many light samples take as long as what follows their sum.
float Renderer::State::restWorth() const {
    const double pixels = double(size.x) * size.y;
    const double ofLight = next > 0 ? sliceMs / next : lightMs * pixels;
    return float(restMs * pixels / std::max(ofLight, 1e-3));
}

// How long a stage takes, in directions; where lamps alone shine each takes as long as the others.
float Renderer::State::work(const Stage& of) const {
    const int directions = of.baked ? 2 * kStageFactor * kStageFactor * kFirstStage : of.directions;
    return float(std::max(1, directions)) + restWorth();
}

float Renderer::State::shareOfStage(const scene::Scene& scene) const {
    if (stages[stage].baked)
        if (const Guest* guest = baker(chosen(scene))) return guest->bakedShare();
    if (!hasLights) return 0;
    float done = float(next);
    if (running && running->work == Running::Work::Slice)
        done += shareOfRunning() * float(std::max(1, running->end - next));
    else if (running)
        done += shareOfRunning() * restWorth();
    const float share = done / (float(lights.size()) + restWorth());
    // Light and rest are misjudged where the stage before drew what stays, such as caustics.
    const bool isKnown = stages[stage].sample > 0 && wholeMs > 0;
    return isKnown ? std::min(share, float((nowMs() - stageBegan) / wholeMs)) : share;
}

Progress Renderer::State::progressOf(const scene::Scene& scene, Effort effort) const {
    Progress progress{.complete = complete() && !running && settled(effort),
                      .samples = samples,
                      .stage = int(stage),
                      .task = samples > 0 ? Task::Samples : Task::Picture,
                      .share = 1,
                      .drawsProbes = std::any_of(asides.begin(), asides.end(),
                                                 [](const Aside& aside) { return aside.cube >= 0; })};
    if (progress.complete) return progress;
    const bool hasPlanned = told.task == Task::Settings && told.share > 0;
    if (planning || (hasPlanned && !surveyed)) { // what follows is not known yet
        progress.task = Task::Settings;
        progress.share = budget.share();
        return progress;
    }
    if (samples == 0 && !asides.empty()) {
        progress.task = Task::Surroundings;
        progress.share = (float(asidesAsked - asides.size()) + asideShare) / float(asidesAsked);
        return progress;
    }
    float total = 0, done = 0;
    for (std::size_t i = 0; i < stages.size(); ++i) {
        if ((stages[i].sample > 0) != (samples > 0)) continue;
        total += work(stages[i]);
        if (i < stage)
            done += work(stages[i]);
        else if (i == stage)
            done += work(stages[i]) * shareOfStage(scene);
    }
    if (total > 0) progress.share = done / total;
    return progress;
}

// Whether each sample of a pixel has its own light samples: unless a guest works with those of the first.
bool Renderer::State::variesLight(const scene::Scene& scene) const {
    const std::vector<Guest*> guests = needed(scene);
    return pixelSamples(scene) > 1 && std::none_of(guests.begin(), guests.end(), [&](const Guest* guest) {
               return guest->keepsLight(scene);
           });
}

// How many directions stand for the environment in each sample of a pixel, which share them where each has
// others.
int Renderer::State::directionsOfSample(const scene::Scene& scene) const {
    const int all = views::samplingOf(scene).directions;
    return variesLight(scene) ? std::max(kFewestDirections, all / pixelSamples(scene)) : all;
}

void Renderer::State::startStage() {
    next = 0;
    sliceMs = 0;
    surveyed = hasLights = false;
}

// The light samples of a stage.
void Renderer::State::placeLights(const scene::Scene& scene) {
    hasLights = true;
    const scene::Scene used = chosen(scene);
    views::Sampling sampling = views::samplingOf(used);
    sampling.directions = stages[stage].directions;
    const bool varies = variesLight(used);
    const ivec2 of = varies ? ivec2(stages[stage].sample, pixelSamples(used)) : lightOf;
    lights = views::lightSamples(used, sampling, of.x, of.y);
    placed = int(std::count_if(lights.begin(), lights.end(),
                               [](const views::LampPoint& light) { return !light.isEnvironment; }));
    const auto water = bendingWater(used);
    if (water) lights = views::withWater(lights, *water);
    const Image table = views::sampleTable(lights, water);
    const TextureDesc desc{.size = table.size(), .format = Format::RGBA32F};
    if (!lightTable || lightTable.desc() != desc)
        lightTable = graph::Texture(context.device(), desc, "light.samples");
    context.device().upload(lightTable.handle(), 0, table.pixels);
}

// --- one slice of work

void Renderer::State::makeTargets() {
    const TextureDesc desc{.size = size, .format = Format::RGBA32F};
    if (surface && surface.desc() == desc) return;
    gl::Device& device = context.device();
    shownKey.reset();
    presentable = false;
    surface = graph::Texture(device, desc, "frame.surface");
    shownSurface = graph::Texture(device, desc, "frame.shownSurface");
    shown = graph::Texture(device, desc, "frame.shown");
    sum = graph::Texture(device, desc, "frame.sum");
    scratch = graph::Texture(); // made when a sum takes more than one slice,
    mean = graph::Texture();    // or a pixel several samples
    averaged = false;
}

int Renderer::State::sliceEnd() const {
    const int count = int(lights.size()), most = views::mostSamplesAtOnce(context, size);
    if (atOnce) return std::min(count, next + most);
    const double affordable = std::max(1.0, kSliceMs / recordMs);
    const int end = std::min(count, next + int(std::min(affordable, double(most))));
    // Every point and distant light belongs to the preview: they are few.
    return next == 0 ? std::min(count, std::max(end, std::min(4, most))) : end;
}

// Works for one slice of time on what must be there before a stage begins. @return whether it is
Result<bool> Renderer::State::ready(const Moment& moment) {
    Guest* const guest = stages[stage].baked ? baker(moment.scene) : nullptr;
    if (!guest || sample > 0) return true; // the first sample has waited for it
    const double before = nowMs();
    Result<bool> isThere = guest->bake(pictureOf(moment), kSliceMs);
    if (isThere && *isThere) isThere = budget.admitsBake(moment.scene);
    workMs += nowMs() - before;
    planning = !dragged && !budget.done(); // again, where it does not keep the error
    if (planning) stages.resize(stage);
    return isThere;
}

// Whether what was made ready by now took so long that whoever looks on is answered first; once for each
// place where it may rest, or what takes that long each time would never end.
bool Renderer::State::rests(int place, double since) {
    if (atOnce || place < rested || nowMs() - since < 0.5 * kSliceMs) return false;
    rested = place + 1;
    return true;
}

// Whether what guests ask can be drawn without waiting for programs, or for what the GPU still draws.
bool Renderer::State::canPreview() {
    if (earlier && !earlier->passed(0)) return false;
    earlier.reset();
    if (!context.hasUnready()) return true;
    if (!context.compile(kCompileMs) || !readings.areDrawn()) return false;
    context.makeReady();
    return true;
}

// Takes objects to the GPU for one slice of time. @return whether all are there
Result<bool> Renderer::State::takeObjects(const scene::Scene& scene) {
    const double begins = nowMs();
    while (!atOnce && taken < int(scene.objects.size())) {
        // What is uploaded waits for all that the GPU has to do, and in a browser the page with it.
        if (!submitted.empty() && !submitted.back().fence.passed(0)) return false;
        if (!images.takePart(scene.objects[std::size_t(taken)])) {
            const Result<views::Drawable::Ptr> one = views::drawableOf(scene, taken++, images, &waters);
            if (!one) return one.error();
        }
        if (nowMs() - begins > 0.25 * kSliceMs)
            return false; // a part of the next may take longer than a slice
    }
    return true;
}

Status Renderer::State::slice(const scene::Scene& scene) {
    const double begins = nowMs();
    if (next == 0) sample = stages[stage].sample;
    if (!hasLights) placeLights(scene);
    if (rests(0, begins)) return Done{};
    const double beforeWater = nowMs();
    const Result<bool> still = waters.advance(scene);
    workMs += nowMs() - beforeWater;
    if (!still) return still.error();
    if (!*still) return Done{};
    if (const std::uint64_t changes = waters.changes(); sceneryFor->waters != changes) {
        sceneryFor->waters = changes;
        ++scenery;
    }
    if (surfaceShown && shownKey != surfaceKeyOf(scene))
        surfaceShown = surfaceDrawn = false; // water has moved, or the samples of the pixels
    const Result<bool> areThere = takeObjects(scene);
    if (!areThere) return areThere.error();
    if (!*areThere) return Done{};
    Result<Moment> moment = momentOf(scene);
    if (!moment) return moment.error();
    if (rests(1, begins)) return Done{};
    auto made = std::make_unique<Running>(*this, std::move(*moment));
    const bool geometric = views::isGeometric(scene.view.show);
    if (next == 0 && !geometric) {
        const Result<bool> isReady = ready(made->moment);
        if (!isReady) return isReady.error();
        if (!*isReady) return Done{};
        const double beforeAround = nowMs();
        const Result<bool> around = lookAround(made->moment);
        workMs += nowMs() - beforeAround;
        if (!around) return around.error();
        if (!*around) return Done{};
        const Result<bool> prepared = prepare(made->picture);
        if (!prepared) return prepared.error();
        if (!*prepared) return Done{};
        if (rests(2, begins)) return Done{};
    }
    made->end = geometric ? int(lights.size()) : sliceEnd();
    if ((made->end < int(lights.size()) || next > 0) && !scratch)
        scratch = graph::Texture(context.device(), sum.desc(), "frame.scratch");
    if (next == 0) stageBegan = begins; // what is made once does not count
    const int count = std::max(1, made->end - next);
    Status begun = begin(std::move(made), Running::Work::Slice, [this](Running& slice) {
        return recordSlice(slice.graph, slice.picture, slice.end);
    });
    if (running) recordMs = std::max(running->ms, 1e-3) / count;
    return begun;
}

// --- what follows passes that have run

// All passes have run.
Status Renderer::State::follow() {
    const std::unique_ptr<Running> done = std::move(running);
    passes += done->graph.livePasses();
    workMs += done->ms;
    if (std::string error = context.takeError(); !error.empty()) return Error{error, Fault::Machine};
    if (done->work == Running::Work::Rest) {
        const double pixels = double(size.x) * size.y;
        lightMs = sliceMs / (pixels * double(std::max<std::size_t>(1, lights.size())));
        restMs = done->ms / pixels;
        return finishStage(done->moment);
    }
    if (done->work == Running::Work::Again) presentable = true;
    if (done->work != Running::Work::Slice) return Done{};
    surfaceDrawn = true;
    sliceMs += done->ms;
    if (next > 0) std::swap(sum, scratch);
    next = done->end;
    return next < int(lights.size()) ? Status(Done{}) : showSum(std::move(done->moment));
}

// All light samples of a stage are summed.
Status Renderer::State::showSum(Moment moment) {
    std::swap(sum, shown);
    if (!surfaceShown) {
        std::swap(surface, shownSurface);
        shownKey = surfaceKeyOf(moment.scene);
    }
    surfaceShown = true;
    return beginRest(std::move(moment), Running::Work::Rest);
}

// Over the sum, what is not summed.
Status Renderer::State::beginRest(Moment moment, Running::Work work) {
    auto made = std::make_unique<Running>(*this, std::move(moment));
    composed = replaces(made->picture);
    if (views::isGeometric(made->moment.scene.view.show)) return finishStage(made->moment);
    presentable = false;
    return begin(std::move(made), work,
                 [this](Running& rest) { return recordRest(rest.graph, rest.picture); });
}

Status Renderer::State::finishStage(const Moment& moment) {
    presentable = true;
    isNew = false;
    stats.lights = int(lights.size());
    whole = !stages[stage].coarse;
    if (whole) wholeMs = nowMs() - stageBegan;
    if (sample == 0) averaged = false;
    eyeShown = middleEyeOf(moment.scene);
    if (size == screen)
        kept = {};
    else if (Status s = keep(moment.scene); !s)
        return s;
    ++stage;
    startStage();
    if (stage < stages.size() && !whole) return Done{};
    stats.milliseconds = workMs;
    stats.technique = moment.scene.technique;
    stats.planMilliseconds = planMs;
    stats.draws = context.device().drawCount() - drawsBefore;
    stats.passes = passes;
    if (stage < stages.size()) return Done{};
    if (own && !coarseMeshes) { // others share it; the whole picture needs what a preview does not
        images.trim();
        shadows.trim();
    }
    pool.trim();
    return Done{};
}

bool Renderer::State::settled(Effort effort) const {
    return effort == Effort::Coarse || !composed ||
           std::none_of(members.begin(), members.end(),
                        [](const Member& member) { return member.guest->isUnsettled(); });
}

// Draws the complete picture again where it turns out to lack something.
Status Renderer::State::settle(const scene::Scene& scene) {
    Result<Moment> moment = momentOf(scene);
    if (!moment) return moment.error();
    const technique::Picture picture = pictureOf(*moment);
    bool again = false;
    for (const Member& member : members) {
        if (!member.guest->isUnsettled()) continue;
        const Result<bool> lacks = member.guest->settle(picture);
        if (!lacks) return lacks.error();
        again = again || *lacks;
    }
    return again ? beginRest(std::move(*moment), Running::Work::Again) : Status(Done{});
}

// The picture of one sample of the pixels joins the mean of those before.
Status Renderer::State::takeSample(const scene::Scene& scene) {
    whole = false;
    samples = sample + 1;
    if (pixelSamples(scene) == 1) {
        mean = graph::Texture();
        return Done{};
    }
    if (!scratch) scratch = graph::Texture(context.device(), sum.desc(), "frame.scratch");
    if (!mean) mean = graph::Texture(context.device(), sum.desc(), "frame.mean");
    const double before = nowMs();
    if (Status s =
            runGraph([&](graph::FrameGraph& graph) { return recordMean(graph, import(graph, scratch)); });
        !s)
        return s;
    workMs += nowMs() - before;
    std::swap(mean, scratch);
    averaged = true;
    return Done{};
}

Result<Progress> Renderer::State::advance(const scene::Scene& asked, std::uint64_t newRevision, ivec2 newSize,
                                          Effort effort) {
    const double begins = nowMs();
    if (!started || revision != newRevision || size != newSize || (coarse && effort != Effort::Coarse)) {
        if (Status kept = keepFor(asked); !kept) return kept.error();
        start(asked, newRevision, newSize, effort);
    }
    const bool isLate = !atOnce && nowMs() - begins > 0.25 * kSliceMs; // the scene's shapes were made
    const scene::Scene& scene = *pictured;
    if (dragged && effort != Effort::Coarse) { // the preview was the picture already
        const bool over = complete();
        dragged = false;
        addSamples(scene);
        if (over) startStage();
    }
    if (!isLate && (running || !complete() || whole || !settled(effort))) {
        Status status = Done{};
        if (running)
            ; // goes on
        else if ((complete() || whole) && !settled(effort))
            status = settle(scene);
        else if (!whole)
            status = stage < stages.size() ? slice(scene) : plan(scene);
        if (status) status = work(begins + kSliceMs);
        if (status && !running && whole && settled(effort)) status = takeSample(scene);
        if (!status) {
            drop();
            started = false;
            return status.error();
        }
    }
    Progress progress = progressOf(scene, effort);
    // Estimates vary. A preview that was whole has said all of the task.
    if (progress.task == told.task && !told.complete) progress.share = std::max(progress.share, told.share);
    return told = progress;
}

} // namespace lucent::frame
