// The closed forms of the relief model that hold on every device, as pictures of a few hundred pixels.
#include "measure/SelfCheck.h"
#include "scene/Environment.h"
#include "techniques/relief/bench/Bench.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lucent::relief {

namespace {

using namespace measure;

using scene::Aov;
using scene::Scene;
using Heights = std::shared_ptr<const Image>;

constexpr double kDegree = std::numbers::pi / 180;

// --- scenes

Heights level(ivec2 size) {
    return heightsOf(size, [](int, int) { return 0.5f; });
}

Heights waves(ivec2 size) {
    return heightsOf(size, [](int x, int y) {
        const float u = float(x), v = float(y);
        return 0.5f + 0.28f * std::sin(0.4f * u + 0.1f * v) + 0.2f * std::sin(0.5f * v - 0.2f * u);
    });
}

// A white field 1 m wide, seen straight from above, one pixel a texel, by the exact method, without lights.
Scene sceneOf(Heights heights, float heightScale, float depth) {
    Scene scene = fieldScene({"field", std::move(heights), heightScale}, depth);
    scene.view.show = Aov::Color;
    scene.objects[0].material.diffuse = vec3(1);
    scene.camera.eye.z = 2 + 3 * heightScale;
    views::samplingOf(scene).environment = views::EnvironmentSampling::Equal;
    return scene;
}

// Degrees above the horizon, and from +x towards +y. A white surface that faces it is 1.
scene::DistantLight lampAt(double elevation, double azimuth) {
    const double e = elevation * kDegree, a = azimuth * kDegree;
    return {.direction = -vec3(dvec3(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e))),
            .irradiance = kPi};
}

constexpr int kDirections =
    326; // sqrt(326 pi / 4) = 16.0 rings from pole to pole (views/EnvironmentLights.h)

template <class Function>
void addSky(Scene& scene, const Function& radiance) {
    auto map = std::make_shared<Image>(32, 16, 3);
    for (int y = 0; y < map->height; ++y)
        for (int x = 0; x < map->width; ++x)
            std::fill_n(map->at(x, y), 3, float(radiance(x, y)));
    scene.environment.emplace().map = map;
    scene.environment->intensity = 0.25f; // colours are means of d over the sphere then
    views::samplingOf(scene).directions = kDirections;
}

double xOf(const Scene& scene, int column) { return (column + 0.5) / scene.size.x - 0.5; }
double yOf(const Scene& scene, int row) { return (0.5 * scene.size.y - row - 0.5) / scene.size.x; }

// --- level fields: the way of light ends at the surface or at the border's wall, whichever is nearer

enum class Part { Middle, Whole }; // Middle: where the way ends at the surface

Finding levelField(Studio& studio, ivec2 size, double elevation, double azimuth, Part part,
                   std::initializer_list<float> depths) {
    Finding finding;
    const double sine = std::sin(elevation * kDegree), cosine = std::cos(elevation * kDegree);
    const double texel = 1.0 / size.x;
    for (const float depth : depths) {
        Scene scene = sceneOf(level(size), 0.2f, depth);
        scene.lights.push_back(lampAt(elevation, azimuth));
        const Image d = studio.draw(scene);
        const bool isLimit = depth < 0.5 * texel;
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                const double border =
                    azimuth == 0 ? 0.5 - xOf(scene, x) : 0.5 * size.y * texel - yOf(scene, y);
                const double toSurface = depth / sine, toBorder = border / cosine;
                const bool isMiddle = isLimit || toSurface <= toBorder;
                const double expected = isMiddle ? sine : std::min(1.0, depth / toBorder);
                if (isMiddle || part == Part::Whole) finding.take(expected, d.at(x, y)[0]);
            }
        }
    }
    return finding;
}

template <int Elevation>
Finding elevation(Studio& studio) {
    return levelField(studio, {64, 4}, Elevation, 0, Part::Middle, {1e-6f, 0.02f});
}
Finding lowLight(Studio& studio) { return levelField(studio, {64, 4}, 0.1, 0, Part::Middle, {1e-6f}); }
Finding levelLight(Studio& studio) { return levelField(studio, {64, 4}, 0, 0, Part::Whole, {0.02f}); }
Finding border(Studio& studio) { return levelField(studio, {64, 4}, 10, 0, Part::Whole, {0.02f, 0.1f}); }
Finding deep(Studio& studio) { return levelField(studio, {64, 4}, 30, 0, Part::Whole, {10.0f}); }
Finding oneTexel(Studio& studio) { return levelField(studio, {1, 1}, 30, 0, Part::Whole, {0.2f, 0.6f}); }
Finding oneRow(Studio& studio) { return levelField(studio, {33, 1}, 30, 0, Part::Whole, {1e-6f, 0.02f}); }
Finding oneColumn(Studio& studio) { return levelField(studio, {1, 33}, 30, 90, Part::Whole, {0.2f, 0.6f}); }

// A point light above, on or under a level surface at 0.1 m, seen from points t below it.
Finding pointLight(Studio& studio, dvec3 place) {
    constexpr double depth = 0.02, surface = 0.1;
    Finding finding;
    Scene scene = sceneOf(level({32, 32}), 0.2f, float(depth));
    scene.lights.emplace_back(scene::PointLight{.position = vec3(place)});
    const Image d = studio.draw(scene);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            const dvec3 from(xOf(scene, x), yOf(scene, y), surface - depth);
            const dvec3 way = place - from;
            const double inside = place.z > surface ? depth / way.z : 1; // share of the way
            const dvec3 end = from + inside * way;
            if (std::max(std::abs(end.x), std::abs(end.y)) > 0.5) continue; // leaves through a wall
            finding.take(std::min(1.0, depth / (inside * glm::length(way))), d.at(x, y)[0]);
        }
    }
    return finding;
}

Finding overATexel(Studio& studio) { return pointLight(studio, {0.5 / 32, 0.5 / 32, 1}); }
Finding justAbove(Studio& studio) { return pointLight(studio, {0, 0, 0.1 + 1e-4}); }
Finding farAway(Studio& studio) { return pointLight(studio, {3e5, -4e5, 1e6}); }
Finding inTheSolid(Studio& studio) { return pointLight(studio, {0, 0, 0.05}); }
Finding underTheField(Studio& studio) { return pointLight(studio, {0, 0, -0.5}); }

// --- slopes and shadows

template <int TenthsOfSlope>
Finding slope(Studio& studio) {
    constexpr double rise = TenthsOfSlope / 10.0; // metres a metre along x
    Scene scene =
        sceneOf(heightsOf({64, 32}, [](int x, int) { return (float(x) + 0.5f) / 64; }), float(rise), 0.02f);
    const scene::DistantLight lamp = lampAt(70, 150);
    scene.lights.push_back(lamp);
    const double cosine = glm::dot(glm::normalize(dvec3(-rise, 0, 1)), -dvec3(lamp.direction));
    const Image d = studio.draw(scene);
    Finding finding;
    for (int y = 12; y < 20; ++y) // away from the border: the outer half texel is level
        for (int x = 24; x < 40; ++x)
            finding.take(cosine, d.at(x, y)[0]);
    return finding;
}

// A ridge of 0.1 m over columns 30 to 33 of 64, lit from -x at 45 degrees: 6 texels behind it are dark.
Image ridge(Studio& studio) {
    Scene scene =
        sceneOf(heightsOf({64, 4}, [](int x, int) { return x >= 30 && x <= 33 ? 1.0f : 0.0f; }), 0.1f, 1e-6f);
    scene.lights.push_back(lampAt(45, 180));
    return studio.draw(scene);
}

Finding litOnes(Studio& studio) {
    const Image d = ridge(studio);
    Finding finding;
    for (int x = 0; x < 64; ++x)
        if (x < 28 || x > 41) finding.take(std::numbers::sqrt2 / 2, d.at(x, 2)[0]);
    return finding;
}

Finding shadedOnes(Studio& studio) {
    const Image d = ridge(studio);
    Finding finding;
    for (int x = 36; x <= 38; ++x)
        finding.take(0, d.at(x, 2)[0]);
    return finding;
}

// Sixteen spikes of one texel, one at each place that a block of 4 x 4 cells has, and the pixels behind them.
Finding spikes(Studio& studio) {
    const auto isSpike = [](int x, int y) { return x % 16 == 4 + y / 16 && y % 16 == 4 + x / 16; };
    Scene scene =
        sceneOf(heightsOf({64, 64}, [&](int x, int y) { return isSpike(x, y) ? 1.0f : 0.0f; }), 0.1f, 1e-6f);
    scene.lights.push_back(lampAt(45, 180));
    const Image d = studio.draw(scene);
    double shaded = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 61; ++x)
            if (isSpike(x, y)) shaded += d.at(x + 3, y)[0] == 0;
    Finding finding;
    finding.take(16, shaded);
    return finding;
}

Finding addedBlocker(Studio& studio) {
    Scene scene = sceneOf(waves({32, 32}), 0.1f, 0.03f);
    scene.lights.push_back(lampAt(20, 0));
    const Image before = studio.draw(scene);
    auto higher = std::make_shared<Image>(*scene.objects[0].field().heights);
    *higher->at(24, 16) = 2;
    scene.objects[0].field().heights = higher;
    const Image after = studio.draw(scene);
    Finding finding;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
            if (std::max(std::abs(x - 24), std::abs(y - 16)) > 1) // their own normals do not change
                finding.take(0, std::max(0.0f, after.at(x, y)[0] - before.at(x, y)[0]));
    finding.take(1, after.at(20, 16)[0] < before.at(20, 16)[0]); // before it something does get darker
    return finding;
}

// --- turning

Finding difference(const Image& a, const Image& b) {
    Finding finding;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        finding.take(0, std::abs(a.pixels[i] - b.pixels[i]));
    return finding;
}

Finding lightAndField(Studio& studio) {
    Scene scene = sceneOf(waves({48, 48}), 0.2f, 0.04f);
    scene.lights.push_back(lampAt(25, 10));
    const Image before = studio.draw(scene);
    const Heights map = scene.objects[0].field().heights;
    // A quarter turn to the left: the texel at column x, row y goes to column y, row 47 - x.
    Scene turned =
        sceneOf(heightsOf({48, 48}, [&](int x, int y) { return *map->at(47 - y, x); }), 0.2f, 0.04f);
    turned.lights.push_back(lampAt(25, 100));
    const Image after = studio.draw(turned);
    Finding finding;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x)
            finding.take(0, std::abs(after.at(y, 47 - x)[0] - before.at(x, y)[0]));
    return finding;
}

void turnEverything(Scene& scene) {
    scene.objects[0].transform.rotate = {0, 0, 90};
    scene.environment->rotation = {0, 0, 90};
    scene.camera.up = {-1, 0, 0};
}

Finding everything(Studio& studio) {
    Scene scene = sceneOf(waves({16, 16}), 0.2f, 0.08f);
    addSky(scene, [](int x, int y) { return (3 * x + 5 * y) % 7 / 7.0; });
    const Image before = studio.draw(scene, Aov::Color);
    turnEverything(scene);
    return difference(studio.draw(scene, Aov::Color), before);
}

Finding environmentAndCamera(Studio& studio) {
    Scene scene = sceneOf(level({16, 16}), 0.2f, 1e-6f);
    addSky(scene, [](int x, int y) { return (3 * x + 5 * y) % 7 / 7.0; });
    const Image before = studio.draw(scene, Aov::Color);
    scene.environment->rotation = {0, 0, 90};
    scene.camera.up = {-1, 0, 0};
    return difference(studio.draw(scene, Aov::Color), before);
}

double mean(const Image& image) {
    double sum = 0;
    for (std::size_t i = 0; i < image.pixels.size(); i += 4)
        sum += image.pixels[i];
    return 4 * sum / double(image.pixels.size());
}

// Turned about a level field's normal.
Finding fullTurnOf(Studio& studio, Scene scene) {
    addSky(scene, [](int x, int) { return x / 32.0; });
    const double before = mean(studio.draw(scene, Aov::Color));
    Finding finding;
    for (const float degrees : {45.0f, 90.0f, 180.0f, 270.0f, 360.0f}) {
        scene.environment->rotation = {0, 0, degrees};
        finding.take(before, mean(studio.draw(scene, Aov::Color)));
    }
    return finding;
}

Finding fullTurn(Studio& studio) { return fullTurnOf(studio, sceneOf(level({4, 4}), 0.2f, 1e-6f)); }

// --- light from all around. The map's poles are turned to the field's normal. With 16 rings of height a = pi
// / 16 the sum over their middles is 1 / cos(a / 2) times the integral: that is how far the quadrature stands
// off.
constexpr double kRingError = 0.0048385; // 1 / cos(pi / 32) - 1

template <class Function>
double underSky(Studio& studio, Aov aov, const Function& radiance) {
    Scene scene = sceneOf(level({4, 4}), 0.2f, 1e-6f);
    addSky(scene, radiance);
    scene.environment->rotation = {90, 0, 0}; // +y to +z
    return mean(studio.draw(scene, aov));
}

Finding wholeSphere(Studio& studio) {
    Finding finding;
    for (const Aov aov : {Aov::Color, Aov::Illumination})
        finding.take(0.25, underSky(studio, aov, [](int, int) { return 1; }));
    return finding;
}

Finding upperHalf(Studio& studio) {
    Finding finding;
    finding.take(
        0.5, 2 * underSky(studio, Aov::Color, [](int, int y) { return y < 8; })); // half of all directions
    return finding;
}

// --- transfer: an environment's light by one dot product a texel

Scene transferredSceneOf(const Heights& heights, float depth) {
    Scene scene = sceneOf(heights, 0.2f, depth);
    settingsOf(scene).method = Method::Transfer;
    settingsOf(scene).terms = 16;
    return scene;
}

// The same image each time: draws that follow one another share its transfer, which takes most of their time.
Scene transferredWaves() {
    static const Heights heights = waves({8, 8});
    return transferredSceneOf(heights, 1e-6f);
}

Finding transferOfWhite(Studio& studio) {
    Scene scene = transferredSceneOf(level({4, 4}), 1e-6f);
    addSky(scene, [](int, int) { return 1; });
    Finding finding;
    finding.take(0.25, mean(studio.draw(scene, Aov::Color)));
    return finding;
}

double distanceOverMean(const Image& image, const Image& reference) {
    double squares = 0, sum = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (i % 4 == 3) continue; // coverage
        squares += std::pow(double(image.pixels[i]) - double(reference.pixels[i]), 2);
        sum += reference.pixels[i];
    }
    return std::sqrt(squares * 0.75 * double(image.pixels.size())) / sum;
}

Finding transferTurned(Studio& studio) {
    Scene scene = transferredWaves();
    addSky(scene, [](int x, int y) { return (3 * x + 5 * y) % 7 / 7.0; });
    const Image before = studio.draw(scene, Aov::Color);
    turnEverything(scene);
    return difference(studio.draw(scene, Aov::Color), before);
}

Finding transferOfRainbow(Studio& studio) {
    Scene scene = transferredWaves();
    scene.environment.emplace().map = std::make_shared<const Image>(scene::proceduralEnvironment("rainbow"));
    const Image transferred = studio.draw(scene, Aov::Color);
    settingsOf(scene).method = Method::Hierarchy;
    views::samplingOf(scene).directions = 4096;
    Finding finding;
    finding.take(0, distanceOverMean(transferred, studio.draw(scene, Aov::Color)));
    return finding;
}

Finding transferFullTurn(Studio& studio) {
    return fullTurnOf(studio, transferredSceneOf(level({4, 4}), 1e-6f));
}

// --- lamps with a size: points evenly on a disc of radius R that faces what it lights, at a distance D. The
// cosine at a level surface is (h + z) / sqrt(D^2 + rho^2), with h the height of the disc's centre and z that
// of a point at rho above it. z cancels out; the mean of 1 / sqrt(D^2 + rho^2) over the disc is 2 (sqrt(D^2 +
// R^2) - D) / R^2. A sun has D = 1, R = tan(angle / 2), h = sin(elevation).

constexpr int kLampPoints = 1024;

double meanCosine(double height, double distance, double radius) {
    return height * 2 * (std::hypot(distance, radius) - distance) / (radius * radius);
}

scene::DistantLight largeSun(double elevation, double azimuth) {
    scene::DistantLight sun = lampAt(elevation, azimuth);
    sun.angle = 40;
    return sun;
}
const double kSunRadius = std::tan(20 * kDegree);

Finding sunOnLevelField(Studio& studio) {
    Scene scene = sceneOf(level({16, 16}), 0.2f, 0.02f);
    views::samplingOf(scene).lamp = kLampPoints;
    scene.lights.push_back(largeSun(60, 0));
    const Image d = studio.draw(scene);
    const double expected = meanCosine(std::sin(60 * kDegree), 1, kSunRadius);
    Finding finding;
    for (int y = 2; y < 14; ++y) // ways end at the surface within 0.02 m / tan(40 degrees), 0.4 texels
        for (int x = 2; x < 14; ++x)
            finding.take(expected, d.at(x, y)[0]);
    return finding;
}

Finding lampOnLevelField(Studio& studio) {
    constexpr double depth = 0.02, height = 0.5; // of the lamp over the surface
    constexpr float radius = 0.3f;
    Scene scene = sceneOf(level({16, 16}), 0.2f, float(depth));
    views::samplingOf(scene).lamp = kLampPoints;
    scene.lights.emplace_back(scene::PointLight{.position = {0.1f, 0, 0.1 + height}, .radius = radius});
    const Image d = studio.draw(scene);
    Finding finding;
    for (int y = 2; y < 14; ++y) {
        for (int x = 2; x < 14; ++x) {
            const dvec3 way = dvec3(double(0.1f), 0, height + depth) - dvec3(xOf(scene, x), yOf(scene, y), 0);
            finding.take(meanCosine(way.z, glm::length(way), double(radius)), d.at(x, y)[0]);
        }
    }
    return finding;
}

// A cliff of 4 texels at the middle of column 15, the sun's centre behind it 45 degrees high. From a texel
// `way` texels off the edge cuts the disc in a straight line, tan(elevation of the edge - 45 degrees) above
// its centre; what is beyond is a segment of the disc.
Finding penumbra(Studio& studio) {
    constexpr int size = 32, edge = 15, drop = 4;
    Scene scene = sceneOf(heightsOf({size, size}, [](int x, int) { return x <= edge ? 1.0f : 0.0f; }),
                          float(drop) / size, 1e-6f);
    views::samplingOf(scene).lamp = kLampPoints;
    scene.lights.push_back(largeSun(45, 180));
    const Image visible = studio.draw(scene, Aov::Visibility);
    Finding finding;
    for (int way = 2; way <= 2 * drop; ++way) { // farther, light would come in beside the cliff
        const double line = std::tan(std::atan2(drop, way) - 45 * kDegree) / kSunRadius;
        const double s = std::clamp(line, -1.0, 1.0);
        const double share = (std::acos(s) - s * std::sqrt(1 - s * s)) / std::numbers::pi;
        finding.take(share, visible.at(edge + way, size / 2)[0]);
    }
    return finding;
}

// --- colours

Finding lightsAdd(Studio& studio) {
    Scene scene = sceneOf(level({4, 4}), 0.2f, 1e-6f);
    scene.objects[0].material.base = vec3(0.1f);
    scene.objects[0].material.diffuse = vec3(0.5f);
    scene.lights = {lampAt(30, 0), lampAt(50, 200)};
    const Image color = studio.draw(scene, Aov::Color);
    Finding finding;
    for (std::size_t i = 0; i < color.pixels.size(); i += 4)
        finding.take(0.1 + 0.5 * (0.5 + std::sin(50 * kDegree)), color.pixels[i]);
    return finding;
}

Finding inverseSquare(Studio& studio) {
    constexpr double depth = 1e-6;
    Scene scene = sceneOf(level({1, 1}), 0, float(depth));
    scene.objects[0].field().width = 1e-3f;
    scene.camera.height = 1e-3f;
    Finding finding;
    for (const float distance : {0.5f, 2.0f}) {
        scene.lights = {scene::PointLight{
            .position = {0, 0, distance}, .intensity = kPi, .falloff = scene::LightFalloff::InverseSquare}};
        const double far = distance + depth; // from the point below the surface
        finding.take(1, far * far * studio.draw(scene, Aov::Color).pixels[0]);
    }
    return finding;
}

Finding exponential(Studio& studio) {
    Scene scene = sceneOf(level({64, 4}), 0.2f, 0.02f);
    settingsOf(scene).attenuation = Attenuation::Exponential;
    scene.lights.push_back(lampAt(30, 0));
    const Image d = studio.draw(scene);
    Finding finding;
    for (int x = 0; x < 60; ++x) // r = t / sin(30 degrees) up to 0.035 m from the border: 2.2 texels
        finding.take(std::exp(-1.0), d.at(x, 2)[0]);
    return finding;
}

Finding emptyFalloff(Studio& studio) {
    Scene scene = sceneOf(waves({16, 16}), 0.2f, 0.05f);
    scene.objects[0].material.relief().specularity = 1;
    scene.objects[0].material.relief().specularFalloff = {0.8f, 0.8f};
    scene.lights.push_back(lampAt(60, 0));
    const Image color = studio.draw(scene, Aov::Color);
    Finding finding;
    for (std::size_t i = 0; i < color.pixels.size(); i += 4)
        finding.take(color.pixels[i] >= 0.5f, color.pixels[i]);
    return finding;
}

double encoded(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

// Level light fades with the way to the border; three diffuse colours spread it from 0.001 to 1.
Finding displayCurve(Studio& studio) {
    constexpr double depth = 0.02;
    const dvec3 diffuse(1, 0.2, 0.05);
    Scene scene = sceneOf(level({64, 4}), 0.2f, float(depth));
    scene.objects[0].material.diffuse = vec3(diffuse);
    scene.lights.push_back(lampAt(0, 0));
    const Image shown = studio.display(scene);
    Finding finding;
    for (int x = 0; x < 64; ++x)
        for (int channel = 0; channel < 3; ++channel) {
            const double d = std::min(1.0, depth / (0.5 - xOf(scene, x)));
            finding.take(255 * encoded(d * diffuse[channel]), 255 * double(shown.at(x, 2)[channel]));
        }
    return finding;
}

// --- places

Finding places(Studio& studio) {
    const Scene scene = sceneOf(waves({32, 24}), 0.3f, 0.05f);
    const Image position = studio.draw(scene, Aov::Position);
    Finding finding;
    for (int y = 0; y < 24; ++y) {
        for (int x = 0; x < 32; ++x) {
            finding.take(xOf(scene, x), position.at(x, y)[0]);
            finding.take(yOf(scene, y), position.at(x, y)[1]);
            finding.take(0.3f * *scene.objects[0].field().heights->at(x, y), position.at(x, y)[2]);
        }
    }
    return finding;
}

// Cliffs, spikes, no height, huge height, under lights above, level, inside, below, near and far at once.
// Whether the values are right is asked elsewhere; here they must be values.
Finding hardCases(Studio& studio) {
    const Heights maps[] = {
        heightsOf({32, 16}, [](int x, int) { return x < 16 ? 1.0f : 0.0f; }),
        heightsOf({32, 16}, [](int x, int y) { return x % 8 == 3 && y % 8 == 5 ? 1.0f : 0.0f; }),
        heightsOf({37, 23}, [](int x, int y) { return float((x * 7 + y * 3) % 11) / 11; }),
        heightsOf({1, 33}, [](int, int y) { return float(y % 5) / 5; }),
    };
    for (const Heights& map : maps) {
        for (const vec2 sizes : {vec2(0.3f, 0.05f), vec2(0, 0.05f), vec2(1e4f, 10), vec2(0.3f, 1e-6f)}) {
            Scene scene = sceneOf(map, sizes.x, sizes.y);
            for (const double elevation : {90.0, 0.1, 0.0, -30.0})
                scene.lights.push_back(lampAt(elevation, 20));
            for (const vec3 place : {vec3(0, 0, 0.01f), vec3(0, 0, -0.3f), vec3(1e-4f), vec3(1e6f)})
                scene.lights.emplace_back(scene::PointLight{.position = place});
            studio.draw(scene, Aov::Color);
        }
    }
    Finding finding;
    finding.take(0, studio.brokenValues());
    return finding;
}

// --- the table

// How far rounding may lead, and why. Rounding on both software drivers stays five times
// nearer; GPUs divide less exactly.
constexpr Tolerance kExact{0, "nothing is rounded"};
constexpr Tolerance kVectors{1e-6, "a dozen roundings of 6e-8"};
constexpr Tolerance kPlaces{4e-6, "places are rounded to 6e-8 m, t is 0.02 m: 3e-6"};
constexpr Tolerance kSteep{1e-5, "places are rounded to 6e-8 m, t is 0.02 m, slopes are up to 3: 9e-6"};
constexpr Tolerance kSum{3e-6, "326 terms, each rounded to 6e-8 of a sum of 0.12: 2.3e-6"};
constexpr Tolerance kQuarter{0.25 * kRingError + 3e-6,
                             "16 rings of directions are off by 1 / cos(pi / 32) - 1"};
constexpr Tolerance kHalf{0.5 * kRingError + 6e-6, "16 rings of directions are off by 1 / cos(pi / 32) - 1"};
// A transfer tells 28 rings of directions apart and keeps half floats.
constexpr double kTransferError = 0.0016 + 0.001; // 1 / cos(pi / 56) - 1; two stores of 2^-11
constexpr Tolerance kTransferred{0.25 * kTransferError,
                                 "28 rings of directions are off by 0.16 %, half floats by 0.1 %"};
constexpr Tolerance kTransferTurned{0.12 * (kTransferError + 0.0016),
                                    "28 rings are off by 0.16 % before and after, half floats by 0.1 %"};
constexpr Tolerance kCell{1.0 / 16384, "one of 16384 parts of the environment may fall to the next cell"};
constexpr Tolerance kPercent{0.01, "what the method is made for: 1 % of the mean"};
// The points' mean lies at most 2 / (2 sin(golden angle / 2)) / 1024 radii off the centre (summation by
// parts); times R cos(elevation) / D, which is at most 0.3 below.
constexpr Tolerance kSpiral{0.3 * 1.073 / kLampPoints + 4e-6,
                            "the mean of the lamp's 1024 points is 1/950 of its radius off at most"};
constexpr Tolerance kCut{8.0 / kLampPoints, "a straight cut miscounts at most 8 of the sun's 1024 points"};
constexpr Tolerance kCode{1, "a driver may round to the nearest code or cut off"};

constexpr std::string_view kSine =
    "On a level field d is the sine of the light's elevation, for every depth t";
constexpr std::string_view kWall = "Near the border d is t over the way to the wall, at most 1";
constexpr std::string_view kCosine = "On a plane d is n.l, for every slope";
constexpr std::string_view kPoint = "On a level field d is t over the part of the way to the light inside";
constexpr std::string_view kTurned = "Largest change when what is turned together is turned by 90 degrees";

constexpr Check kChecks[] = {
    {"Level field, light at 90 degrees", kSine, kPlaces, elevation<90>},
    {"Level field, light at 60 degrees", kSine, kPlaces, elevation<60>},
    {"Level field, light at 30 degrees", kSine, kPlaces, elevation<30>},
    {"Level field, light at 10 degrees", kSine, kPlaces, elevation<10>},
    {"Level field, light at 0.1 degrees", kSine, kVectors, lowLight},
    {"Level field, light at 0 degrees", kWall, kPlaces, levelLight},
    {"Level field, at its border", kWall, kPlaces, border},
    {"Level field, t = 10 m", kWall, kVectors, deep},
    {"Field of one texel", kWall, kVectors, oneTexel},
    {"Field of one row", kWall, kPlaces, oneRow},
    {"Field of one column", kWall, kVectors, oneColumn},
    {"Plane of slope 0.1", kCosine, kSteep, slope<1>},
    {"Plane of slope 0.5", kCosine, kSteep, slope<5>},
    {"Plane of slope 1", kCosine, kSteep, slope<10>},
    {"Plane of slope 3", kCosine, kSteep, slope<30>},
    {"t = 1e-6 m, in the light", "As t goes to 0, d is Lambert's cosine where light arrives", kVectors,
     litOnes},
    {"t = 1e-6 m, in the shadow", "As t goes to 0, d is 0 in the shadow", kExact, shadedOnes},
    {"Spikes of one texel", "Each of 16 spikes, anywhere in the blocks of the pyramid, throws its shadow",
     kExact, spikes},
    {"Lamp over a texel", kPoint, kPlaces, overATexel},
    {"Lamp 0.1 mm above", kPoint, kPlaces, justAbove},
    {"Lamp 1000 km away", kPoint, kPlaces, farAway},
    {"Lamp in the solid", kPoint, kPlaces, inTheSolid},
    {"Lamp under the field", kPoint, kPlaces, underTheField},
    {"White sphere around", "The mean of d over all directions is 1/4 on a level field", kQuarter,
     wholeSphere},
    {"White upper half", "The mean of d over the upper half is 1/2 on a level field", kHalf, upperHalf},
    {"Environment around its turn", "Turned about a level field's normal it keeps the mean", kSum, fullTurn},
    {"Light and field turned", kTurned, kSteep, lightAndField},
    {"Environment and camera turned", kTurned, kSum, environmentAndCamera},
    {"Field, environment, camera turned", kTurned, kSteep, everything},
    {"Transfer, white sphere", "Method transfer: the mean of d over all directions is 1/4 on a level field",
     kTransferred, transferOfWhite},
    {"Transfer, all turned", kTurned, kCell, transferTurned},
    {"Transfer, rainbow", "Its RMSE over the mean, against 4096 directions by hierarchy", kPercent,
     transferOfRainbow},
    {"Transfer, environment turned", "About a level field's normal it keeps the mean", kTransferTurned,
     transferFullTurn},
    {"Sun 40 degrees wide", "On a level field d is the mean cosine over its disc", kSpiral, sunOnLevelField},
    {"Lamp 0.6 m wide", "On a level field d is the mean cosine over its disc", kSpiral, lampOnLevelField},
    {"Penumbra behind a cliff", "The part of the sun's disc that stands above the edge", kCut, penumbra},
    {"Blocker added", "Nothing outside its neighbours gets brighter", kPlaces, addedBlocker},
    {"Two lights and a base", "Lights add, the base colour counts once: 0.1 + 0.5 (sin 30 + sin 50)",
     kVectors, lightsAdd},
    {"Fall with distance", "Light times the squared distance stays the same", kVectors, inverseSquare},
    {"Exponential attenuation", "e^(1 - r / t) with r = 2 t", kPlaces, exponential},
    {"Empty range of a falloff", "It is a step: every value is 0 or 1", kExact, emptyFalloff},
    {"sRGB curve", "Codes of 8 bits by the formula of IEC 61966-2-1", kCode, displayCurve},
    {"Positions", "Every pixel seen from above is its texel", kVectors, places},
    {"No NaN, no infinity", "Values that are none, in all pictures above and those of hard cases", kExact,
     hardCases},
};

} // namespace

extern const Forms kForms;
const Forms kForms{kChecks};

} // namespace lucent::relief
