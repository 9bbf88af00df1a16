#include "techniques/refract/bench/Bench.h"

#include "scene/Environment.h"
#include "technique/Technique.h"
#include "techniques/refract/bench/DepthNormals.h"

#include <cassert>

namespace lucent::refract {

namespace {

using namespace measure;

constexpr float kIor = 1.5f;

// --- methods and knobs

using Knobs = std::vector<std::pair<std::string, std::string>>;

Setting with(Setting setting, const Knobs& knobs) {
    setting.knobs.insert(setting.knobs.end(), knobs.begin(), knobs.end());
    return setting;
}

// The thesis's way: slices, five halvings, normals from depths.
Setting voxels(const Knobs& knobs = {}) {
    return with({"voxels", {{"layers", "voxels"}, {"trace", "bisection"}, {"normals", "delta1"}}}, knobs);
}
// Its cheap end: the first and the last surface.
Setting twoSurfaces() {
    return {"two surfaces", {{"layers", "front-back"}, {"trace", "bisection"}, {"normals", "delta1"}}};
}
Setting peelBisected(const Knobs& knobs = {}) {
    return with({"peel and bisection", {{"trace", "bisection"}}}, knobs);
}

constexpr const char* kLayerCounts[] = {"2", "4", "8", "16", "32"};

// Ours first: all layers that there are, and at most so many.
std::vector<Setting> refractSettings() {
    std::vector<Setting> settings{{"peel"}};
    for (const char* layers : kLayerCounts)
        settings.push_back({"peel", {{"maxLayers", layers}}});
    settings.push_back(twoSurfaces());
    for (const char* slices : {"256", "512"})
        settings.push_back(voxels({{"slices", slices}}));
    settings.push_back(voxels({{"bounds", "global"}}));
    settings.push_back(voxels({{"peeling", "on-the-fly"}}));
    for (const char* layers : kLayerCounts)
        settings.push_back(peelBisected({{"maxLayers", layers}}));
    for (const char* normals : {"neighbours", "delta1", "delta2"})
        settings.push_back(peelBisected({{"normals", normals}}));
    return settings;
}

// --- scenes

scene::Scene emptyScene(int size) {
    scene::Scene scene;
    scene.size = ivec2(size);
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {0, 0.6f, 3};
    scene.camera.target = {0, 0, 0};
    scene.camera.fov = 45;
    scene.view.show = scene::Aov::Direction;
    scene.environment.emplace();
    scene.environment->source = "rainbow";
    scene.environment->map = std::make_shared<const Image>(scene::proceduralEnvironment("rainbow"));
    technique::addSettings(scene);
    return scene;
}

void addGlass(scene::Scene& scene, const std::string& name, scene::Shape shape, float ior = kIor,
              vec3 rotate = vec3(0)) {
    scene::Object& object = scene.objects.emplace_back();
    object.name = name;
    object.shape = std::move(shape);
    object.transform.rotate = rotate;
    object.material.kind = scene::Clear{.ior = ior};
}

// Shapes whose exact surface is known. The inner ball of "nested" is of thinner glass than what is around it.
scene::Scene sphereScene(int size) {
    scene::Scene scene = emptyScene(size);
    addGlass(scene, "ball", scene::Sphere{1});
    return scene;
}
scene::Scene torusScene(int size) {
    scene::Scene scene = emptyScene(size);
    addGlass(scene, "ring", scene::Torus{0.8f, 0.35f}, kIor, {50, 0, 20});
    return scene;
}
scene::Scene boxScene(int size) {
    scene::Scene scene = emptyScene(size);
    addGlass(scene, "block", scene::Box{vec3(1.2f)}, kIor, {25, 35, 0});
    return scene;
}
scene::Scene nestedScene(int size) {
    scene::Scene scene = emptyScene(size);
    addGlass(scene, "ball", scene::Sphere{1});
    addGlass(scene, "core", scene::Sphere{0.5f}, 1.2f);
    return scene;
}

scene::Scene glassScene(const BenchMesh& mesh, int size) {
    scene::Scene scene = emptyScene(size);
    scene.objects = {objectOf(mesh)};
    scene.objects.front().material.kind = scene::Clear{.ior = kIor};
    return scene;
}

// --- what is timed

void showColor(scene::Scene& scene) { scene.view.show = scene::Aov::Color; }
void showLayers(scene::Scene& scene) { scene.view.show = scene::Aov::Layers; }
void showNothing(scene::Scene& scene) {
    showColor(scene);
    scene.objects.clear();
}

// The picture that counts the layers draws the same ones and follows no ray: the finished frame falls apart
// in two stages by it, and counting, which is little, goes to the layers.
const Timed kFrame{showColor, showNothing};
const Timed kLayersStage{showLayers, showNothing};
const Timed kTraceStage{showColor, showLayers};

// The thesis's stages (its table 4.2): a picture that counts surfaces by what one stage leaves, less one that
// counts them by what the stage before it leaves. Counting itself is a few looks at a texel.
std::function<void(scene::Scene&)> counting(const Setting& setting) {
    return [setting](scene::Scene& scene) {
        [[maybe_unused]] const Status set = setting.putInto(scene, "refract");
        assert(set);
        showLayers(scene);
    };
}
Setting bitsOnly() { return voxels({{"peeling", "on-the-fly"}}); }

struct Stage {
    const char* name;
    Timed timed;
};
std::vector<Stage> thesisStages() {
    const Setting first{
        "", {{"layers", "peel"}, {"trace", "pyramid"}, {"normals", "stored"}, {"maxLayers", "1"}}};
    return {{"voxels, nearest and farthest depths", {counting(twoSurfaces()), showNothing}},
            {"voxels, slices", {counting(bitsOnly()), counting(twoSurfaces())}},
            {"voxels, peeling", {counting(voxels()), counting(bitsOnly())}},
            {"voxels, first surface", {counting(first), showNothing}},
            {"voxels, reduction, first surface and rays", {showColor, counting(voxels())}}};
}

Case refractCase(const std::string& name, scene::Scene scene) {
    const double rays = double(scene.size.x) * scene.size.y;
    return {.technique = "refract",
            .name = name,
            .scene = {[scene = std::move(scene)]() -> Result<scene::Scene> { return scene; }, rays},
            .settings = refractSettings(),
            .toPhysics = {},
            .toLayers = showLayers,
            .timed = kFrame};
}

constexpr const char* kTraceName = "peel, trace stage";
constexpr const char* kLayersName = "peel, layers stage";

std::vector<Series> refractSeries(const std::vector<BenchMesh>& meshes, bool quick) {
    const int size = quick ? 128 : 256;
    const auto points = overTriangles(meshes, quick, double(size) * size,
                                      [size](const BenchMesh& mesh) { return glassScene(mesh, size); });
    const auto series = [&](const Setting& setting, const Timed& timed) {
        return Series{.technique = "refract",
                      .over = "triangles",
                      .setting = setting,
                      .points = points,
                      .timed = timed};
    };
    std::vector<Series> all{series({kTraceName}, kTraceStage), series({kLayersName}, kLayersStage)};
    for (const Stage& stage : thesisStages())
        all.push_back(series({stage.name, voxels().knobs}, stage.timed));
    return all;
}

// --- promises

using Figure = double (*)(const AngleErrors&);

// Of the picture with all layers.
RatioRule angle(const std::string& scene, const std::string& what, Figure figure,
                std::optional<double> target) {
    return [=](const BenchReport& report) -> std::optional<Ratio> {
        for (const Measurement& m : report.measurements)
            if (m.technique == "refract" && m.scene == scene && m.knobs.empty() && m.error && m.error->angles)
                return Ratio{scene + ": " + what, figure(*m.error->angles), target, false};
        return std::nullopt;
    };
}

void addAngles(Plan& plan, const std::string& scene) {
    const bool isMesh = scene == "bunny";
    const auto add = [&](const char* what, Figure figure, std::optional<double> target) {
        plan.ratios.push_back(angle(scene, what, figure, target));
    };
    add(
        "median of degrees off", [](const AngleErrors& a) { return a.all.median; }, isMesh ? 0.3 : 0.1);
    add(
        "95 % of degrees off", [](const AngleErrors& a) { return a.all.p95; }, isMesh ? 3 : 2);
    add("99 % of degrees off", [](const AngleErrors& a) { return a.all.p99; }, {});
    add("share of rays that are lost", [](const AngleErrors& a) { return a.all.lost; }, {});
    add("median of degrees off, away from silhouettes", [](const AngleErrors& a) { return a.inside.median; },
        {});
    add("95 % of degrees off, away from silhouettes", [](const AngleErrors& a) { return a.inside.p95; }, {});
}

// Normals from depths against a ball's own, in degrees (the thesis's figure 3.4). They cost no picture.
void addNormals(Plan& plan) {
    constexpr int kSize = 256;
    const auto add = [&](const std::string& method, DepthNormals normals, int slices) {
        const std::string depths =
            slices ? " from " + std::to_string(slices) + " slices" : " from exact depths";
        const auto figure = [&](const char* what, double NormalErrors::*value) {
            plan.ratios.push_back([=,
                                   name = "normals, " + method + depths + ": " + what](const BenchReport&) {
                return std::optional<Ratio>(Ratio{name, errorsOf(normals, kSize, slices).*value, {}, false});
            });
        };
        figure("median of degrees off", &NormalErrors::median);
        figure("95 % of degrees off", &NormalErrors::p95);
        figure("median of degrees off at the outline", &NormalErrors::outline);
    };
    for (const int slices : {0, 256, 512}) {
        add("delta 1", DepthNormals::Delta1, slices);
        add("delta 2", DepthNormals::Delta2, slices);
        add("neighbours", DepthNormals::Neighbours, slices);
    }
}

Status addRefraction(Plan& plan, const BenchAssets& assets) {
    const auto bunny = assets.meshes({"bunny"}), dragons = dragonsOf(assets);
    if (!bunny) return bunny.error();
    if (!dragons) return dragons.error();
    const int size = plan.quick ? 128 : 256;
    std::vector<Case> cases{refractCase("sphere", sphereScene(size)), refractCase("torus", torusScene(size)),
                            refractCase("box", boxScene(size)), refractCase("nested", nestedScene(size))};
    for (const BenchMesh& mesh : *bunny)
        cases.push_back(refractCase(mesh.name, glassScene(mesh, size)));
    for (const Case& one : cases) {
        addAngles(plan, one.name);
        plan.cases.push_back(one);
    }
    for (const Series& series : refractSeries(*dragons, plan.quick))
        plan.series.push_back(series);
    plan.ratios.push_back(growth(kTraceName, 1.3));
    plan.ratios.push_back(growth(kLayersName, {}));
    addNormals(plan);
    return Done{};
}

constexpr BenchPart kParts[] = {
    {.name = "refraction",
     .help = "directions behind glass, and their cost over triangles",
     .plan = addRefraction},
    {.name = "budget-glass",
     .help = "proof of quality.maxError on light through glass",
     .prove = proveBudget},
};

} // namespace

extern const TechniqueBench kBench;
const TechniqueBench kBench{kParts};

} // namespace lucent::refract
