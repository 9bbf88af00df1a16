#include "frame/Renderer.h"
#include "measure/BudgetReport.h"
#include "measure/Statistics.h"
#include "scene/Environment.h"
#include "techniques/relief/bench/Bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>

namespace lucent::relief {

namespace {

using namespace measure;
using views::EnvironmentSampling;

// --- scenes

std::shared_ptr<const Image> heights(int side, float (*height)(float, float)) {
    return heightsOf(ivec2(side), [=](int x, int y) {
        return height((float(x) + 0.5f) / float(side), (float(y) + 0.5f) / float(side));
    });
}

// A number in [0,1) that looks random, the same everywhere.
float hashed(int a, int b) {
    auto h = std::uint32_t(a) * 374761393u + std::uint32_t(b) * 668265263u + 1u;
    h = (h ^ (h >> 13)) * 1274126177u;
    return float((h ^ (h >> 16)) & 0xffffff) / float(0x1000000);
}

float craters(float u, float v) {
    float height = 0.6f;
    for (int i = 0; i < 40; ++i) {
        const float radius = 0.03f + 0.12f * hashed(i, 2);
        const float far = std::hypot(u - hashed(i, 0), v - hashed(i, 1)) / radius;
        if (far < 1.4f) height += radius * (far < 1 ? far * far - 0.7f : 0.3f * (1.4f - far) / 0.4f);
    }
    return std::clamp(height, 0.0f, 1.0f);
}

float bricks(float u, float v) {
    const float row = std::floor(8 * v), shift = std::fmod(row, 2.0f) / 2;
    const float across = 4 * u + shift, along = 8 * v;
    const float inX = std::min(across - std::floor(across), std::ceil(across) - across) * 2;
    const float inY = std::min(along - row, row + 1 - along);
    return inX > 0.08f && inY > 0.08f ? 0.7f + 0.3f * hashed(int(std::floor(across)), int(row)) : 0.0f;
}

float cones(float u, float v) {
    const float x = 6 * u - std::floor(6 * u) - 0.5f, y = 6 * v - std::floor(6 * v) - 0.5f;
    return std::max(0.0f, 1 - 2.2f * std::hypot(x, y));
}

float stairs(float u, float v) { return std::floor(7 * (0.7f * u + 0.3f * v)) / 7; }

float ridges(float u, float v) {
    return 0.5f + 0.5f * std::abs(std::fmod(9 * (u + 0.4f * v * v), 2.0f) - 1) - 0.25f * v;
}

std::vector<BenchField> syntheticFields(int side) {
    return {{"craters", heights(side, craters), 0.4f},
            {"bricks", heights(side, bricks), 0.05f},
            {"cones", heights(side, cones), 0.15f},
            {"stairs", heights(side, stairs), 0.3f},
            {"ridges", heights(side, ridges), 0.12f}};
}

// Two lamps as wide as a hand at arm's length, in a dark hall.
std::shared_ptr<const Image> hall() {
    auto map = std::make_shared<Image>(256, 128, 3);
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 256; ++x) {
            const bool warm = std::hypot(float(x) - 60, float(y) - 40) < 7;
            const bool cold = std::abs(x - 190) < 12 && std::abs(y - 30) < 5;
            const vec3 color = warm ? vec3(40, 30, 18) : cold ? vec3(12, 18, 30) : vec3(0.15f);
            std::copy_n(&color[0], 3, map->at(x, y));
        }
    }
    return map;
}

struct Lighting {
    std::string name;
    std::function<void(scene::Scene&)> light;
};

std::vector<Lighting> lightings(const std::vector<BenchEnvironment>& environments) {
    std::vector<Lighting> list;
    const auto under = [&](const std::string& name, std::shared_ptr<const Image> map, vec3 rotation) {
        list.push_back({name, [=](scene::Scene& scene) {
                            scene.environment.emplace();
                            scene.environment->map = map;
                            scene.environment->rotation = rotation;
                        }});
    };
    for (const BenchEnvironment& environment : environments)
        under(environment.name, environment.map, {60, 25, 0});
    under("hall", std::make_shared<const Image>(*hall()), {80, 0, 15});
    under("rainbow", std::make_shared<const Image>(scene::proceduralEnvironment("rainbow")), {30, 70, 0});
    list.push_back({"wide sun", [](scene::Scene& scene) {
                        scene::DistantLight sun;
                        sun.direction = {-0.6f, 0.5f, -0.6f};
                        sun.angle = 12;
                        scene.lights.emplace_back(sun);
                    }});
    list.push_back({"bulb", [](scene::Scene& scene) {
                        scene::PointLight bulb;
                        bulb.position = {0.4f, 0.2f, 0.5f};
                        bulb.radius = 0.15f;
                        scene.lights.emplace_back(bulb);
                    }});
    under("bulb and hall", std::make_shared<const Image>(*hall()), {80, 140, 0});
    const auto both = list.back().light;
    list.back().light = [=](scene::Scene& scene) {
        both(scene);
        scene::PointLight bulb;
        bulb.radius = 0.1f;
        bulb.intensity = 0.5f;
        scene.lights.emplace_back(bulb);
    };
    return list;
}

// --- measuring

double now() {
    using namespace std::chrono;
    return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

// All by which a picture of fields trades error for time.
using Means = std::map<std::string, lucent::Settings>;

bool isTransfer(const Means& means) { return means.at("relief").as<Settings>().method == Method::Transfer; }

struct Tried {
    std::string name;
    double ms, error;
    Means means{};
};

constexpr int kTurns = 5; // of a race: medians of five single pictures

class Prover {
public:
    Prover(gl::Context& context, scene::Scene scene) : renderer_(context), scene_(std::move(scene)) {}

    Status solve() {
        views::samplingOf(scene_) = {
            .lamp = 1024, .directions = 8192, .environment = EnvironmentSampling::Importance};
        Result<Image> image = picture();
        if (!image) return image.error();
        exact_ = std::move(*image);
        return Done{};
    }

    // Every setting, until half the smallest wanted error is reached. Beside an environment a lamp gets a
    // sixth as many points: an environment is what costs.
    Status tryAll() {
        const bool environment = scene_.environment.has_value(), lamps = !scene_.lights.empty();
        const auto enough = [&](double error) { return error < 0.5 * kWantedErrors[3]; };
        for (double count = 8; count <= 1024.5; count *= std::sqrt(2.0)) {
            double nearest = 1e30;
            for (auto sampling : {EnvironmentSampling::Equal, EnvironmentSampling::Importance}) {
                if (!environment && sampling != EnvironmentSampling::Equal) continue;
                for (int points : lampCounts(lamps, environment, count)) {
                    const Result<Tried> tried = attempt(sampling, int(std::lround(count)), points);
                    if (!tried) return tried.error();
                    nearest = std::min(nearest, tried->error);
                    tried_.push_back(*tried);
                }
            }
            if (enough(nearest)) break;
        }
        if (!environment) return Done{};
        settingsOf(scene_).method = Method::Transfer;
        settingsOf(scene_).terms = kMostTerms;
        scene_.quality.maxError = 0;
        Result<Tried> tried = measure("transfer");
        if (!tried) return tried.error();
        tried->means = scene_.technique;
        settingsOf(scene_).method = Method::Hierarchy;
        tried_.push_back(*tried);
        return Done{};
    }

    Result<BudgetResult> budget(float wanted) {
        renderer_.release(); // a transfer that is there already would be chosen for nothing
        scene_.quality.maxError = wanted;
        const Result<Tried> tried = measure("");
        scene_.quality.maxError = 0;
        if (!tried) return tried.error();
        const frame::Stats stats = renderer_.stats();
        BudgetResult result;
        result.wanted = wanted;
        result.chosen = stats.settings;
        result.predicted = stats.predicted;
        result.error = tried->error;
        result.planMs = stats.planMilliseconds;
        result.ms = tried->ms - result.planMs;
        const Tried* best = nullptr;
        for (const Tried& one : tried_)
            if (one.error <= wanted && (!best || one.ms < best->ms)) best = &one;
        if (!best) return result;
        result.best = best->name;
        if (Status timed = race(stats.technique, *best, result); !timed) return timed.error();
        return result;
    }

private:
    static std::vector<int> lampCounts(bool lamps, bool environment, double count) {
        if (!lamps) return {1};
        if (!environment) return {int(std::lround(count / 8)), int(std::lround(count / 4))};
        return {int(std::lround(count / 6))};
    }
    Result<Image> picture() {
        if (Status done = renderer_.finish(scene_, ++revision_, scene_.size); !done) return done.error();
        return renderer_.read(scene_, scene::Aov::Color);
    }
    Result<Tried> measure(const std::string& name) {
        const double before = now();
        const Result<Image> image = picture();
        if (!image) return image.error();
        return Tried{name, now() - before, relativeError(*image, exact_), {}};
    }
    // Times what was chosen and the best by turns, so that both have the machine at its warmest and its
    // worst.
    Status race(const Means& chosen, const Tried& best, BudgetResult& result) {
        if (isTransfer(chosen) || isTransfer(best.means)) {
            result.bestMs = best.ms; // made once for many pictures: only the first is measured
            return Done{};
        }
        const Means own = scene_.technique;
        std::vector<double> times[2];
        for (int turn = 0; turn < kTurns; ++turn) {
            for (int side = 0; side < 2; ++side) {
                scene_.technique = side == 0 ? chosen : best.means;
                const double before = now();
                if (const Result<Image> image = picture(); !image) return image.error();
                times[side].push_back(now() - before);
            }
        }
        scene_.technique = own;
        result.ms = spreadOf(times[0]).median;
        result.bestMs = spreadOf(times[1]).median;
        return Done{};
    }
    Result<Tried> attempt(EnvironmentSampling sampling, int directions, int points) {
        views::Sampling& light = views::samplingOf(scene_);
        light = {.lamp = std::max(1, points), .directions = directions, .environment = sampling};
        Result<Tried> tried =
            measure(std::to_string(directions) +
                    (sampling == EnvironmentSampling::Equal ? " evenly, " : " by importance, ") +
                    std::to_string(light.lamp) + " samples a lamp");
        if (tried) tried->means = scene_.technique;
        return tried;
    }

    frame::Renderer renderer_;
    std::uint64_t revision_ = 0;
    scene::Scene scene_;
    Image exact_;
    std::vector<Tried> tried_;
};

} // namespace

Result<Proof> proveBudget(const BenchRun& run) {
    constexpr int kSide = 96, kFieldSide = 128; // pixels, texels
    const auto measured = run.assets.fields({"elevation", "dragon", "coin", "weave", "bunny"}, kFieldSide);
    if (!measured) return measured.error();
    const auto environments = run.assets.environments({"window.exr"});
    if (!environments) return environments.error();
    std::vector<BenchField> fields = syntheticFields(kSide);
    fields.insert(fields.end(), measured->begin(), measured->end());
    const std::vector<Lighting> lights = lightings(*environments);
    BudgetReport report;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        for (std::size_t j = 0; j < lights.size(); ++j) {
            const float depth = 0.004f * std::pow(4.0f, hashed(int(i), int(j)) * 2); // 4 mm to 64 mm
            scene::Scene scene = fieldScene(fields[i], depth);
            const vec2 footprint = scene.objects[0].field().footprint();
            scene.size = ivec2(kSide, std::max(1, int(float(kSide) * footprint.y / footprint.x)));
            scene.view.show = scene::Aov::Color;
            scene.objects[0].material.relief().forwardScatter = j % 3 == 1 ? 0.6f : 0;
            scene.objects[0].material.relief().specularity = (i + j) % 4 == 2 ? 0.4f : 0;
            lights[j].light(scene);
            const std::string name = fields[i].name + " under " + lights[j].name;
            run.say(name);
            Prover prover(run.context, std::move(scene));
            if (Status solved = prover.solve(); !solved) return solved.error();
            if (Status tried = prover.tryAll(); !tried) return tried.error();
            if (Status proved = proveWantedErrors(prover, name, report); !proved) return proved.error();
        }
    }
    return report.proof();
}

} // namespace lucent::relief
