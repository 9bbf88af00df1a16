#include "techniques/relief/bench/Bench.h"

#include "scene/Environment.h"

#include <algorithm>
#include <cmath>

namespace lucent::relief {

namespace {

using namespace measure;

constexpr float kDepth = 0.03f;  // m, of a field 1 m wide
constexpr int kManyLights = 256; // what a projection is measured against

// --- methods and knobs, a line each

std::vector<Setting> reliefSettings(bool quick) {
    std::vector<Setting> settings{
        {"hierarchy"},
        {"march", {{"steps", "16"}}},
        {"march", {{"steps", "64"}}},
        {"march", {{"steps", "256"}}},
        {"counting", {{"steps", "256"}}, true},
    };
    if (!quick) settings.push_back({"march", {{"steps", "1024"}}});
    return settings;
}

std::vector<Setting> environmentSettings(bool quick) {
    const std::pair<std::string, std::string> kEvenly{"sampling.environmentSampling", "equal"};
    const std::pair<std::string, std::string> kByImportance{"sampling.environmentSampling", "importance"};
    std::vector<Setting> settings{
        {"hierarchy", {{"sampling.directions", "16"}, kEvenly}},
        {"hierarchy", {{"sampling.directions", "64"}, kEvenly}},
        {"hierarchy", {{"sampling.directions", "256"}, kEvenly}},
        {"hierarchy", {{"sampling.directions", "64"}, kByImportance}},
        {.method = "transfer", .knobs = {{"terms", "16"}}, .bakes = true},
        {.method = "transfer", .knobs = {{"terms", "64"}}, .bakes = true},
    };
    if (quick) return settings;
    settings.push_back({"hierarchy", {{"sampling.directions", "1024"}, kEvenly}});
    settings.push_back({"hierarchy", {{"sampling.directions", "256"}, kByImportance}});
    settings.push_back({.method = "transfer", .knobs = {{"terms", "128"}}, .bakes = true});
    return settings;
}

const std::vector<Setting> kHardSettings{
    {"hierarchy"},
    {"march", {{"steps", "256"}}},
    {"counting", {{"steps", "256"}}},
};

// --- scenes

// Lights from low to high and from all around, the same for every field and method.
std::vector<scene::Light> rig(int count) {
    std::vector<scene::Light> lights;
    for (int i = 0; i < count; ++i) {
        const float elevation = glm::radians(15.0f + 60.0f * float(i) / float(std::max(1, count - 1)));
        const float azimuth = glm::radians(40.0f + 97.0f * float(i));
        scene::DistantLight light;
        light.direction = -vec3(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        lights.push_back(light);
    }
    return lights;
}

scene::Scene litScene(const BenchField& field, int lights) {
    scene::Scene scene = fieldScene(field, kDepth);
    scene.lights = rig(lights);
    return scene;
}

MakeScene litNoise(int texels, int pixels, int lights) {
    return {[=]() -> Result<scene::Scene> {
                scene::Scene scene = litScene(benchNoise(texels), lights);
                scene.size = ivec2(pixels);
                return scene;
            },
            double(pixels) * pixels* lights};
}

Case reliefCase(const BenchField& field, bool quick) {
    constexpr int kLights = 4;
    const ivec2 size = field.heights->size();
    return {.technique = "relief",
            .name = field.name,
            .scene = {[field]() -> Result<scene::Scene> { return litScene(field, kLights); },
                      double(size.x) * size.y* kLights},
            .settings = reliefSettings(quick),
            // An opaque surface: Lambert's law with exact shadows is the model's own limit for no depth.
            .toPhysics = [](scene::Scene& scene) { scene.objects[0].material.relief().depth = 1e-6f; }};
}

Case environmentCase(const BenchEnvironment& environment, int texels, int directions, bool quick) {
    const auto make = [=]() -> Result<scene::Scene> {
        scene::Scene scene = fieldScene(benchNoise(texels), kDepth);
        scene.view.show = scene::Aov::Color;
        scene.environment.emplace();
        scene.environment->source = environment.name;
        scene.environment->map = environment.map;
        return scene;
    };
    return {.technique = "relief",
            .name = environment.name,
            .scene = {make, double(texels) * texels * directions},
            .settings = environmentSettings(quick),
            .toPhysics = {}};
}

std::vector<Series> reliefSeries(bool quick) {
    const Setting hierarchy{"hierarchy"};
    Series texels{"relief", "texels", hierarchy, {}};
    for (int size : {512, 1024, 2048, 4096})
        if (!quick || size <= 2048)
            texels.points.push_back({double(size) * size, litNoise(size, size, quick ? 1 : 4)});
    Series pixels{"relief", "pixels", hierarchy, {}};
    for (int size : {128, 256, 512, 1024})
        if (!quick || size <= 512) pixels.points.push_back({double(size) * size, litNoise(512, size, 2)});
    Series lights{"relief", "lights", hierarchy, {}};
    for (int count : {1, 2, 4, 8, 16})
        lights.points.push_back({double(count), litNoise(256, 256, count)});
    return {texels, pixels, lights};
}

// --- promises

using Found = const Measurement*;

template <class Test>
Found quickest(const BenchReport& report, const std::string& scene, Test test) {
    Found best = nullptr;
    for (const Measurement& m : report.measurements)
        if (m.scene == scene && m.ms && m.error && test(m) && (!best || m.ms->median < best->ms->median))
            best = &m;
    return best;
}

// The method with this knob and no other.
bool isSetting(const Measurement& m, const std::string& method, const std::string& knob, int value) {
    return m.method == method && m.knobs.size() == 1 &&
           m.knobs.front() == std::pair(knob, std::to_string(value));
}

// How much quicker the quickest setting of hierarchy is that is at least as near as march with these steps.
RatioRule againstMarch(const std::string& scene, int steps) {
    return [=](const BenchReport& report) -> std::optional<Ratio> {
        const Found march = quickest(
            report, scene, [&](const Measurement& m) { return isSetting(m, "march", "steps", steps); });
        if (!march) return std::nullopt;
        const Found ours = quickest(report, scene, [&](const Measurement& m) {
            return m.method == "hierarchy" && m.error->rmse <= march->error->rmse;
        });
        if (!ours) return std::nullopt;
        Ratio ratio{"hierarchy against march at " + std::to_string(steps) + " steps, " + scene,
                    march->ms->median / ours->ms->median,
                    {},
                    true};
        if (steps == 256) ratio.target = 10;
        return ratio;
    };
}

// Cost of a texel on the largest field over that on the smallest.
std::optional<Ratio> costOfATexel(const BenchReport& report) {
    for (const ScalingSeries& series : report.scaling) {
        if (series.over != "texels" || series.points.size() < 2) continue;
        const dvec2 small = series.points.front(), large = series.points.back();
        const auto side = [](const dvec2& point) {
            return std::to_string(std::lround(std::sqrt(point.x))) + "^2";
        };
        Ratio ratio{"cost of a texel at " + side(large) + " over " + side(small),
                    large.y / large.x / (small.y / small.x),
                    {},
                    false};
        if (large.x == 4096.0 * 4096) ratio.target = 2;
        return ratio;
    }
    return std::nullopt;
}

constexpr double kNearEnough = 0.01; // RMSE over the mean that a projection must keep

Found nearest(const BenchReport& report, const std::string& scene, const std::string& method) {
    Found best = nullptr;
    for (const Measurement& m : report.measurements)
        if (m.scene == scene && m.method == method && m.ms && m.error &&
            (!best || m.error->relRmse < best->error->relRmse))
            best = &m;
    return best;
}

RatioRule transferError(const std::string& scene) {
    return [=](const BenchReport& report) -> std::optional<Ratio> {
        const Found transfer = nearest(report, scene, "transfer");
        if (!transfer) return std::nullopt;
        return Ratio{"transfer: RMSE over the mean, " + scene, transfer->error->relRmse, kNearEnough, false};
    };
}

// By the quickest setting that is near enough, else by the nearest there is. The promise is about pictures
// that are not so small that starting a pass takes most of the time.
RatioRule transferSpeed(const std::string& scene, bool isPromised) {
    return [=](const BenchReport& report) -> std::optional<Ratio> {
        const Found sum = quickest(report, scene, [](const Measurement& m) {
            return isSetting(m, "hierarchy", "sampling.directions", kManyLights);
        });
        Found transfer = quickest(report, scene, [](const Measurement& m) {
            return m.method == "transfer" && m.error->relRmse <= kNearEnough;
        });
        if (!transfer) transfer = nearest(report, scene, "transfer");
        if (!sum || !transfer) return std::nullopt;
        Ratio ratio{"transfer against " + std::to_string(kManyLights) + " lights by hierarchy, " + scene,
                    sum->ms->median / transfer->ms->median,
                    {},
                    true};
        if (isPromised) ratio.target = 300;
        return ratio;
    };
}

Status addReliefs(Plan& plan, const BenchAssets& assets) {
    Result<std::vector<BenchField>> fields = assets.fields({"elevation", "dragon"}, plan.quick ? 256 : 4096);
    if (!fields) return fields.error();
    fields->insert(fields->begin(), benchNoise(plan.quick ? 256 : 512));
    for (const BenchField& field : *fields) {
        plan.cases.push_back(reliefCase(field, plan.quick));
        for (int steps : {64, 256, 1024})
            plan.ratios.push_back(againstMarch(field.name, steps));
    }
    return Done{};
}

Status addEnvironments(Plan& plan, const BenchAssets& assets) {
    std::vector<BenchEnvironment> environments;
    for (const char* name : {"rainbow", "sky"})
        environments.push_back({name, std::make_shared<const Image>(scene::proceduralEnvironment(name))});
    const Result<std::vector<BenchEnvironment>> found = assets.environments({"sunset.hdr"});
    if (!found) return found.error();
    environments.insert(environments.end(), found->begin(), found->end());
    for (const BenchEnvironment& environment : environments) {
        plan.cases.push_back(
            environmentCase(environment, plan.quick ? 32 : 128, plan.directions, plan.quick));
        plan.ratios.push_back(transferError(environment.name));
        plan.ratios.push_back(transferSpeed(environment.name, !plan.quick));
    }
    return Done{};
}

Status addScaling(Plan& plan, const BenchAssets&) {
    const std::vector<Series> series = reliefSeries(plan.quick);
    plan.series.insert(plan.series.end(), series.begin(), series.end());
    plan.ratios.push_back(costOfATexel);
    return Done{};
}

Status addHard(Plan& plan, const BenchAssets&) {
    plan.hard.push_back({"relief", hardCases(plan.quick), kHardSettings});
    return Done{};
}

constexpr BenchPart kParts[] = {
    {"relief", "methods against each other under distant lights", true, addReliefs},
    {"environment", "sums of light samples and projections under environments", true, addEnvironments},
    {"scaling", "time over texels, pixels and lights", true, addScaling},
    {"hard", "scenes on which methods tend to break", true, addHard},
    {.name = "budget", .help = "proof of quality.maxError on reliefs: half an hour", .prove = proveBudget},
};

} // namespace

extern const TechniqueBench kBench;
const TechniqueBench kBench{kParts};

} // namespace lucent::relief
