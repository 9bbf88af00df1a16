#include "scene/Keys.h"
#include "truth/LightTracer.h"

#include "truth/Part.h"

#include "tests/truth/fields.h"
#include "tests/truth/scenes.h"

#include <functional>
#include <numeric>

namespace lucent::truth {
namespace {
using test::glass;
using test::matt;
using test::mirror;
using test::sceneOf;

constexpr double kPi = std::numbers::pi;
const std::atomic<bool> kGoOn = false;

/// A floor through the origin, seen straight down, `height` metres from top to bottom.
scene::Scene floorUnder(scene::Object object, float height) {
    object.visible = false;
    scene::Scene scene = sceneOf({matt(scene::Plane{{40, 40}}), std::move(object)});
    scene.camera.eye = {0, 20, 0};
    scene.camera.target = {0, 0, 0};
    scene.camera.up = {0, 0, -1};
    scene.camera.height = height;
    return scene;
}

Picture traced(const scene::Scene& scene, ivec2 size, const LightOptions& options, const Tile& part = {},
               int threads = 0) {
    Result<Picture> picture = traceLight(scene, size, options, part, {.threads = threads}, kGoOn);
    EXPECT_TRUE(picture.ok());
    return *picture;
}

/// Mean of the squared differences in standard errors over the pixels that light rays met; 1 by chance alone.
double chiSquare(const Picture& picture, const std::function<double(int, int)>& expected) {
    double sum = 0;
    int count = 0;
    for (int y = 0; y < picture.values.height; ++y)
        for (int x = 0; x < picture.values.width; ++x) {
            const double error = double(picture.errors.at(x, y)[1]);
            if (error == 0) continue;
            const double off = (double(picture.values.at(x, y)[1]) - expected(x, y)) / error;
            sum += off * off;
            ++count;
        }
    EXPECT_GT(count, 0);
    return sum / count;
}

double total(const dvec3& flux) { return flux.r + flux.g + flux.b; }

void expectClosed(const EnergyBook& energy) {
    const double others = total(energy.received) + total(energy.absorbed) + total(energy.reflected) +
                          total(energy.escaped) + total(energy.lost);
    EXPECT_NEAR(others, total(energy.incident), 1e-9 * total(energy.incident)); // rounding of a million terms
}

/// Where a ray that meets a ball of radius 1 at `b` from its axis lands on a floor `below` its centre, and
/// what is left of it.
struct Landing {
    double radius, kept;
    Landing(double b, double n, double below) {
        const double i = std::asin(b), t = std::asin(b / n), deviation = 2 * (i - t);
        radius = std::sin(2 * t - i) - std::tan(deviation) * (below - std::cos(2 * t - i));
        const double transmitted = 1 - test::fresnel(i, 1 / n);
        kept = transmitted * transmitted;
    }
};

TEST(LightTracer, AGlassBallLightsTheFloorAsTheSumOverItsBranches) {
    // E / E0 = sum of T(b)² b |db| / (r |dr|): every ring of the beam goes to the pixels that its light
    // meets.
    const double n = 1.5, below = 1.2;
    scene::Scene scene = floorUnder(glass(scene::Sphere{1}, 1.5f, {0, 1.2f, 0}), 1);
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}, .irradiance = 2}};
    constexpr int kSize = 16;
    std::vector<double> expected(kSize * kSize, 0);
    constexpr int kRings = 3000, kSectors = 1200;
    for (int ring = 0; ring < kRings; ++ring) {
        const double b = (ring + 0.5) / kRings;
        const Landing landing(b, n, below);
        if (b > 0.99 && std::tan(2 * (std::asin(b) - std::asin(b / n))) < 0) continue; // sideways at most
        const double flux = 2 * landing.kept * 2 * kPi * b / kRings / kSectors;
        for (int sector = 0; sector < kSectors; ++sector) {
            const double angle = 2 * kPi * (sector + 0.5) / kSectors;
            const int x = int(std::floor((landing.radius * std::cos(angle) + 0.5) * kSize));
            const int y = int(std::floor((landing.radius * std::sin(angle) + 0.5) * kSize));
            if (x >= 0 && y >= 0 && x < kSize && y < kSize)
                expected[std::size_t(y * kSize + x)] += flux * kSize * kSize;
        }
    }
    const Picture picture = traced(scene, {kSize, kSize}, {.photons = 400000, .seed = 3});
    const auto at = [&](int x, int y) { return expected[std::size_t(y * kSize + x)]; };
    // 256 pixels: the mean of as many squares strays by sqrt(2 / 256) = 0.09.
    EXPECT_NEAR(chiSquare(picture, at), 1, 0.4);
    double found = 0, wanted = 0;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            found += double(picture.values.at(x, y)[1]);
            wanted += at(x, y);
        }
    EXPECT_NEAR(found, wanted, 0.005 * wanted);
    EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 20); // a focus
    expectClosed(*picture.energy);
    // Every ray aimed at the ball meets it: pi R² E.
    EXPECT_NEAR(picture.energy->incident.g, 2 * kPi, 1e-9);
}

/// Light that passes it comes by rays, and in direction and strength hardly changed.
scene::Object almostNothing(scene::Shape shape, vec3 centre) {
    scene::Object object = glass(std::move(shape), 1.0001f, centre);
    object.material.clear().fresnel = false;
    return object;
}

TEST(LightTracer, AnIndexOfOneIsThePictureWithoutTheObjectToTheBit) {
    scene::Scene scene = floorUnder(glass(scene::Sphere{0.5f}, 1, {0.2f, 0.8f, 0.1f}), 3);
    scene.lights = {scene::PointLight{.position = {0.3f, 2, 0.5f}}};
    scene::Scene empty = scene;
    empty.objects.resize(1);
    const ivec2 size(16, 16);
    for (const scene::Aov aov : {scene::Aov::Irradiance, scene::Aov::Color}) {
        const LightOptions options{.aov = aov, .photons = 20000};
        const Picture plain = traced(empty, size, options), picture = traced(scene, size, options);
        EXPECT_EQ(picture.values.pixels, plain.values.pixels);
        EXPECT_EQ(picture.errors.pixels, plain.errors.pixels);
        EXPECT_EQ(picture.energy->incident, dvec3(0)); // direct light passes it: rays bring none twice
    }
}

TEST(LightTracer, LightThatPassesAnIndexOfOneIsNotBroughtTwiceBesideGlass) {
    // A second ball that bends light makes rays aim at both.
    scene::Scene scene = floorUnder(glass(scene::Sphere{0.3f}, 1, {-0.5f, 0.8f, 0}), 3);
    scene.objects.push_back(glass(scene::Sphere{0.3f}, 1.5f, {20, 0.8f, 0}));
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}, .irradiance = 2}};
    const Picture picture = traced(scene, {16, 16}, {.photons = 20000});
    for (int i = 0; i < 256; ++i)
        EXPECT_NEAR(picture.values.at(i % 16, i / 16)[1], 2, 1e-6);
}

TEST(LightTracer, AnIndexOfAlmostOneLightsTheFloorAsIfNothingWereThere) {
    scene::Scene scene = floorUnder(almostNothing(scene::Sphere{0.5f}, {0.2f, 0.8f, 0.1f}), 3);
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {2, 3, 1};
    scene.lights = {scene::PointLight{.position = {0.3f, 2, 0.5f},
                                      .intensity = 5,
                                      .falloff = scene::LightFalloff::InverseSquare},
                    scene::SpotLight{.position = {-1, 3, 0}, .direction = {0.3f, -1, 0}, .intensity = 20}};
    const auto compare = [&](double& found, double& wanted) {
        scene::Scene empty = scene;
        empty.objects.resize(1);
        const ivec2 size(24, 24);
        const Picture plain = traced(empty, size, {.photons = 1});
        const Picture picture = traced(scene, size, {.photons = 1000000});
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                found += double(picture.values.at(x, y)[1]);
                wanted += double(plain.values.at(x, y)[1]);
            }
        expectClosed(*picture.energy);
        EXPECT_EQ(picture.energy->reflected, dvec3(0));
        EXPECT_NEAR(picture.energy->received.g, picture.energy->incident.g, 1e-9);
        return chiSquare(picture, [&](int x, int y) { return double(plain.values.at(x, y)[1]); });
    };
    // A ball and a block: where a shadow ends inside a pixel its middle is not its mean, so the sum counts.
    scene::Object block = almostNothing(scene::Box{{0.6f, 0.3f, 0.6f}}, {-0.7f, 0.2f, 0});
    block.visible = false;
    scene.objects.push_back(block);
    double found = 0, wanted = 0;
    compare(found, wanted);
    EXPECT_NEAR(found, wanted, 0.01 * wanted);
    // A pane over everything that is seen: every pixel. A spot's edge has no place in it.
    scene.objects.resize(1);
    scene.lights.resize(1);
    scene.objects.push_back(almostNothing(scene::Box{{6, 0.3f, 6}}, {0, 0.5f, 0}));
    scene.objects[1].visible = false;
    found = wanted = 0;
    EXPECT_NEAR(compare(found, wanted), 1, 0.25); // 576 pixels: sqrt(2 / 576) = 0.06 by chance
    EXPECT_NEAR(found, wanted, 0.01 * wanted);
}

TEST(LightTracer, LightsWithASizeShineThroughAnIndexOfAlmostOneAsIfNothingWereThere) {
    // The rays of a lamp and the light of its points are two estimates of one thing.
    const scene::Light lights[] = {
        scene::AreaLight{
            .corner = {0.2f, 1.5f, -0.3f}, .edgeU = {0.4f, 0.2f, 0}, .edgeV = {0, 0, 0.5f}, .radiance = 3},
        scene::DistantLight{.direction = {0.3f, -1, 0.2f}, .irradiance = 2, .angle = 20},
        scene::PointLight{.position = {0.4f, 1.8f, 0},
                          .intensity = 2,
                          .falloff = scene::LightFalloff::InverseSquare,
                          .radius = 0.1f},
        scene::SpotLight{.position = {-0.4f, 1.6f, 0.1f},
                         .direction = {0.3f, -1, 0},
                         .intensity = 3,
                         .innerAngle = 10,
                         .outerAngle = 40}};
    for (const scene::Light& light : lights) {
        scene::Scene scene = floorUnder(almostNothing(scene::Box{{2, 0.125f, 2}}, {0, 0.4f, 0}), 1);
        scene.lights = {light};
        scene::Scene empty = scene;
        empty.objects.resize(1);
        const ivec2 size(8, 8);
        const Picture plain = traced(empty, size, {.photons = 1, .samples = 20000});
        const Picture picture = traced(scene, size, {.photons = 400000, .samples = 1});
        double found = 0, wanted = 0, squares = 0;
        for (int i = 0; i < 64; ++i) {
            found += double(picture.values.at(i % 8, i / 8)[1]);
            wanted += double(plain.values.at(i % 8, i / 8)[1]);
            const double error = double(picture.errors.at(i % 8, i / 8)[1]);
            squares += error * error;
        }
        // The middle of a pixel differs from its mean by its curvature; a lamp's disc faces the pane's
        // middle.
        EXPECT_NEAR(found, wanted, 3 * std::sqrt(squares) + 0.005 * wanted) << light.index();
        EXPECT_LT(std::sqrt(squares), 0.01 * wanted);
    }
}

TEST(LightTracer, ASlabShiftsLightAndKeepsItEven) {
    // At 45 degrees through a slab of half a metre: its shadow is filled by light that is T (tan a - tan b)
    // behind, as bright as the floor but for both faces' reflection.
    scene::Scene scene = floorUnder(glass(scene::Box{{10, 0.5f, 4}}, 1.5f, {0, 2, 0}), 1);
    scene.lights = {scene::DistantLight{.direction = {1, -1, 0}, .irradiance = 1}};
    const double a = kPi / 4, b = std::asin(std::sin(a) / 1.5), kept = 1 - test::fresnel(a, 1 / 1.5);
    const double even = std::cos(a) * kept * kept;
    scene.camera.eye.x = scene.camera.target.x = 2; // below the slab, as light comes down
    const Picture middle = traced(scene, {8, 8}, {.photons = 400000});
    EXPECT_NEAR(chiSquare(middle, [&](int, int) { return even; }), 1, 0.6);
    // The last ray through both faces enters T tan b before the slab's end at 5, 2.25 above the floor, and
    // leaves at the end: it lands 1.75 tan a further, not where it was aimed at, T (tan a - tan b) ahead.
    const double last = 5 - 0.5 * std::tan(b), aimed = last + 2.25 * std::tan(a);
    const double landed = aimed - 0.5 * (std::tan(a) - std::tan(b));
    scene.camera.eye.x = scene.camera.target.x = float(landed);
    const Picture border = traced(scene, {2, 8}, {.photons = 400000});
    // Between there and the shadow's end at 7.25 it is dark: what meets the slab's end from above is
    // reflected back, and what comes from its other end would be reflected eleven times before.
    for (int y = 0; y < 8; ++y) {
        EXPECT_NEAR(double(border.values.at(0, y)[1]), even, 5 * double(border.errors.at(0, y)[1]));
        EXPECT_LT(double(border.values.at(1, y)[1]), 0.01 * even);
    }
}

TEST(LightTracer, ARingHasItsCuspAtHalfItsRadius) {
    // Light along x meets the far wall and crosses the axis at R / (2 cos) from the middle, for rays near the
    // axis at R / 2.
    scene::Scene scene = floorUnder(mirror(scene::Cylinder{1, 0.5f, true}, {0, 0.25f, 0}), 0.78f);
    scene.lights = {scene::DistantLight{.direction = {1, -0.5f, 0}, .irradiance = 1}};
    scene.camera.eye.x = scene.camera.target.x = 0.5f;
    constexpr int kSize = 39; // pixels of 2 cm, the middle one around R / 2
    const Picture picture = traced(scene, {kSize, kSize}, {.photons = 1000000});
    ivec2 brightest(0);
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            if (picture.values.at(x, y)[1] > picture.values.at(brightest.x, brightest.y)[1])
                brightest = {x, y};
    EXPECT_NEAR(brightest.x, kSize / 2, 1);
    EXPECT_EQ(brightest.y, kSize / 2);
    expectClosed(*picture.energy);
    EXPECT_GT(picture.energy->received.g, 0);
}

TEST(LightTracer, SineWaterLightsTheFloorAsTheSumOverItsRoots) {
    // Light from above at X meets the slope s = A k cos(k X), is refracted by i - t with tan i = s, and lands
    // at x = X + depth tan(i - t): E / E0 = sum of T |dX / dx|, here gathered in pixels since it folds.
    const double n = double(1.33f), amplitude = double(0.02f), k = 2 * kPi / 0.25, height = 0.5;
    scene::Object water =
        glass(scene::Water{.size = {2, 2}, .amplitude = 0.02f, .wavelength = 0.25f}, 1.33f, {0, 0.5f, 0});
    scene::Scene scene = floorUnder(water, 1);
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}, .irradiance = 1}};
    constexpr int kSize = 40, kRays = 400000;
    std::vector<double> expected(kSize, 0);
    for (int ray = 0; ray < kRays; ++ray) {
        const double at = 2 * (ray + 0.5) / kRays - 1;
        const double incident = std::atan(amplitude * k * std::cos(k * at));
        const double bent = incident - std::asin(std::sin(incident) / n);
        const double landed = at + (height + amplitude * std::sin(k * at)) * std::tan(bent);
        const int column = int(std::floor((landed + 0.5) * kSize));
        if (column >= 0 && column < kSize)
            expected[std::size_t(column)] +=
                (1 - test::fresnel(std::abs(incident), 1 / n)) * 2 * kSize / kRays;
    }
    const Picture picture = traced(scene, {kSize, kSize}, {.photons = 1000000});
    const auto at = [&](int x, int) { return expected[std::size_t(x)]; };
    EXPECT_NEAR(chiSquare(picture, at), 1, 0.15); // 1600 pixels: sqrt(2 / 1600) = 0.035 by chance
    EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 2);
    expectClosed(*picture.energy);
}

TEST(LightTracer, FluxClosesWithAbsorptionDispersionAndRaysThatGetNowhere) {
    scene::Object ball = glass(scene::Sphere{0.5f}, 1.5f, {0, 1, 0});
    ball.material.clear().absorption = scene::absorptionOf({1, {0.9f, 0.5f, 0.1f}});
    ball.material.clear().dispersion = 0.5f;
    ball.material.clear().transmission = 0.9f;
    for (const Branching branching : {Branching::Chain, Branching::Tree}) {
        scene::Scene scene = floorUnder(ball, 2);
        scene.objects.push_back(mirror(scene::Box{{0.2f, 0.2f, 0.2f}}, {0.7f, 0.4f, 0}));
        scene.lights = {
            scene::PointLight{.position = {1, 3, 0}, .falloff = scene::LightFalloff::InverseSquare},
            scene::AreaLight{.corner = {-0.5f, 2, -0.5f}, .edgeU = {1, 0, 0}, .edgeV = {0, 0, 1}}};
        const EnergyBook energy = *traced(scene, {8, 8}, {.branching = branching, .photons = 20000}).energy;
        expectClosed(energy);
        EXPECT_GT(energy.absorbed.b, energy.absorbed.r);
        EXPECT_GT(energy.escaped.g, 0);
        EXPECT_EQ(energy.reflected.g > 0, branching == Branching::Chain);
        EXPECT_GT(energy.received.g, 0.1 * energy.incident.g);
    }
}

TEST(LightTracer, TheFluxThatMeetsABallIsTheLampsOverItsSolidAngle) {
    // I times 2 pi (1 - sqrt(1 - sin²)); of an even disc above, its form factor times its power.
    scene::Scene scene = floorUnder(glass(scene::Sphere{0.5f}, 1.5f, {0, 1, 0}), 2);
    scene.lights = {scene::PointLight{
        .position = {0, 3, 0}, .intensity = 4, .falloff = scene::LightFalloff::InverseSquare}};
    const double cone = 2 * kPi * (1 - std::sqrt(1 - 1 / 16.0));
    EXPECT_NEAR(traced(scene, {4, 4}, {.photons = 1000}).energy->incident.g, 4 * cone, 1e-6);
    // A light that does not fade lights what it meets at d with its plain factor: d² more in every direction.
    std::get<scene::PointLight>(scene.lights[0]).falloff = scene::LightFalloff::None;
    double expected = 0;
    constexpr int kSteps = 100000;
    const double widest = std::asin(0.25);
    for (int i = 0; i < kSteps; ++i) {
        const double angle = widest * (i + 0.5) / kSteps, aside = 2 * std::sin(angle);
        const double distance = 2 * std::cos(angle) - std::sqrt(0.25 - aside * aside);
        expected += 4 * distance * distance * 2 * kPi * std::sin(angle) * widest / kSteps;
    }
    EXPECT_NEAR(traced(scene, {4, 4}, {.photons = 100000}).energy->incident.g, expected, 0.002 * expected);
}

TEST(LightTracer, APlaceThatNoRayMetMayStillBeLit) {
    // A pane lets all light through, as if it were not there. Rays are spread over a disc around it; a pixel
    // is met by four on average, so that one in e⁴ = 55 is not. Three of them would be
    // 3 / photons disc / pixel E.
    scene::Scene scene = floorUnder(almostNothing(scene::Box{{2, 0.5f, 2}}, {0, 1, 0}), 1);
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}, .irradiance = 2}};
    constexpr int kSize = 48;
    const double disc = kPi * (1 + 1 + 0.25 * 0.25), pixel = 1.0 / (kSize * kSize);
    const auto photons = std::int64_t(4 * disc / pixel);
    const auto check = [&](scene::Aov aov, double perIrradiance) {
        const Picture picture = traced(scene, {kSize, kSize}, {.aov = aov, .photons = photons});
        const double bound = 3 / double(photons) * disc / pixel * 2 * perIrradiance;
        int missed = 0;
        for (int i = 0; i < kSize * kSize; ++i) {
            if (picture.values.at(i % kSize, i / kSize)[1] > 0) continue;
            ++missed;
            // The ball around the pane is larger than it must be by as much.
            EXPECT_NEAR(double(picture.errors.at(i % kSize, i / kSize)[1]), bound, 0.002 * bound);
        }
        const double expected = std::exp(-4) * kSize * kSize; // 42, give or take its square root
        EXPECT_NEAR(missed, expected, 4 * std::sqrt(expected));
    };
    check(scene::Aov::Irradiance, 1);
    check(scene::Aov::Color, double(scene.objects[0].material.diffuse.g) / kPi);
    // Where nothing can be lit there is no doubt.
    scene.objects[0].visible = false;
    for (const float error : traced(scene, {4, 4}, {.photons = 10}).errors.pixels)
        EXPECT_EQ(error, 0);
}

TEST(LightTracer, TheSkyLightsTheFloorStraight) {
    scene::Scene scene = sceneOf({matt(scene::Plane{{1, 1}})});
    scene.camera.eye = {0, 5, 0};
    scene.camera.target = {0, 0, 0};
    scene.camera.up = {0, 0, -1};
    scene.camera.height = 0.5f;
    test::addSky(scene, vec3(1));
    EXPECT_NEAR(chiSquare(traced(scene, {16, 16}, {.samples = 64}), [](int, int) { return kPi; }), 1,
                0.4); // sqrt(2 / 256) = 0.09
}

TEST(LightTracer, TheSkysLightComesThroughAPaneByRaysAsItComesWithoutIt) {
    // The pane hides half the sky from the middle of the floor; what it keeps away comes through it again.
    scene::Scene scene = floorUnder(almostNothing(scene::Box{{2, 0.1f, 2}}, {0.8f, 0.3f, 0}), 1);
    test::addSky(scene, vec3(1));
    for (const scene::Aov aov : {scene::Aov::Irradiance, scene::Aov::Color}) {
        const double expected =
            aov == scene::Aov::Irradiance ? kPi : double(scene.objects[0].material.diffuse.g);
        const Picture picture = traced(scene, {8, 8}, {.aov = aov, .photons = 400000, .samples = 256});
        EXPECT_NEAR(chiSquare(picture, [&](int, int) { return expected; }), 1, 0.7); // sqrt(2 / 64) = 0.18
        EXPECT_LT(double(picture.errors.at(4, 4)[1]), 0.1 * expected);
    }
}

TEST(LightTracer, DependsOnTheSeedAndNotOnThreads) {
    scene::Scene scene = floorUnder(glass(scene::Sphere{0.5f}, 1.5f, {0, 1, 0}), 1);
    scene.lights = {scene::DistantLight{.direction = {0.1f, -1, 0}, .angle = 5}};
    const LightOptions options{.photons = 50000, .samples = 4, .seed = 1};
    const Picture one = traced(scene, {8, 8}, options, {}, 1), three = traced(scene, {8, 8}, options, {}, 3);
    EXPECT_EQ(one.values.pixels, three.values.pixels);
    EXPECT_EQ(one.errors.pixels, three.errors.pixels);
    LightOptions other = options;
    other.seed = 2;
    EXPECT_NE(one.values.pixels, traced(scene, {8, 8}, other).values.pixels);
}

TEST(LightTracer, PartsThroughFilesAreThePictureBitByBit) {
    scene::Scene scene = floorUnder(glass(scene::Box{{2, 0.5f, 2}}, 1.5f, {0, 1, 0}), 1);
    scene.lights = {scene::PointLight{.position = {0, 3, 0}, .falloff = scene::LightFalloff::InverseSquare}};
    const LightOptions options{.photons = 100001};
    const Picture whole = traced(scene, {8, 8}, options);
    std::vector<Part> parts;
    for (int index = 0; index < 3; ++index) {
        const Tile tile{index, 3};
        const Facts facts{.scene = "s",
                          .fingerprint = "f",
                          .size = {8, 8},
                          .aov = "irradiance",
                          .estimator = "light",
                          .photons = 100001};
        const Bytes bytes = encodePart({facts, tile, traced(scene, {8, 8}, options, tile)});
        Result<Part> part = decodePart(bytes, "part");
        ASSERT_TRUE(part.ok()) << part.error().message;
        parts.push_back(*part);
    }
    const Result<Picture> merged = merge(parts, std::vector<std::string>{"1", "2", "3"});
    ASSERT_TRUE(merged.ok());
    EXPECT_EQ(merged->values.pixels, whole.values.pixels);
    EXPECT_EQ(merged->errors.pixels, whole.errors.pixels);
    EXPECT_EQ(sidecar(parts[0].facts, *merged), sidecar(parts[0].facts, whole));
    const std::string facts = sidecar(parts[0].facts, *merged);
    for (const char* word : {"\"photons\": 100001", "\"energy\"", "\"incident\"", "\"lost\"", "\"green\""})
        EXPECT_NE(facts.find(word), std::string::npos) << facts;
}

TEST(LightTracer, ColoursAreThoseOfGlassWithCausticsDirectlyAndThroughIt) {
    scene::Scene scene = floorUnder(glass(scene::Box{{4, 0.5f, 4}}, 1.5f, {0, 2, 0}), 1);
    scene.objects[0].material.diffuse = vec3(0.5f, 0.25f, 1);
    scene.objects[0].material.base = vec3(0.125f);
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}, .irradiance = 2}};
    const LightOptions options{.aov = scene::Aov::Color, .photons = 100000};
    const double arrives = 2 * 0.96 * 0.96; // through both faces
    const Picture below = traced(scene, {2, 2}, options);
    const vec3 albedo = scene.objects[0].material.diffuse;
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(double(below.values.at(1, 1)[channel]), 0.125 + double(albedo[channel]) * arrives / kPi,
                    5 * double(below.errors.at(1, 1)[channel]));
    // Through the slab the same floor, with both faces before it, and with light on more than one pixel.
    scene.objects[1].visible = true;
    const Picture through = traced(scene, {16, 16}, {.aov = scene::Aov::Color, .photons = 400000});
    double sum = 0, squares = 0;
    for (int i = 0; i < 64; ++i) { // the middle
        const double error = double(through.errors.at(4 + i % 8, 4 + i / 8)[1]);
        sum += double(through.values.at(4 + i % 8, 4 + i / 8)[1]);
        squares += error * error;
    }
    const double shown = 0.96 * 0.96 * (0.125 + double(albedo.g) * arrives / kPi);
    // Discs overlap: a ray counts in up to four pixels at once, so errors of a sum are up to twice as large.
    EXPECT_NEAR(sum / 64, shown, 4 * 2 * std::sqrt(squares) / 64);
    EXPECT_LT(std::sqrt(squares) / 64, 0.01 * shown);
    const auto refused = traceLight(scene, {2, 2}, {.aov = scene::Aov::Depth}, {}, {}, kGoOn);
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().message,
              "truth: AOV depth is not traced by light; must be irradiance or color");
}

TEST(LightTracer, ThroughGlassAFloorOfTwoPartsIsAsBrightWhereTheyMeet) {
    scene::Scene scene = floorUnder(glass(scene::Box{{4, 0.5f, 4}}, 1.5f, {0, 2, 0}), 1);
    scene.objects[1].visible = true;
    scene.objects[0] = matt(scene::Plane{{20, 40}}, {-10, 0, 0});
    scene.objects.push_back(matt(scene::Plane{{20, 40}}, {10, 0, 0}));
    scene.objects.push_back(matt(scene::Box{{2, 0.1f, 2}}, {-1.25f, 0.05f, 0})); // it covers a part beside
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}, .irradiance = 2}};
    const Picture picture = traced(scene, {16, 16}, {.aov = scene::Aov::Color, .photons = 1'000'000});
    const double shown = std::pow(0.96, 4) * 2 * double(0.8f) / kPi; // the material's diffuse
    for (const int column :
         {2, 3, 4, 7, 8, 12}) { // the box ends between 3 and 4, the parts meet between 7 and 8
        double sum = 0, squares = 0;
        for (int row = 0; row < 16; ++row) {
            const double error = double(picture.errors.at(column, row)[1]);
            sum += double(picture.values.at(column, row)[1]) / 16;
            squares += error * error / 256;
        }
        // Rays count in up to four pixels, so errors of a sum are up to twice as large; areas are known to 2
        // %.
        EXPECT_NEAR(sum, shown, 0.02 * shown + 4 * 2 * std::sqrt(squares)) << column;
    }
}

// The sun shines far beneath a black plate that hovers less than a pixel's width over a floor, where the
// camera sees some of it too: what stands close over a place takes none of its light.
TEST(LightTracer, ThroughGlassAFloorBeneathAnOverhangIsAsBrightAsElsewhere) {
    scene::Scene scene = floorUnder(glass(scene::Box{{20, 0.5f, 2}}, 1.5f, {0, 2, 0}), 1);
    scene.objects[1].visible = true;
    scene.camera.eye = {-20, 8, 0};
    scene.camera.up = {0, 1, 0};
    scene.lights = {scene::DistantLight{.direction = {1, -0.3f, 0}, .irradiance = 2}};
    scene.objects.push_back(matt(scene::Box{{1, 0.1f, 2}}));
    scene.objects.back().material.diffuse = vec3(0);
    const float row = 1 / 16.0f / std::sin(std::atan(0.4f)); // m of the floor
    for (const float shift : {0.0f, 0.25f, 0.5f, 0.75f}) {
        scene.objects.back().transform.translate = {0.5f + shift * row, 0.1f, 0}; // 0.05 m over the floor
        const Picture picture = traced(scene, {16, 16}, {.aov = scene::Aov::Color, .photons = 4'000'000});
        std::vector<double> rows;
        for (int y = 0; y < 16; ++y) {
            rows.push_back(0);
            for (int x = 0; x < 16; ++x)
                rows.back() += double(picture.values.at(x, y)[1]) / 16;
        }
        const double open = std::accumulate(rows.begin() + 4, rows.end(), 0.0) / 12;
        for (int y = 0; y < 16; ++y) // of some 600 rays a pixel, which count in their neighbours too
            EXPECT_TRUE(rows[std::size_t(y)] == 0 || std::abs(rows[std::size_t(y)] / open - 1) < 0.1)
                << shift << ", row " << y << ": " << rows[std::size_t(y)] / open;
    }
}

// White up to a quarter of a pixel, black from there on, both seen and lit through a pane.
TEST(LightTracer, ColoursOverPixelsAreMeansThroughGlassToo) {
    scene::Scene scene = floorUnder(glass(scene::Box{{4, 0.5f, 4}}, 1.5f, {0, 2, 0}), 1);
    scene.objects[1].visible = true;
    const float edge = 0.25f * scene.camera.height / 16;
    scene.objects[0] = matt(scene::Plane{{20, 40}}, {edge - 10, 0, 0});
    scene.objects.push_back(matt(scene::Plane{{20, 40}}, {edge + 10, 0, 0}));
    scene.objects.back().material.diffuse = vec3(0);
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}, .irradiance = 2}};
    const double shown = std::pow(0.96, 4) * 2 * double(0.8f) / kPi;
    for (const bool overPixels : {false, true}) {
        const Picture picture = traced(
            scene, {16, 16}, {.aov = scene::Aov::Color, .photons = 1'000'000, .overPixels = overPixels});
        double sum = 0;
        for (int row = 0; row < 16; ++row)
            sum += double(picture.values.at(8, row)[1]) / 16;
        EXPECT_NEAR(sum, overPixels ? shown / 4 : 0, 0.03 * shown) << overPixels;
    }
}

TEST(LightTracer, ColoursOverPixelsAreTheMeanOfWhatIsCovered) {
    // Half of the only pixel shows the floor, its middle included; what is beside it is nothing.
    scene::Scene scene = sceneOf({matt(scene::Plane{{0.5f, 2}})});
    scene.camera.eye = {0, 2, 0};
    scene.camera.target = {0, 0, 0};
    scene.camera.up = {0, 0, -1};
    scene.camera.height = 1;
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}}};
    const double lit = double(0.8f) / kPi;
    LightOptions options{.aov = scene::Aov::Color, .photons = 1, .samples = 1};
    EXPECT_NEAR(traced(scene, {1, 1}, options).values.pixels[1], lit, 1e-6);
    EXPECT_EQ(traced(scene, {1, 1}, options).values.pixels[3], 1);
    options.overPixels = true;
    const Picture picture = traced(scene, {1, 1}, options);
    EXPECT_NEAR(double(picture.values.pixels[1]), lit, 1e-6);
    EXPECT_NEAR(picture.values.pixels[3], 0.5, 0.5 / PixelMean::kPlaces);
    EXPECT_EQ(picture.errors.pixels[1], 0);
    // Before black: its share of the light, and an error no smaller than what it is off by.
    scene.objects.push_back(matt(scene::Plane{{2, 2}}, {0, -1, 0}));
    scene.objects[1].material.diffuse = vec3(0);
    const Picture mixed = traced(scene, {1, 1}, options);
    EXPECT_NEAR(double(mixed.values.pixels[1]), lit / 2, lit * 0.5 / PixelMean::kPlaces);
    EXPECT_EQ(mixed.values.pixels[3], 1);
    EXPECT_NEAR(double(mixed.errors.pixels[1]), lit / 2 / std::sqrt(PixelMean::kPlaces - 1), 0.01 * lit);
    // With a place for each sample.
    options.samples = PixelMean::kMostPlaces;
    const Picture fine = traced(scene, {1, 1}, options);
    EXPECT_NEAR(double(fine.values.pixels[1]), lit / 2, lit * 0.5 / PixelMean::kMostPlaces);
    EXPECT_NEAR(double(fine.errors.pixels[1]), lit / 2 / std::sqrt(PixelMean::kMostPlaces - 1), 0.001 * lit);
}

TEST(LightTracer, TheTreeBringsWhatIsReflectedInsideASlabAsWell) {
    // (1 - F)² (1 + F² + F⁴ + ...) = (1 - F) / (1 + F) of the light.
    scene::Scene scene = floorUnder(glass(scene::Box{{2, 0.5f, 2}}, 1.5f, {0, 2, 0}), 1);
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}}};
    const Picture picture = traced(scene, {8, 8}, {.branching = Branching::Tree, .photons = 400000});
    EXPECT_NEAR(chiSquare(picture, [](int, int) { return 0.96 / 1.04; }), 1, 0.6); // sqrt(2 / 64) = 0.18
    EXPECT_NEAR(picture.energy->received.g, 4 * 0.96 / 1.04, 0.01);
    EXPECT_EQ(picture.energy->reflected, dvec3(0));
    expectClosed(*picture.energy);
}

TEST(LightTracer, HeightFieldsReceiveLight) {
    scene::Scene scene = sceneOf({matt(test::shapeOf(8, 8, 1, 0.1f, [](int, int) { return 0.5f; })),
                                  glass(scene::Box{{2, 2, 0.25f}}, 1.5f, {0, 0, 0.5f})});
    scene.objects[1].visible = false;
    scene.lights = {scene::DistantLight{.direction = {0, 0, -1}}};
    const Picture picture = traced(scene, {8, 8}, {.photons = 200000});
    EXPECT_NEAR(chiSquare(picture, [](int, int) { return 0.96 * 0.96; }), 1, 0.6);
}

TEST(LightTracer, ThePictureHoldsLightOfTheSideThatIsSeen) {
    // Lit from below through a ball, looked at from above: nothing.
    scene::Scene scene = floorUnder(glass(scene::Sphere{0.5f}, 1.5f, {0, -1, 0}), 1);
    scene.lights = {scene::DistantLight{.direction = {0, 1, 0}}};
    const Picture picture = traced(scene, {4, 4}, {.photons = 10000});
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x) {
            EXPECT_EQ(picture.values.at(x, y)[1], 0);
            EXPECT_EQ(picture.values.at(x, y)[3], 1);
        }
    EXPECT_GT(picture.energy->received.g, 0.5);
    // Without a lamp or anything clear there is nothing to follow.
    EXPECT_EQ(traced(sceneOf({matt(scene::Plane{})}), {4, 4}, {}).energy->incident, dvec3(0));
}

} // namespace
} // namespace lucent::truth
