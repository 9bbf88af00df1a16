#include "techniques/throughput/bench/Bench.h"

#include "frame/Renderer.h"
#include "measure/Stopwatch.h"
#include "scene/MaterialPresets.h"
#include "scene/Mesh.h"
#include "technique/Technique.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace lucent::throughput {

namespace {

using namespace measure;

constexpr const char* kName = "throughput";
constexpr float kRadius = 0.01f; // m, of the ball

Setting setting(const char* method, const char* global, const char* blend = "fitted") {
    return {method, {{"global", global}, {"blend", blend}}};
}
const Setting kOurs = setting("live", "hierarchical"), kPapers = setting("stored", "sparse");

// --- scenes

scene::Scene sceneWith(scene::Object object, int size) {
    scene::Scene scene;
    scene.size = ivec2(size);
    scene.camera.eye = {0, 0, 1};
    scene.camera.height = 2.2f * kRadius;
    scene.view.show = scene::Aov::Radiosity;
    technique::addSettings(scene);
    object.material = bakedMarble();
    scene.objects = {std::move(object)};
    scene.lights = {scene::DistantLight{.direction = {-1, 0, 0}}};
    return scene;
}

scene::Scene bakedMesh(const BenchMesh& mesh, int size) {
    scene::Object object = measure::objectOf(mesh);
    object.transform.scale *= kRadius;
    object.transform.translate *= kRadius;
    return sceneWith(std::move(object), size);
}

void showNothing(scene::Scene& scene) {
    scene.view.show = scene::Aov::Color;
    scene.objects.clear();
}

Case caseOf(const std::string& name, const scene::Scene& scene, std::vector<Setting> settings) {
    return {
        .technique = kName,
        .name = name,
        .scene = {[scene]() -> Result<scene::Scene> { return scene; }, double(scene.size.x) * scene.size.y},
        .settings = std::move(settings),
        .toPhysics = {},
        .timed = {[](scene::Scene&) {}, showNothing}};
}

RatioRule misplaced(const std::string& scene, const Setting& of) {
    return [=](const BenchReport& report) -> std::optional<Ratio> {
        const Measurement* m = measured(report, kName, scene, of);
        if (!m) return std::nullopt;
        return Ratio{scene + ": share of the radiosity that " + of.name() + " misplaces",
                     m->error->flux->misplaced, 0.02, false};
    };
}

Status addThroughput(measure::Plan& plan, const BenchAssets& assets) {
    const int size = plan.quick ? 96 : 192;
    std::vector<Setting> settings{kOurs, kPapers, setting("stored", "sparse", "none")};
    if (!plan.quick) settings.push_back(setting("live", "sparse"));
    const auto add = [&](const std::string& name, const scene::Scene& scene) {
        plan.cases.push_back(caseOf(name, scene, settings));
        for (const Setting& one : {kOurs, kPapers})
            plan.ratios.push_back(misplaced(name, one));
    };
    add("baked ball", bakedBall(plan.quick ? 48 : 90, size));
    const auto bunny = assets.meshes({"bunny"});
    if (!bunny) return bunny.error();
    for (const BenchMesh& mesh : *bunny)
        if (!plan.quick) add("baked " + mesh.name, bakedMesh(mesh, size));
    return Done{};
}

// --- table 1

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Result<double> millisecondsOf(gl::Context& context, const scene::Scene& scene, const Repeats& repeats) {
    scene::Scene nothing = scene;
    showNothing(nothing);
    frame::Renderer renderer(context), empty(context);
    std::uint64_t revision = 0;
    const auto draw = [&](frame::Renderer& by, const scene::Scene& what) {
        return [&by, &what, &revision]() -> Status {
            if (Status done = by.finish(what, ++revision, what.size); !done) return done;
            const Result<Image> image = by.read(what, what.view.show);
            return image ? Status(Done{}) : Status(image.error());
        };
    };
    Stopwatch stopwatch(context, draw(renderer, scene), draw(empty, nothing), repeats);
    for (;;) {
        const Result<bool> done = stopwatch.step();
        if (!done) return done.error();
        if (*done) return stopwatch.spread().median;
    }
}

// The paper's way from the illumination map to what leaves, on one core.
struct Stages {
    double bakeSeconds = 0, vertices = 0, global = 0, all = 0; // ms
    std::size_t factors = 0, bytes = 0;
};
Result<Stages> stagesOf(const scene::Object& object, const BakeOptions& options) {
    Stages stages;
    auto start = std::chrono::steady_clock::now();
    const auto baked = bakeOf(object, options);
    if (!baked) return baked.error();
    stages.bakeSeconds = secondsSince(start);
    const Bake& bake = **baked;
    stages.factors = bake.factors.kept();
    stages.bytes = bake.bytes();
    std::vector<vec3> light;
    for (const Texel& texel : bake.surface.texels.list)
        light.push_back(vec3(std::max(0.0f, normalAt(bake.surface.hats, texel.place).x)));
    start = std::chrono::steady_clock::now();
    const std::vector<vec3> vertices = bake.vertexIrradiance(light);
    stages.vertices = 1000 * secondsSince(start);
    start = std::chrono::steady_clock::now();
    (void)bake.factors.product(vertices);
    stages.global = 1000 * secondsSince(start);
    start = std::chrono::steady_clock::now();
    (void)bake.relight(light);
    stages.all = 1000 * secondsSince(start);
    return stages;
}

void addStages(const std::string& of, const Stages& stages, std::vector<Ratio>& ratios) {
    ratios.push_back({of + ": bake, s", stages.bakeSeconds, {}, false});
    ratios.push_back({of + ": factors kept", double(stages.factors), {}, false});
    ratios.push_back({of + ": MiB of factors", double(stages.bytes) / (1 << 20), {}, false});
    ratios.push_back({of + ": ms of vertex irradiance on a core", stages.vertices, {}, false});
    ratios.push_back({of + ": ms of the global response on a core", stages.global, {}, false});
    ratios.push_back({of + ": ms of local and global response on a core", stages.all, {}, false});
}

Status addModel(const BenchRun& run, int segments, std::vector<Ratio>& ratios) {
    const Repeats repeats = run.quick ? Repeats{3, 5, 30} : Repeats{5, 15, 1000};
    scene::Scene scene = bakedBall(segments, 128);
    const std::size_t vertices = hatsOf(*scene::meshOf(scene.objects[0]), 1).count();
    const std::string name = "ball of " + std::to_string(vertices) + " vertices";
    run.say(name);
    BakeOptions papers{.local = Local::Stored};
    papers.factors.method = Global::Sparse;
    const Result<Stages> sparse = stagesOf(scene.objects[0], papers);
    if (!sparse) return sparse.error();
    addStages(name + ", stored, sparse", *sparse, ratios);
    double own = sparse->all;
    if (!run.quick) {
        papers.factors.method = Global::Dense;
        const Result<Stages> dense = stagesOf(scene.objects[0], papers);
        if (!dense) return dense.error();
        addStages(name + ", stored, dense", *dense, ratios);
        own = dense->all;
        scene.objects[0].kept = {}; // a gigabyte
    }
    const Result<Stages> ours = stagesOf(scene.objects[0], {});
    if (!ours) return ours.error();
    addStages(name + ", live, hierarchical", *ours, ratios);
    const Result<double> ms = millisecondsOf(run.context, scene, repeats);
    if (!ms) return ms.error();
    scene::Scene live = scene;
    live.objects[0].material.translucent().precomputed = false;
    const Result<double> liveMs = millisecondsOf(run.context, live, repeats);
    if (!liveMs) return liveMs.error();
    // The paper's frame is its scheme, and the map and the picture drawn as ours are.
    static_cast<Settings*>(live.technique.at("throughput").data())->part = Part::Illumination;
    live.objects[0].material.translucent().precomputed = true;
    const Result<double> mapMs = millisecondsOf(run.context, live, repeats);
    if (!mapMs) return mapMs.error();
    const bool isLarge = vertices > 9000;
    ratios.push_back({name + ": ms of a picture, live, hierarchical", *ms, {}, false});
    ratios.push_back({name + ": ms of a picture not precomputed", *liveMs, {}, false});
    ratios.push_back({name + ": ms of a picture of its illumination map", *mapMs, {}, false});
    ratios.push_back({name + ": a frame of the paper's scheme on a core over one of ours",
                      (own + *mapMs) / *ms, isLarge && !run.quick ? std::optional(5.0) : std::nullopt, true});
    ratios.push_back({name + ": seconds of the bake", ours->bakeSeconds,
                      isLarge ? std::optional(30.0) : std::nullopt, false});
    if (*liveMs > *ms)
        ratios.push_back({name + ": pictures after which the bake has paid",
                          std::ceil(1000 * ours->bakeSeconds / (*liveMs - *ms)),
                          {},
                          false});
    else
        ratios.push_back({name + ": ms that a picture takes longer for its bake, which never pays",
                          *ms - *liveMs,
                          {},
                          false});
    return Done{};
}

// Around the place where the light grazes, far from which it enters: degrees from the light, which comes from
// the right.
constexpr double kFromLight = 80, kToLight = 120;

double degreesAt(int x, int width) {
    const double across = ((x + 0.5) / width - 0.5) * 2.2;
    return glm::degrees(std::acos(std::clamp(across, -1.0, 1.0)));
}

Status addGrazed(const BenchRun& run, std::vector<Ratio>& ratios) {
    const scene::Scene scene = bakedBall(run.quick ? 48 : 90, run.quick ? 96 : 192);
    const Result<truth::Picture> exact = run.solve(scene, 0, {});
    if (!exact) return exact.error();
    frame::Renderer renderer(run.context);
    if (Status drawn = renderer.finish(scene, 1, scene.size); !drawn) return drawn.error();
    const Result<Image> image = renderer.read(scene, scene.view.show);
    if (!image) return image.error();
    double apart = 0, whole = 0;
    for (int y = 0; y < image->height; ++y)
        for (int x = 0; x < image->width; ++x) {
            const double degrees = degreesAt(x, image->width);
            if (!(image->at(x, y)[3] > 0) || degrees < kFromLight || degrees > kToLight) continue;
            for (int c = 0; c < 3; ++c) {
                const double wanted = double(exact->values.at(x, y)[c]);
                apart += std::abs(double(image->at(x, y)[c]) - wanted) / 2;
                whole += wanted;
            }
        }
    ratios.push_back({"baked ball: share of the radiosity that is misplaced 80 to 120 degrees from the light",
                      apart / whole, 0.05, false});
    return Done{};
}

// The paper's table 1 and when a bake has paid beside pictures that need none.
Result<Proof> proveThroughput(const BenchRun& run) {
    std::vector<Ratio> ratios;
    const std::vector<int> segments = run.quick ? std::vector{48} : std::vector{90, 132, 143};
    for (const int one : segments)
        if (Status s = addModel(run, one, ratios); !s) return s.error();
    if (Status s = addGrazed(run, ratios); !s) return s.error();
    return Proof{ratios};
}

constexpr BenchPart kParts[] = {{.name = "throughput",
                                 .help = "what leaves bodies whose subsurface scattering is precomputed",
                                 .plan = addThroughput,
                                 .prove = proveThroughput}};

} // namespace

scene::Material bakedMarble() {
    scene::Translucent inside;
    for (const scene::MaterialPreset& preset : scene::materialPresets())
        if (preset.name == "marble") apply(preset, inside);
    inside.precomputed = true;
    scene::Material material;
    material.kind = inside;
    return material;
}

scene::Scene bakedBall(int segments, int size) {
    scene::MeshShape shape;
    shape.mesh = std::make_shared<const scene::Mesh>(scene::meshOf(scene::Sphere{kRadius}, segments));
    scene::Object object;
    object.name = "body";
    object.shape = shape;
    return sceneWith(object, size);
}

extern const TechniqueBench kBench;
const TechniqueBench kBench{kParts};

} // namespace lucent::throughput
