// The benchmark of caustics: light that a floor receives by way of glass, water and metal.
#include "measure/TechniqueBench.h"
#include "technique/Technique.h"
#include "techniques/caustics/Caustics.h"
#include "techniques/caustics/bench/FloorLight.h"
#include "views/FieldTextures.h"
#include "views/Water.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lucent::caustics {

namespace {

using namespace measure;

constexpr const char* kName = "caustics";

// --- methods and knobs

Setting setting(const std::string& deposit, const std::string& intersect, int grid) {
    return {deposit, {{"intersect", intersect}, {"grid", std::to_string(grid)}}};
}

// Beams that trace what is beside them by cells, not by pixels.
Setting coarseBeams(int grid) {
    Setting coarse = setting("beam", "hybrid", grid);
    coarse.knobs.push_back({"refine", "false"});
    return coarse;
}

// Each way to deposit on several grids and each way to intersect; not quick: every combination.
std::vector<Setting> causticsSettings(bool quick) {
    const char* const deposits[] = {"beam", "splat", "lines"};
    const char* const intersects[] = {"hybrid", "fixed-point", "newton", "secant"};
    std::vector<Setting> settings{coarseBeams(64), coarseBeams(128)};
    for (const char* deposit : deposits)
        for (const char* intersect : intersects)
            for (const int grid : {32, 64, 128, 256}) {
                const bool isPlain = deposit == deposits[0] && grid == 128;
                const bool isSwept = intersect == intersects[0] && (grid == 64 || grid == 128);
                if (!quick || isPlain || isSwept) settings.push_back(setting(deposit, intersect, grid));
            }
    return settings;
}

// --- scenes

// A white floor through the origin, seen straight down by a camera that sees nothing else.
scene::Scene floorScene(int size, float height) {
    scene::Scene scene;
    scene.size = ivec2(size);
    scene.camera.eye = {0, 20, 0};
    scene.camera.up = {0, 0, -1};
    scene.camera.height = height;
    scene.view.show = scene::Aov::Irradiance;
    technique::addSettings(scene);
    Settings& settings = *static_cast<Settings*>(scene.technique.at("caustics").data());
    settings.mapSize = 1024; // about a texel a pixel, so that what is measured is not the map's
    scene::Object floor;
    floor.name = "floor";
    floor.shape = scene::Plane{{40, 40}};
    scene.objects.push_back(std::move(floor));
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}}};
    return scene;
}

scene::Object& addHidden(scene::Scene& scene, const std::string& name, scene::Shape shape, vec3 place) {
    scene::Object object;
    object.name = name;
    object.shape = std::move(shape);
    object.transform.translate = place;
    object.visible = false;
    return scene.objects.emplace_back(std::move(object));
}

void addGlass(scene::Scene& scene, const std::string& name, scene::Shape shape, float ior, vec3 place) {
    addHidden(scene, name, std::move(shape), place).material.kind = scene::Clear{.ior = ior};
}

constexpr float kBallIor = 1.5f;
constexpr double kBallPicture = 4; // m

scene::Scene ballScene(int size, float below) {
    scene::Scene scene = floorScene(size, float(kBallPicture));
    addGlass(scene, "ball", scene::Sphere{1}, kBallIor, {0, below, 0});
    return scene;
}

constexpr float kWaterIor = 1.33f, kWaterDepth = 0.6f, kAmplitude = 0.015f, kWavelength = 0.25f;

scene::Scene waterScene(int size) {
    scene::Scene scene = floorScene(size, 1);
    const scene::Water water{
        .size = {2, 2}, .cells = 640, .damping = 0, .amplitude = kAmplitude, .wavelength = kWavelength};
    addGlass(scene, "water", water, kWaterIor, {0, kWaterDepth, 0});
    return scene;
}

scene::Scene ringScene(int size) {
    scene::Scene scene = floorScene(size, 3);
    addHidden(scene, "ring", scene::Cylinder{1, 0.4f, true}, {0, 0.2f, 0}).material.kind = scene::Mirror{};
    scene.lights = {scene::DistantLight{.direction = {1, -0.5f, 0}, .irradiance = 2}};
    return scene;
}

// Two metres long, a fifth of a metre above the floor, in slanted light.
scene::Scene meshScene(const BenchMesh& mesh, int size) {
    scene::Scene scene = floorScene(size, 4);
    scene::Object object = objectOf(mesh);
    object.material.kind = scene::Clear{};
    float lowest = 1e30f;
    for (const vec3& position : mesh.mesh->positions)
        lowest = std::min(lowest, position.y);
    object.transform.translate.y = 0.2f - object.transform.scale * lowest;
    object.visible = false;
    scene.objects.push_back(std::move(object));
    scene.lights = {scene::DistantLight{.direction = {0.3f, -1, 0.2f}}};
    return scene;
}

// A wall almost along the light: where the fixed point's slope is beyond -1, and it never settles.
scene::Scene wallScene(int size) {
    scene::Scene scene = floorScene(size, 6);
    addGlass(scene, "ball", scene::Sphere{1}, kBallIor, {0, 1.6f, 0});
    scene::Object& wall = addHidden(scene, "wall", scene::Plane{{6, 6}}, {0.6f, 0.5f, 0});
    wall.transform.rotate = {0, 0, 80};
    wall.visible = true;
    return scene;
}

// What bends light becomes opaque: the same light falls straight on the floor, and none by way of anything.
void blockLight(scene::Scene& scene) {
    for (scene::Object& object : scene.objects) {
        object.material.kind = scene::Matt{};
    }
}

Case causticsCase(const std::string& name, scene::Scene scene, bool quick,
                  std::function<Image()> closedForm = {}) {
    const double rays = double(scene.size.x) * scene.size.y;
    return {.technique = kName,
            .name = name,
            .scene = {[scene = std::move(scene)]() -> Result<scene::Scene> { return scene; }, rays},
            .settings = causticsSettings(quick),
            .toPhysics = {},
            .timed = {[](scene::Scene&) {}, blockLight},
            .comparesTimed = true,
            .closedForm = std::move(closedForm)};
}

// --- promises on pictures

RatioRule misplaced(const std::string& scene, std::optional<double> target) {
    return [=](const BenchReport& report) -> std::optional<Ratio> {
        const Measurement* m = measured(report, kName, scene, setting("beam", "hybrid", 128));
        if (!m) return std::nullopt;
        return Ratio{scene + ": share of the flux that is misplaced, beams of 128^2 rays",
                     m->error->flux->misplaced, target, false};
    };
}

RatioRule encircled(const std::string& scene) {
    return [=](const BenchReport& report) -> std::optional<Ratio> {
        const Measurement* m = measured(report, kName, scene, setting("beam", "hybrid", 128));
        if (!m) return std::nullopt;
        return Ratio{scene + ": largest error of the flux within a circle, beams of 128^2 rays",
                     m->error->flux->encircled,
                     {},
                     false};
    };
}

double misplacedBy(const Measurement& m) { return m.error->flux->misplaced; }
double timeOf(const Measurement& m) { return m.ms->median; }

// A figure of beams over that of splats.
RatioRule beamOverSplat(const std::string& what, const Setting& beams, double target,
                        double (*figure)(const Measurement&)) {
    return [=](const BenchReport& report) -> std::optional<Ratio> {
        const Measurement* beam = measured(report, kName, "ball", beams);
        const Measurement* splat = measured(report, kName, "ball", setting("splat", "hybrid", 128));
        if (!beam || !splat) return std::nullopt;
        return Ratio{"ball: " + what + " of " + beams.name() + " over that of splats",
                     figure(*beam) / figure(*splat), target, false};
    };
}

// --- books

// What became of the light of a scene.
Result<Energy> energyOf(gl::Context& context, const scene::Scene& scene, const Settings& settings) {
    graph::TexturePool pool(context.device());
    views::ImageCache images(context);
    views::Waters waters(context);
    if (const Result<bool> moved = waters.advance(scene); !moved) return moved.error();
    const Result<views::Drawables> drawn = views::drawablesOf(scene, images, &waters);
    if (!drawn) return drawn.error();
    const views::Eye eye = views::makeEye(scene, float(scene.size.x) / float(scene.size.y));
    const Caustics technique(context);
    views::Readings readings;
    Plan plan;
    if (Status s = technique.plan(plan, readings, pool, scene, Caustics::receiving(&eye, *drawn, settings),
                                  *drawn, settings);
        !s)
        return s.error();
    return technique.measure(pool, scene, eye, *drawn, plan);
}

double total(const dvec3& flux) { return flux.r + flux.g + flux.b; }

double lostOrWrong(const Energy& energy) {
    return (total(energy.astray) + total(energy.missed)) / total(energy.incident);
}

struct Subject {
    std::string name;
    scene::Scene scene;
    Settings settings{};
};

// Of one scene: where its light stays.
Status addBook(gl::Context& context, const Subject& subject, std::vector<Ratio>& ratios) {
    const Result<Energy> energy = energyOf(context, subject.scene, subject.settings);
    if (!energy) return energy.error();
    const double met = total(energy->incident);
    const double others = total(energy->received) + total(energy->absorbed) + total(energy->reflected) +
                          total(energy->missed) + total(energy->lost);
    // Triangles cover whole texels: what they cover too much of one is within a thousandth.
    ratios.push_back(
        {subject.name + ": flux on receivers over flux met", total(energy->received) / met, 1.001, false});
    ratios.push_back({subject.name + ": incident flux missing from the energy balance",
                      std::abs(others / met - 1), 0.005, false});
    return Done{};
}

// From 32^2 to a hundred thousand rays: what meets a ball and what comes to the floor.
Status addGrids(gl::Context& context, std::vector<Ratio>& ratios) {
    const scene::Scene scene = ballScene(128, 1.2f);
    double worstMet = 0, low = 1e30, high = 0;
    for (const int grid : {32, 64, 100, 128, 200, 316}) {
        Settings settings;
        settings.grid = grid;
        const Result<Energy> energy = energyOf(context, scene, settings);
        if (!energy) return energy.error();
        worstMet = std::max(worstMet, std::abs(energy->incident.g / std::numbers::pi - 1)); // pi R² E
        low = std::min(low, energy->received.g);
        high = std::max(high, energy->received.g);
    }
    ratios.push_back({"ball: largest error of the flux met, 32^2 to 316^2 rays", worstMet, 0.005, false});
    ratios.push_back(
        {"ball: change of the light on receivers, 32^2 to 316^2 rays", high / low - 1, 0.01, false});
    return Done{};
}

struct Method {
    Intersect intersect;
    const char* name;
};
constexpr Method kMethods[] = {{Intersect::Hybrid, "hybrid"},
                               {Intersect::FixedPoint, "fixed-point"},
                               {Intersect::Newton, "newton"},
                               {Intersect::Secant, "secant"}};
constexpr int kMostLooks = 64;

// How many looks each method needs until no more than a hundredth of the light is lost or wrong.
Status addConvergence(gl::Context& context, const Subject& subject, std::vector<Ratio>& ratios) {
    for (const auto& [intersect, name] : kMethods) {
        Settings settings = subject.settings;
        settings.intersect = intersect;
        double share = 1, looks = 0;
        for (settings.steps = 1; settings.steps <= kMostLooks; settings.steps *= 2) {
            const Result<Energy> energy = energyOf(context, subject.scene, settings);
            if (!energy) return energy.error();
            share = lostOrWrong(*energy);
            looks = energy->looks;
            if (share <= 0.01) break;
        }
        const std::optional<double> target =
            intersect == Intersect::Hybrid ? std::optional(0.01) : std::nullopt;
        const char* const format = "%s: light lost or wrong by %s within %d looks (%.1f on average)";
        ratios.push_back(
            {formatted(format, subject.name.c_str(), name, std::min(settings.steps, kMostLooks), looks),
             share, target, false});
    }
    return Done{};
}

// --- the part

Result<std::vector<BenchMesh>> meshesOf(const BenchAssets& assets) {
    return assets.meshes({"bunny", "dragon-40k"});
}

Status addCaustics(measure::Plan& plan, const BenchAssets& assets) {
    const auto meshes = meshesOf(assets);
    if (!meshes) return meshes.error();
    const int size = plan.quick ? 128 : 192;
    std::vector<Case> cases;
    const auto ball = [&](const char* name, float below) {
        cases.push_back(causticsCase(name, ballScene(256, below), plan.quick, [=] {
            return lightOfBall(ivec2(256), kBallPicture, double(kBallIor), double(below));
        }));
    };
    ball("ball", 1.2f);
    ball("focus", kBallIor / (2 * (kBallIor - 1))); // the paraxial one
    cases.push_back(causticsCase("water", waterScene(128), plan.quick, [] {
        return lightOfWater(ivec2(128), 1, double(kAmplitude), double(kWavelength), double(kWaterIor),
                            double(kWaterDepth));
    }));
    cases.push_back(causticsCase("ring", ringScene(size), plan.quick));
    for (const BenchMesh& mesh : *meshes)
        cases.push_back(causticsCase(mesh.name, meshScene(mesh, size), plan.quick));
    for (const Case& one : cases) {
        plan.ratios.push_back(misplaced(one.name, one.name == "ball"    ? std::optional(0.005)
                                                  : one.name == "water" ? std::optional(0.01)
                                                                        : std::nullopt));
        plan.cases.push_back(one);
    }
    plan.ratios.push_back(encircled("focus"));
    for (const Setting& beams : {setting("beam", "hybrid", 128), coarseBeams(128)}) {
        plan.ratios.push_back(beamOverSplat("misplaced flux", beams, 0.25, misplacedBy));
        plan.ratios.push_back(beamOverSplat("time", beams, 1.2, timeOf));
    }
    return Done{};
}

// What pictures do not show: the flux that each scene's light brings, takes and loses, for several numbers of
// rays; how many looks each method needs until all but a hundredth of the light is where it belongs; and what
// goes astray where the fixed point swings.
Result<Proof> proveCaustics(const BenchRun& run) {
    const auto meshes = meshesOf(run.assets);
    if (!meshes) return meshes.error();
    std::vector<Ratio> ratios;
    const int size = run.quick ? 128 : 192;
    std::vector<Subject> subjects{
        {"ball", ballScene(size, 1.2f)}, {"water", waterScene(size)}, {"ring", ringScene(size)}};
    for (const BenchMesh& mesh : *meshes)
        subjects.push_back({mesh.name, meshScene(mesh, size)});
    for (const Subject& subject : subjects) {
        run.say(subject.name + ": where its light stays");
        if (Status s = addBook(run.context, subject, ratios); !s) return s.error();
    }
    run.say("ball: several numbers of rays");
    if (Status s = addGrids(run.context, ratios); !s) return s.error();
    for (const Subject& subject :
         {Subject{"ball", ballScene(size, 1.2f)}, Subject{"wall", wallScene(size)}}) {
        run.say(subject.name + ": looks of each method");
        if (Status s = addConvergence(run.context, subject, ratios); !s) return s.error();
    }
    return Proof{ratios};
}

constexpr BenchPart kParts[] = {{.name = "caustics",
                                 .help = "light on a floor by way of glass, water and metal",
                                 .plan = addCaustics,
                                 .prove = proveCaustics}};

} // namespace

extern const TechniqueBench kBench;
const TechniqueBench kBench{kParts};

} // namespace lucent::caustics
