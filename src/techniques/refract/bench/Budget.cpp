#include "frame/Renderer.h"
#include "measure/BudgetReport.h"
#include "measure/Solve.h"
#include "measure/Statistics.h"
#include "scene/Environment.h"
#include "technique/Technique.h"
#include "techniques/refract/Refract.h"
#include "techniques/refract/bench/Bench.h"

namespace lucent::refract {

namespace {

using namespace measure;

// --- scenes

scene::Object glass(scene::Shape shape, float ior, vec3 translate = vec3(0), vec3 rotate = vec3(0)) {
    scene::Object object;
    object.shape = std::move(shape);
    object.material.kind = scene::Clear{.ior = ior};
    object.transform.translate = translate;
    object.transform.rotate = rotate;
    return object;
}

struct GlassScene {
    const char* name;
    std::vector<scene::Object> objects;
};

std::vector<GlassScene> glassScenes() {
    const scene::Object ball = glass(scene::Sphere{1}, 1.5f);
    const scene::Object ring = glass(scene::Torus{0.8f, 0.3f}, 1.45f, {0, 0, 0}, {55, 0, 15});
    std::vector<scene::Object> slabs, row, cluster, bubbles{glass(scene::Box{{2, 1.6f, 1.2f}}, 1.4f)};
    for (int i = 0; i < 4; ++i) {
        slabs.push_back(glass(scene::Box{{1.4f, 1, 0.1f}}, 1.3f + 0.1f * float(i),
                              {0.15f * float(i), 0, -0.4f * float(i)}, {0, 20, 5 * float(i)}));
        row.push_back(
            glass(scene::Sphere{0.45f}, 1.33f, {0.25f * float(i) - 0.4f, 0.1f * float(i), -float(i)}));
    }
    for (int i = 0; i < 9; ++i)
        cluster.push_back(
            glass(scene::Sphere{0.3f}, 1.5f,
                  {0.4f * float(i % 3) - 0.4f, 0.4f * float(i / 3) - 0.4f, 0.7f * float(i * 5 % 3) - 0.7f}));
    for (int i = 0; i < 5; ++i)
        bubbles.push_back(glass(scene::Sphere{0.2f}, 1,
                                {0.35f * float(i) - 0.7f, 0.15f * float(i * 3 % 4) - 0.3f, 0.1f * float(i)}));
    scene::Object waved = glass(scene::Box{{2, 0.5f, 1.5f}}, 1.5f, {0, 0, 0}, {25, 30, 0});
    waved.wave = {.amplitude = {0, 0.12f, 0}, .direction = {1, 0, 0.4f}, .wavelength = 0.7f};
    std::vector<GlassScene> scenes{
        {"ball", {ball}},
        {"ring", {ring}},
        {"ball in a ball", {ball, glass(scene::Sphere{0.6f}, 1.2f, {0.1f, 0.1f, 0})}},
        {"hollow ball", {ball, glass(scene::Sphere{0.9f}, 1)}},
        {"four slabs", slabs},
        {"four balls in a row", row},
        {"two rings", {ring, glass(scene::Torus{0.7f, 0.2f}, 1.6f, {0.5f, 0, 0}, {0, 20, 80})}},
        {"nine balls", cluster},
        {"block with five bubbles", bubbles},
        {"waved block", {waved}}};
    for (GlassScene& one : scenes)
        for (std::size_t i = 0; i < one.objects.size(); ++i)
            one.objects[i].name = "glass " + std::to_string(i);
    return scenes;
}

scene::Scene sceneOf(const GlassScene& of, std::shared_ptr<const Image> map, int side) {
    scene::Scene scene;
    scene.size = ivec2(side);
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {0.4f, 0.5f, 3};
    scene.camera.fov = 45;
    scene.objects = of.objects;
    scene.environment.emplace();
    scene.environment->map = std::move(map);
    technique::addSettings(scene);
    return scene;
}

// --- measuring

constexpr int kLayers[] = {2, 4, 8, 16, views::kMostLayers};
constexpr int kTurns = 5; // of a race: medians of five single pictures

Settings& settingsOf(scene::Scene& scene) {
    return *static_cast<Settings*>(scene.technique.at("refract").data());
}

class Prover {
public:
    Prover(gl::Context& context, scene::Scene scene) : renderer_(context), scene_(std::move(scene)) {}

    /// The exact picture, and by how much every choice misses it.
    Status tryAll() {
        Result<truth::Picture> exact = solveWhatIsShown(scene_, 0, {}, 0);
        if (!exact) return exact.error();
        exact_ = std::move(exact->values);
        for (const int layers : kLayers) {
            settingsOf(scene_).maxLayers = layers;
            Result<double> error = this->error();
            if (!error) return error.error();
            errors_.push_back(*error);
        }
        settingsOf(scene_).maxLayers = views::kMostLayers;
        return Done{};
    }

    Result<BudgetResult> budget(float wanted) {
        scene_.quality.maxError = wanted;
        const Result<double> error = this->error();
        scene_.quality.maxError = 0;
        if (!error) return error.error();
        const frame::Stats stats = renderer_.stats();
        BudgetResult result;
        result.wanted = wanted;
        result.chosen = stats.settings;
        result.predicted = stats.predicted;
        result.error = *error;
        result.planMs = stats.planMilliseconds;
        result.ms = stats.milliseconds - stats.planMilliseconds;
        for (std::size_t i = 0; i < errors_.size() && result.best.empty(); ++i)
            if (errors_[i] <= wanted) { // fewer layers are quicker
                result.best = std::to_string(kLayers[i]) + " layers";
                const int chosen = stats.technique.at("refract").as<Settings>().maxLayers;
                if (Status raced = race(chosen, kLayers[i], result); !raced) return raced.error();
            }
        return result;
    }

private:
    Status draw() { return renderer_.finish(scene_, ++revision_, scene_.size); }
    Result<double> error() {
        if (Status drawn = draw(); !drawn) return drawn.error();
        const Result<Image> image = renderer_.read(scene_, scene::Aov::Color);
        if (!image) return image.error();
        return relativeError(*image, exact_);
    }
    // Times what was chosen and the best by turns.
    Status race(int chosen, int best, BudgetResult& result) {
        std::vector<double> times[2];
        for (int turn = 0; turn <= kTurns; ++turn)
            for (int side = 0; side < 2; ++side) {
                settingsOf(scene_).maxLayers = side == 0 ? chosen : best;
                if (Status drawn = draw(); !drawn) return drawn;
                if (turn > 0) times[side].push_back(renderer_.stats().milliseconds);
            }
        settingsOf(scene_).maxLayers = views::kMostLayers;
        result.ms = spreadOf(times[0]).median;
        result.bestMs = spreadOf(times[1]).median;
        return Done{};
    }

    frame::Renderer renderer_;
    std::uint64_t revision_ = 0;
    scene::Scene scene_;
    Image exact_;
    std::vector<double> errors_; // of kLayers
};

} // namespace

Result<Proof> proveBudget(const BenchRun& run) {
    constexpr int kSize = 96; // pixels
    const auto window = run.assets.environments({"window.exr"});
    if (!window) return window.error();
    std::vector<BenchEnvironment> all = *window;
    all.push_back({"rainbow", std::make_shared<const Image>(scene::proceduralEnvironment("rainbow"))});
    BudgetReport report;
    report.what = "scenes of glass";
    for (const GlassScene& one : glassScenes())
        for (const BenchEnvironment& environment : all) {
            const std::string name = std::string(one.name) + " under " + environment.name;
            run.say(name);
            Prover prover(run.context, sceneOf(one, environment.map, kSize));
            if (Status tried = prover.tryAll(); !tried) return tried.error();
            if (Status proved = proveWantedErrors(prover, name, report); !proved) return proved.error();
        }
    return report.proof();
}

} // namespace lucent::refract
