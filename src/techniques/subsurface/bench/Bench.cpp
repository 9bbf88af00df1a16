#include "techniques/subsurface/bench/Bench.h"

#include "measure/Stopwatch.h"
#include "measure/SubsurfaceTruth.h"
#include "scene/Painting.h"
#include "technique/Technique.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lucent::subsurface {

namespace {

using namespace measure;

constexpr const char* kName = "subsurface";
constexpr const char* kUsual = "0.01"; // error that splats are asked for unless it is said

// --- methods and knobs

Setting splats(const std::string& method, const std::string& epsilon) {
    return {method, {{"epsilon", epsilon}}};
}
// The dissertation's way: eq. 6.17 and 6.18 with what its programs could draw.
Setting papersSplats() { return {"splat", {{"splats", "paper"}, {"mostSplats", "64"}}}; }
Setting cells(const std::string& count) {
    return {.method = "diffusion", .knobs = {{"cells", count}}, .isPhysics = true};
}

std::vector<Setting> splatSettings(bool quick) {
    std::vector<Setting> settings{splats("multires", kUsual), splats("multires", "0.03"),
                                  splats("multires", "0.003"), splats("splat", kUsual)};
    if (quick) return settings;
    settings.push_back(splats("multires", "0.1"));
    for (const char* epsilon : {"0.1", "0.03", "0.003"})
        settings.push_back(splats("splat", epsilon));
    return settings;
}
// What one body is drawn with besides: fewer points, the dissertation's own, and cells.
std::vector<Setting> allSettings(bool quick) {
    std::vector<Setting> settings = splatSettings(quick);
    if (quick) settings.insert(settings.end(), {splats("multires", "0.1"), splats("splat", "0.1")});
    settings.insert(settings.end(), {papersSplats(), cells("24"), cells("48")});
    if (!quick) settings.push_back(cells("96"));
    return settings;
}

// --- scenes

constexpr float kRadius = 0.01f;           // m, of the ball
constexpr float kPicture = 2.2f * kRadius; // m from its top to its bottom
constexpr int kPaintedSize = 64;           // pixels: its exact solution is made for each of them

scene::Object bodyOf(scene::Shape shape, vec3 place = vec3(0)) {
    scene::Object object;
    object.name = "body";
    object.shape = std::move(shape);
    object.material = marble();
    object.transform.translate = place;
    return object;
}

// What leaves bodies, seen along -z; light comes from the right.
scene::Scene sceneOf(std::vector<scene::Object> objects, ivec2 size, float height) {
    scene::Scene scene;
    scene.size = size;
    scene.camera.eye = {0, 0, 1};
    scene.camera.height = height;
    scene.view.show = scene::Aov::Radiosity;
    technique::addSettings(scene);
    scene.objects = std::move(objects);
    scene.lights = {scene::DistantLight{.direction = {-1, 0, 0}}};
    return scene;
}

// 20 mm long, in light from the right, above and before.
scene::Scene meshScene(const BenchMesh& mesh, int size) {
    scene::Object object = objectOf(mesh);
    object.material = marble();
    object.transform.scale *= kRadius;
    object.transform.translate *= kRadius;
    scene::Scene scene = sceneOf({object}, ivec2(size), kPicture);
    scene.lights = {scene::DistantLight{.direction = {-1, -0.5f, -0.5f}}};
    return scene;
}

// A sheet 13 times as wide as red light reaches, lit straight on.
scene::Scene halfSpaceScene(int size) {
    scene::Object plane = bodyOf(scene::Plane{{0.11f, 0.11f}});
    plane.transform.rotate = {90, 0, 0};
    scene::Scene scene = sceneOf({plane}, ivec2(size), 0.002f);
    scene.lights = {scene::DistantLight{.direction = {0, 0, -1}}};
    return scene;
}

// The ball with bands of more and less blur, one that hardly lets light through, one that glows and one with
// paint on top.
Result<scene::Scene> paintedScene(int size) {
    constexpr float kEnd = std::numeric_limits<float>::infinity();
    const auto band = [](scene::PaintMap map, vec3 value, float low, float high) {
        scene::Stroke stroke;
        stroke.brush = {.map = map, .value = value};
        stroke.fill = {vec3(-kEnd, low * kRadius, -kEnd), vec3(kEnd, high * kRadius, kEnd)};
        return stroke;
    };
    const scene::Stroke strokes[] = {band(scene::PaintMap::Blur, vec3(0.5f), 0.4f, 0.8f),
                                     band(scene::PaintMap::Blur, vec3(2), -0.7f, -0.4f),
                                     band(scene::PaintMap::Glow, {1, 0.5f, 0.25f}, 0.1f, 0.5f),
                                     band(scene::PaintMap::Translucency, vec3(0.3f), -kEnd, -0.7f),
                                     band(scene::PaintMap::Outgoing, {0.3f, 1, 0.3f}, -0.2f, 0)};
    scene::Scene scene = marbleBall(size);
    auto painting = scene::paint(scene.objects.front(), strokes, 128);
    if (!painting) return painting.error();
    scene.objects.front().painting = std::move(*painting);
    return scene;
}

// Two blocks that touch; the light, along +x, ends on the left one.
scene::Scene touchingScene(int size) {
    const scene::Shape block = scene::Box{vec3(0.01f)};
    scene::Scene scene =
        sceneOf({bodyOf(block, {-0.005f, 0, 0}), bodyOf(block, {0.005f, 0, 0})}, {2 * size, size}, 0.012f);
    scene.lights = {scene::DistantLight{.direction = {1, 0, 0}}};
    return scene;
}

// --- what is timed

void showNothing(scene::Scene& scene) {
    scene.view.show = scene::Aov::Color;
    scene.objects.clear();
}
const Timed kWhole{[](scene::Scene&) {}, showNothing};

// Something hidden takes all the light: the same views of camera and lamp are drawn, and no splat.
void block(scene::Scene& scene) {
    const vec3 way = glm::normalize(std::get<scene::DistantLight>(scene.lights.front()).direction);
    scene::Object blind;
    blind.name = "blind";
    blind.shape = scene::Box{vec3(2 * kPicture)}; // from all sides larger than what is seen
    blind.transform.translate = -3 * kPicture * way;
    blind.visible = false;
    scene.objects.push_back(std::move(blind));
}
const Timed kSplats{[](scene::Scene&) {}, block};
const Timed kViews{block, showNothing};

// --- cases and series

Case bodyCase(const std::string& name, const MakeScene& scene, std::vector<Setting> settings, bool walks) {
    Case one{.technique = kName,
             .name = name,
             .scene = scene,
             .settings = std::move(settings),
             .toPhysics = {},
             .timed = kWhole};
    if (walks) // by one scene whatever the profile, so that it is solved once
        one.toPhysics = [](scene::Scene& scene) { settingsOf(scene) = {.method = Method::Diffusion}; };
    return one;
}

Case bodyCase(const std::string& name, scene::Scene scene, std::vector<Setting> settings, bool walks) {
    const double rays = double(scene.size.x) * scene.size.y;
    return bodyCase(name, {[scene = std::move(scene)]() -> Result<scene::Scene> { return scene; }, rays},
                    std::move(settings), walks);
}

// The ball with each profile; diffusion has none, and stands beside the first.
void addBalls(measure::Plan& plan, int size) {
    plan.cases.push_back(bodyCase("ball", marbleBall(size), allSettings(plan.quick), true));
    scene::Scene offset = marbleBall(size), burley = marbleBall(size);
    settingsOf(offset).dipoleGeometry = DipoleGeometry::Offset;
    settingsOf(burley).profile = diffusion::Shape::Burley;
    plan.cases.push_back(bodyCase("ball, offset", offset, splatSettings(plan.quick), true));
    plan.cases.push_back(bodyCase("ball, burley", burley, splatSettings(plan.quick), true));
}

void addPainted(measure::Plan& plan) {
    plan.cases.push_back(bodyCase("painted ball", {[] { return paintedScene(kPaintedSize); }, 4096},
                                  {splats("multires", kUsual), splats("splat", kUsual)}, false));
}

void addHalfSpace(measure::Plan& plan) {
    constexpr int kSize = 32;
    Case one = bodyCase("half space", halfSpaceScene(kSize), splatSettings(plan.quick), false);
    one.closedForm = [] {
        const dvec3 leaving = radiosityOfHalfSpace(marble());
        Image image(kSize, kSize, 4);
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            image.pixels[i] = i % 4 < 3 ? float(leaving[int(i % 4)]) : 1;
        return image;
    };
    plan.cases.push_back(std::move(one));
}

// The table's extinction, 1/mm, on a ball so large that light of the first reaches as far as it is wide.
constexpr double kExtinctions[] = {0.27, 1.47, 3.27};

scene::Scene extinctScene(double extinction, int size) {
    constexpr float kLarge = 3; // times the ball of the other scenes
    scene::Scene scene = marbleBall(size);
    std::get<scene::Sphere>(scene.objects[0].shape).radius *= kLarge;
    scene.camera.height *= kLarge;
    scene::Translucent& inside = scene.objects[0].material.translucent();
    const float denser = float(extinction * 1000) / (inside.scattering.g + inside.absorption.g);
    inside.scattering *= denser;
    inside.absorption *= denser;
    return scene;
}

Series extinctions(const Setting& setting, int size) {
    Series series{.technique = kName,
                  .over = "mm of mean free path",
                  .setting = setting,
                  .points = {},
                  .timed = kWhole};
    for (const double extinction : kExtinctions)
        series.points.push_back({1 / extinction,
                                 {[=]() -> Result<scene::Scene> { return extinctScene(extinction, size); },
                                  double(size) * size}});
    return series;
}

Series stage(const std::vector<Series::Point>& points, const std::string& part, const Timed& timed) {
    return {.technique = kName,
            .over = "triangles",
            .setting = {"multires"},
            .points = points,
            .timed = timed,
            .part = part};
}

// --- promises on pictures

RatioRule misplaced(const std::string& scene) {
    return [=](const BenchReport& report) -> std::optional<Ratio> {
        const Measurement* m = measured(report, kName, scene, splats("multires", kUsual));
        if (!m) return std::nullopt;
        return Ratio{scene + ": share of the radiosity that is misplaced", m->error->flux->misplaced, 0.02,
                     false};
    };
}

// Time of splats over that of the quickest bands that are no farther from the exact solution; nothing where
// none are.
RatioRule bandsOverSplats(const std::string& scene, const std::string& epsilon) {
    return [=](const BenchReport& report) -> std::optional<Ratio> {
        const Measurement* splat = measured(report, kName, scene, splats("splat", epsilon));
        if (!splat) return std::nullopt;
        double best = 0;
        for (const Measurement& m : report.measurements)
            if (m.technique == kName && m.scene == scene && m.method == "multires" && m.error && m.ms &&
                m.error->rmse <= splat->error->rmse)
                best = std::max(best, splat->ms->median / m.ms->median);
        if (best == 0) return std::nullopt;
        return Ratio{scene + ": time of splats with epsilon " + epsilon +
                         " over that of the quickest multires of no larger RMSE",
                     best, 8, true};
    };
}

RatioRule evenCost(const Setting& setting) {
    return [=](const BenchReport& report) -> std::optional<Ratio> {
        for (const ScalingSeries& series : report.scaling) {
            if (series.technique != kName || series.method != setting.name() ||
                series.points.size() != std::size(kExtinctions))
                continue;
            const auto [least, most] =
                std::minmax_element(series.points.begin(), series.points.end(),
                                    [](const dvec2& a, const dvec2& b) { return a.y < b.y; });
            return Ratio{setting.name() +
                             ": largest over smallest time of table 6.2's mean free paths (there 1.38)",
                         most->y / least->y,
                         {},
                         false};
        }
        return std::nullopt;
    };
}

// --- promises on pixels

// One renderer for pictures of one scene that changes.
class Pictures {
public:
    explicit Pictures(gl::Context& context) : renderer_(context) {}
    Result<Image> operator()(const scene::Scene& scene) {
        if (Status done = renderer_.finish(scene, ++revision_, scene.size); !done) return done.error();
        return renderer_.read(scene, scene.view.show);
    }

private:
    frame::Renderer renderer_;
    std::uint64_t revision_ = 0;
};

bool isCovered(const Image& image, int x, int y) { return image.at(x, y)[3] > 0; }

// Calls with each pixel and channel that both pictures cover.
template <class Work>
void forEachValue(const Image& image, const Image& exact, const Work& work) {
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c)
                if (isCovered(image, x, y) && isCovered(exact, x, y))
                    work(ivec2(x, y), c, double(image.at(x, y)[c]), double(exact.at(x, y)[c]));
}

constexpr const char* kSplatMethods[] = {"multires", "splat"};

Result<Image> pictureOf(gl::Context& context, scene::Scene scene, const Setting& setting) {
    if (Status set = setting.putInto(scene, kName); !set) return set.error();
    return Pictures(context)(scene);
}

Status addLevel(gl::Context& context, std::vector<Ratio>& ratios) {
    const dvec3 exact = radiosityOfHalfSpace(marble());
    for (const char* method : kSplatMethods) {
        const Result<Image> image = pictureOf(context, halfSpaceScene(64), {method});
        if (!image) return image.error();
        double worst = 0;
        forEachValue(*image, *image, [&](ivec2, int c, double value, double) {
            worst = std::max(worst, std::abs(value / exact[c] - 1));
        });
        ratios.push_back({"half space: largest error of " + std::string(method), worst, 0.005, false});
    }
    return Done{};
}

Status addLeak(gl::Context& context, std::vector<Ratio>& ratios) {
    for (const char* method : {"multires", "splat", "diffusion"}) {
        const Result<Image> image = pictureOf(context, touchingScene(64), {method});
        if (!image) return image.error();
        double most = 0, least = 1e30;
        for (int y = 0; y < image->height; ++y)
            for (int x = 0; x < image->width; ++x) {
                if (!isCovered(*image, x, y)) continue;
                const auto value = double(image->at(x, y)[1]);
                if (x > image->width / 2) most = std::max(most, value);
                if (x < image->width / 2 - 1) least = std::min(least, value);
            }
        if (!(least > 0)) return Error{"touching blocks: the lit one is dark; nothing can be said of leaks"};
        ratios.push_back(
            {"touching blocks: most light of the dark one by " + std::string(method), most, 0.0, false});
    }
    return Done{};
}

// Degrees between a ball's place in the middle of a pixel and the light, which comes from the right.
double degreesAt(ivec2 pixel, const Image& image) {
    const double x = ((pixel.x + 0.5) / image.width - 0.5) * double(kPicture / kRadius);
    return std::acos(std::clamp(x, -1.0, 1.0)) * 180 / std::numbers::pi;
}

Status addSides(gl::Context& context, const SolveTruth& solve, int size, std::vector<Ratio>& ratios) {
    for (const auto& [name, geometry] :
         {std::pair("planar", DipoleGeometry::Planar), std::pair("offset", DipoleGeometry::Offset)}) {
        scene::Scene scene = marbleBall(size);
        settingsOf(scene).dipoleGeometry = geometry;
        const Result<truth::Picture> exact = solve(scene, 0, {});
        if (!exact) return exact.error();
        const Result<Image> image = Pictures(context)(scene);
        if (!image) return image.error();
        double worst = 0;
        forEachValue(*image, exact->values, [&](ivec2 at, int, double value, double wanted) {
            const double degrees = degreesAt(at, *image);
            if (degrees >= 80 && degrees <= 120) worst = std::max(worst, std::abs(value / wanted - 1));
        });
        ratios.push_back({std::string("ball, ") + name + ": largest error 80 to 120 degrees from the light",
                          worst, 0.05, false});
    }
    return Done{};
}

// Means over rings of so many degrees around the light. At the poles, which a picture from the side shows
// only on the outline, walks are not known.
constexpr int kRing = 10, kPole = 10;
struct RingMeans {
    dvec3 image[180 / kRing]{}, exact[180 / kRing]{};
};
RingMeans ringMeans(const Image& image, const Image& exact) {
    RingMeans means;
    forEachValue(image, exact, [&](ivec2 at, int c, double value, double wanted) {
        const auto ring = std::min(int(degreesAt(at, image)) / kRing, 180 / kRing - 1);
        means.image[ring][c] += value;
        means.exact[ring][c] += wanted;
    });
    return means;
}

struct Model {
    const char* name;
    Setting setting;
    std::optional<double> target;
};
const Model kModels[] = {
    {"dipole", {"multires", {{"dipoleGeometry", "planar"}}}, {}},
    {"dipole, offset", {"multires", {{"dipoleGeometry", "offset"}}}, {}},
    {"burley", {"multires", {{"profile", "burley"}}}, {}},
    {"diffusion, 48 cells", {"diffusion", {{"cells", "48"}}}, 0.2},
};

// Each model against random walks in rings around the ball: the farthest of three colours before and behind,
// and all of them by angle.
Status addAround(gl::Context& context, const SolveTruth& solve, int size, std::vector<Ratio>& ratios) {
    scene::Scene walked = marbleBall(size);
    settingsOf(walked) = {.method = Method::Diffusion};
    const Result<truth::Picture> exact = solve(walked, 0, {});
    if (!exact) return exact.error();
    for (const Model& model : kModels) {
        const Result<Image> image = pictureOf(context, marbleBall(size), model.setting);
        if (!image) return image.error();
        const RingMeans means = ringMeans(*image, exact->values);
        double before = 0, behind = 0;
        for (int ring = kPole / kRing; ring < (180 - kPole) / kRing; ++ring)
            for (int c = 0; c < 3; ++c) {
                double& worst = ring * kRing < 80 ? before : behind;
                worst = std::max(worst, std::abs(means.image[ring][c] / means.exact[ring][c] - 1));
            }
        const auto add = [&](const char* where, double worst) {
            ratios.push_back({formatted("ball: %s, farthest from random walks %s", model.name, where), worst,
                              model.target, false});
        };
        add("up to 80 degrees from the light", before);
        add("beyond 80 degrees", behind);
        for (const int degrees : {20, 50, 80, 110, 140, 160})
            ratios.push_back({formatted("ball: %s, green light over that of random walks at %d to %d degrees",
                                        model.name, degrees, degrees + kRing),
                              means.image[degrees / kRing].g / means.exact[degrees / kRing].g,
                              {},
                              false});
    }
    return Done{};
}

// Light that scatters once, which the dipole leaves out: its share of random walks around the ball, and how
// far from these the dipole is with it.
Status addScatteredOnce(gl::Context& context, const SolveTruth& solve, int size, std::vector<Ratio>& ratios) {
    scene::Scene walked = marbleBall(size);
    settingsOf(walked) = {.method = Method::Diffusion};
    const Result<truth::Picture> all = solve(walked, 0, {});
    if (!all) return all.error();
    const Result<truth::Picture> once = solveScatteredOnce(walked, 0);
    if (!once) return once.error();
    const Result<Image> image = Pictures(context)(marbleBall(size));
    if (!image) return image.error();
    const RingMeans shares = ringMeans(once->values, all->values), model = ringMeans(*image, all->values);
    dvec3 sum(0), whole(0);
    double without = 0, with = 0;
    for (int ring = kPole / kRing; ring < 80 / kRing; ++ring) {
        sum += shares.image[ring];
        whole += shares.exact[ring];
        for (int c = 0; c < 3; ++c) {
            const double walks = shares.exact[ring][c], dipole = model.image[ring][c];
            without = std::max(without, std::abs(dipole / walks - 1));
            with = std::max(with, std::abs((dipole + shares.image[ring][c]) / walks - 1));
        }
    }
    const char* kFarthest = "ball: dipole%s, farthest from random walks up to 80 degrees from the light";
    ratios.push_back({"ball: share of green light of random walks up to 80 degrees that scattered once",
                      sum.g / whole.g,
                      {},
                      false});
    ratios.push_back({formatted(kFarthest, " without light that scatters once"), without, {}, false});
    ratios.push_back({formatted(kFarthest, " and light that scatters once"), with, {}, false});
    return Done{};
}

// --- painting

// What a picture of the painted ball takes more than one of the same ball unpainted, and what that takes.
Status addPaintingCost(gl::Context& context, const Repeats& repeats, std::vector<Ratio>& ratios) {
    const Result<scene::Scene> painted = paintedScene(kPaintedSize);
    if (!painted) return painted.error();
    const scene::Scene plain = marbleBall(kPaintedSize);
    scene::Scene nothing = plain;
    showNothing(nothing);
    Pictures pictures(context), others(context);
    const auto median = [&](const scene::Scene& with, const scene::Scene& without) -> Result<double> {
        const auto draw = [](Pictures& by, const scene::Scene& scene) {
            return [&by, &scene] {
                const Result<Image> image = by(scene);
                return image ? Status(Done{}) : Status(image.error());
            };
        };
        Stopwatch stopwatch(context, draw(pictures, with), draw(others, without), repeats);
        for (;;) {
            const Result<bool> done = stopwatch.step();
            if (!done) return done.error();
            if (*done) return stopwatch.spread().median;
        }
    };
    const Result<double> unpainted = median(plain, nothing), more = median(*painted, plain);
    if (!unpainted) return unpainted.error();
    if (!more) return more.error();
    ratios.push_back({"ball, 64x64: ms unpainted", *unpainted, {}, false});
    ratios.push_back({"ball, 64x64: ms more where it is painted", *more, {}, false});
    return Done{};
}

// --- flicker

// Pictures of a body that turns by a degree from one to the next.
Result<std::vector<Image>> turning(gl::Context& context, scene::Scene scene, const Setting& setting,
                                   int frames) {
    if (Status set = setting.putInto(scene, kName); !set) return set.error();
    Pictures pictures(context);
    std::vector<Image> images;
    for (int frame = 0; frame < frames; ++frame) {
        const Result<Image> image = pictures(scene);
        if (!image) return image.error();
        images.push_back(*image);
        ++scene.objects.front().transform.rotate.y;
    }
    return images;
}

// RMS of what changes from picture to picture, less what changes in the converged ones, over their mean.
double flicker(const std::vector<Image>& images, const std::vector<Image>& converged) {
    double squares = 0, sum = 0, count = 0;
    for (std::size_t i = 1; i < images.size(); ++i)
        for (std::size_t p = 0; p < images[i].pixels.size(); ++p) {
            if (p % 4 == 3 || images[i].pixels[p - p % 4 + 3] <= 0) continue;
            const auto change = [&](const std::vector<Image>& list) {
                return double(list[i].pixels[p]) - double(list[i - 1].pixels[p]);
            };
            squares += std::pow(change(images) - change(converged), 2);
            sum += double(converged[i].pixels[p]);
            ++count;
        }
    return std::sqrt(squares / count) / (sum / count);
}

Status addFlicker(gl::Context& context, scene::Scene scene, bool quick, std::vector<Ratio>& ratios) {
    const int frames = quick ? 6 : 16;
    scene.size = ivec2(quick ? 96 : 128);
    const auto converged =
        turning(context, scene, {"multires", {{"epsilon", "0.001"}, {"mostSplats", "512"}}}, frames);
    if (!converged) return converged.error();
    const std::string name = scene.objects.front().name + ": flicker of ";
    for (const Setting& setting : {papersSplats(), splats("splat", kUsual), splats("multires", kUsual)}) {
        Setting steady = setting;
        steady.knobs.emplace_back("temporal", "true");
        double found[2];
        for (const bool isSteady : {false, true}) {
            const auto images = turning(context, scene, isSteady ? steady : setting, frames);
            if (!images) return images.error();
            found[isSteady] = flicker(*images, *converged);
            ratios.push_back({name + (isSteady ? steady : setting).name(), found[isSteady], {}, false});
        }
        const bool isPapers = setting.name() == papersSplats().name(); // the others flicker little as it is
        ratios.push_back({name + setting.name() + ", temporal over not", found[1] / found[0],
                          isPapers ? std::optional(0.2) : std::nullopt, false});
    }
    return Done{};
}

scene::Scene turningScene(const std::vector<BenchMesh>& meshes) {
    if (!meshes.empty()) return meshScene(meshes.front(), 128);
    scene::Object block = bodyOf(scene::Box{{0.02f, 0.008f, 0.008f}});
    block.name = "block";
    return sceneOf({block}, ivec2(128), kPicture);
}

int sizeOf(bool quick) { return quick ? 128 : 256; }

Status addSubsurface(measure::Plan& plan, const BenchAssets& assets) {
    const auto bunny = assets.meshes({"bunny"}), dragons = dragonsOf(assets);
    if (!bunny) return bunny.error();
    if (!dragons) return dragons.error();
    const int size = sizeOf(plan.quick);
    plan.hard.push_back(hardCases());
    const std::size_t first = plan.cases.size();
    addBalls(plan, size);
    addHalfSpace(plan);
    addPainted(plan);
    for (const BenchMesh& mesh : *bunny)
        plan.cases.push_back(
            bodyCase(mesh.name, meshScene(mesh, size), splatSettings(plan.quick), !plan.quick));
    for (std::size_t i = first; i < plan.cases.size(); ++i)
        if (plan.cases[i].name != "half space") plan.ratios.push_back(misplaced(plan.cases[i].name));
    for (const char* name : {"ball", "ball, offset", "ball, burley"}) // whose solutions have no noise
        plan.ratios.push_back(bandsOverSplats(name, kUsual));
    for (const Setting& setting : {Setting{"multires"}, Setting{"splat"}}) {
        plan.series.push_back(extinctions(setting, size));
        plan.ratios.push_back(evenCost(setting));
    }
    const std::vector<Series::Point> points =
        overTriangles(*dragons, plan.quick, double(size) * size,
                      [size](const BenchMesh& mesh) { return meshScene(mesh, size); });
    const Series splatStage = stage(points, "splats", kSplats), viewStage = stage(points, "views", kViews);
    plan.series.insert(plan.series.end(), {splatStage, viewStage});
    plan.ratios.push_back(growth(splatStage.name(), 1.1));
    plan.ratios.push_back(growth(viewStage.name(), {}));
    return Done{};
}

// What single pictures do not show: the largest error on a half space and beside a ball, light that leaks
// into what touches a lit body, the light around a ball against random walks by angle, what of it scatters
// once, what painting costs, and the flicker of a body that turns, with and without `temporal`.
Result<Proof> proveSubsurface(const BenchRun& run) {
    const auto bunny = run.assets.meshes({"bunny"});
    if (!bunny) return bunny.error();
    std::vector<Ratio> ratios;
    const int size = sizeOf(run.quick);
    run.say("half space and touching blocks");
    if (Status s = addLevel(run.context, ratios); !s) return s.error();
    if (Status s = addLeak(run.context, ratios); !s) return s.error();
    run.say("ball: by angle");
    if (Status s = addSides(run.context, run.solve, size, ratios); !s) return s.error();
    if (Status s = addAround(run.context, run.solve, size, ratios); !s) return s.error();
    run.say("ball: light that scatters once");
    if (Status s = addScatteredOnce(run.context, run.solve, size, ratios); !s) return s.error();
    run.say("what painting costs");
    const Repeats repeats = run.quick ? Repeats{3, 5, 30} : Repeats{5, 31, 1000};
    if (Status s = addPaintingCost(run.context, repeats, ratios); !s) return s.error();
    run.say("flicker of what turns");
    if (Status s = addFlicker(run.context, turningScene(*bunny), run.quick, ratios); !s) return s.error();
    return Proof{ratios};
}

constexpr BenchPart kParts[] = {{.name = "subsurface",
                                 .help = "what leaves bodies in which light scatters",
                                 .plan = addSubsurface,
                                 .prove = proveSubsurface}};

} // namespace

scene::Scene marbleBall(int size) { return sceneOf({bodyOf(scene::Sphere{kRadius})}, ivec2(size), kPicture); }

extern const TechniqueBench kBench;
const TechniqueBench kBench{kParts};

} // namespace lucent::subsurface
