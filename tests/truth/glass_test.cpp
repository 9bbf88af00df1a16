#include "truth/Glass.h"

#include "tests/truth/scenes.h"

#include <atomic>

namespace lucent::truth {
namespace {
using test::glass;
using test::matt;
using test::mirror;
using test::sceneOf;

constexpr double kPi = std::numbers::pi;
const std::atomic<bool> kGoOn = false;

/// Seen straight down by an orthographic camera at y = 5 that shows one metre.
void lookDown(scene::Scene& scene, float height = 1) {
    scene.camera.eye = {0, 5, 0};
    scene.camera.target = {0, 0, 0};
    scene.camera.up = {0, 0, -1};
    scene.camera.height = height;
}

GlassEstimator estimatorOf(const scene::Scene& scene, scene::Aov aov, const GlassOptions& options = {},
                           ivec2 size = {1, 1}) {
    auto estimator = GlassEstimator::create(scene, size, aov, options);
    EXPECT_TRUE(estimator.ok());
    return std::move(*estimator);
}
Pixel middle(const scene::Scene& scene, scene::Aov aov, const GlassOptions& options = {}) {
    return estimatorOf(scene, aov, options).solve({0, 0});
}

TEST(Glass, UnderAnEvenSkyTheWholeTreeIsInvisible) {
    // No light is made or lost: whatever way light takes, it came from a sky of 1.
    scene::Object ball = glass(scene::Sphere{0.45f}, 1.5f),
                  core = glass(scene::Sphere{0.3f}, 1.1f, {0.1f, 0, 0});
    scene::Object ring = glass(scene::Torus{0.4f, 0.1f}, 2.4f);
    ring.transform.rotate = {50, 0, 20};
    for (const auto& objects : {std::vector{ball}, std::vector{ball, core}, std::vector{ring}}) {
        scene::Scene scene = sceneOf(objects);
        lookDown(scene);
        test::addSky(scene, vec3(1));
        const auto picture = render(
            estimatorOf(scene, scene::Aov::Color, {.branching = Branching::Tree, .samples = 16}, {24, 24}),
            {24, 24}, {}, {}, kGoOn);
        ASSERT_TRUE(picture.ok());
        for (std::size_t i = 0; i < picture->values.pixels.size(); ++i)
            EXPECT_NEAR(picture->values.pixels[i], 1, 1e-6);
    }
}

TEST(Glass, TheChainShowsTransmittedLightAndTheFirstReflection) {
    scene::Scene scene = sceneOf({glass(scene::Box{{4, 0.5f, 4}}, 1.5f)});
    lookDown(scene);
    test::addSky(scene, vec3(1, 2, 4));
    // 0.96² through both faces and 0.04 from the first one; the tree adds 0.96² 0.04 (1 + 0.04² ...) of what
    // is reflected inside.
    const dvec3 expected = dvec3(1, 2, 4) * (0.96 * 0.96 + 0.04);
    EXPECT_NEAR(glm::distance(middle(scene, scene::Aov::Color).value, expected), 0, 1e-12);
    scene.objects[0].material.clear().fresnel = false;
    EXPECT_EQ(middle(scene, scene::Aov::Color).value, dvec3(1, 2, 4));
    EXPECT_EQ(middle(scene, scene::Aov::Color).variance, dvec3(0));
}

TEST(Glass, TheTreeFindsEveryReflection) {
    // Light from above only: a slab shows the sum of all reflections, 2 F / (1 + F).
    scene::Scene scene = sceneOf({glass(scene::Box{{4, 0.5f, 4}}, 1.5f)});
    lookDown(scene);
    test::addSky(scene, vec3(1));
    Image& map = const_cast<Image&>(*scene.environment->map);
    for (int x = 0; x < map.width; ++x)
        for (int channel = 0; channel < 3; ++channel)
            map.at(x, 1)[channel] = 0; // below the horizon
    const Pixel pixel = middle(scene, scene::Aov::Color, {.branching = Branching::Tree, .samples = 100000});
    const double expected = 2 * 0.04 / 1.04, error = std::sqrt(pixel.variance.g);
    EXPECT_NEAR(pixel.value.g, expected, 4 * error);
    EXPECT_NEAR(error, std::sqrt(expected * (1 - expected) / 1e5), 0.02 * error);
}

TEST(Glass, TheSkyIsReadBetweenTheCentresOfItsTexels) {
    scene::Environment environment;
    Image map(4, 2, 3);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 4; ++x)
            map.at(x, y)[0] = float(x + 10 * y);
    environment.map = std::make_shared<Image>(map);
    environment.intensity = 2;
    const Sky sky(environment);
    const auto at = [&](double turns, double down) { // from the left edge, from the top
        const double azimuth = 2 * kPi * (turns - 0.5), polar = kPi * down;
        return sky.radiance({std::sin(polar) * std::sin(azimuth), std::cos(polar),
                             -std::sin(polar) * std::cos(azimuth)})
                   .r /
               2;
    };
    EXPECT_NEAR(at(0.125, 0.25), 0, 1e-12);
    EXPECT_NEAR(at(0.375, 0.25), 1, 1e-12);
    EXPECT_NEAR(at(0.5, 0.25), 1.5, 1e-12);
    EXPECT_NEAR(at(0.5, 0.5), 6.5, 1e-12);
    EXPECT_NEAR(at(0.999999999, 0.25), 1.5, 1e-6); // across the seam, between 3 and 0
    EXPECT_NEAR(at(0.625, 0.01), 2, 1e-12);
    EXPECT_NEAR(at(0.625, 0.99), 12, 1e-12);
    // The centre column is -z, to the right of it +x.
    EXPECT_NEAR(sky.radiance({1, 0, 0}).r / 2, 2.5 + 5, 1e-12);
}

TEST(Glass, OpaqueSurfacesShowTheirLightOverPi) {
    scene::Scene scene = sceneOf({matt(scene::Plane{{9, 9}})});
    lookDown(scene);
    scene.objects[0].material.base = vec3(0.25f, 0, 0);
    scene.objects[0].material.diffuse = vec3(0.5f);
    const auto shown = [&](scene::Light light, int samples = 1) {
        scene.lights = {light};
        const Pixel pixel = middle(scene, scene::Aov::Color, {.samples = samples});
        EXPECT_NEAR(pixel.value.r - pixel.value.g, 0.25, 1e-12);
        return pixel;
    };
    // At the origin, from (3, 4, 0): five metres away, cosine 4/5.
    const vec3 place(3, 4, 0);
    const double perWatt = 0.5 / kPi;
    scene::PointLight point{
        .position = place, .intensity = 10, .falloff = scene::LightFalloff::InverseSquare};
    EXPECT_NEAR(shown(point).value.g, perWatt * 10 * 0.8 / 25, 1e-12);
    point.falloff = scene::LightFalloff::None;
    EXPECT_NEAR(shown(point).value.g, perWatt * 10 * 0.8, 1e-12);
    EXPECT_NEAR(shown(scene::DistantLight{.direction = -place, .irradiance = 2}).value.g, perWatt * 2 * 0.8,
                1e-12);
    scene::SpotLight spot{.position = place, .direction = -place, .intensity = 10};
    EXPECT_NEAR(shown(spot).value.g, perWatt * 10 * 0.8 / 25, 1e-12);
    // Half way, in cosines, between both angles a quarter is left.
    const double half = std::acos(0.5 * (std::cos(20 * kPi / 180) + std::cos(25 * kPi / 180)));
    spot.position = {0, 1, 0};
    spot.direction = {float(std::sin(half)), float(-std::cos(half)), 0};
    EXPECT_NEAR(shown(spot).value.g, perWatt * 10 / 4, 1e-5);
    // A square of side 2 one metre above: four corners of sides 1 at a distance of 1, whose form factor is
    // X / sqrt(1 + X²) atan(Y / sqrt(1 + X²)) / pi each, with X = Y = 1.
    const double factor = 4 / (2 * kPi) * 2 / std::sqrt(2) * std::atan(1 / std::sqrt(2));
    const scene::AreaLight area{.corner = {-1, 1, -1}, .edgeU = {2, 0, 0}, .edgeV = {0, 0, 2}, .radiance = 3};
    const Pixel pixel = shown(area, 20000);
    EXPECT_NEAR(pixel.value.g, 0.5 * 3 * factor, 4 * std::sqrt(pixel.variance.g));
    EXPECT_LT(std::sqrt(pixel.variance.g), 0.01 * pixel.value.g);
    scene::AreaLight turned = area;
    std::swap(turned.edgeU, turned.edgeV);
    EXPECT_EQ(shown(turned, 16).value.g, 0); // its back
}

TEST(Glass, ClearObjectsCastFullShadows) {
    scene::Scene scene = sceneOf({matt(scene::Plane{{9, 9}}), glass(scene::Sphere{0.5f}, 1.5f, {0, 2, 0})});
    scene.objects[1].visible = false;
    lookDown(scene);
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}}};
    EXPECT_EQ(middle(scene, scene::Aov::Color).value, dvec3(0));
    scene.lights = {scene::DistantLight{.direction = {1, -1, 0}}};
    EXPECT_NEAR(middle(scene, scene::Aov::Color).value.g, double(0.8f) / kPi * std::sqrt(0.5), 1e-7);
}

TEST(Glass, WhatBendsNothingCastsTheShadowOfWhatItAbsorbs) {
    scene::Scene scene = sceneOf({matt(scene::Plane{{9, 9}}), glass(scene::Sphere{0.5f}, 1, {0, 2, 0})});
    scene.objects[1].visible = false;
    lookDown(scene);
    const double unshadowed = double(0.8f) / kPi;
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}}};
    EXPECT_NEAR(middle(scene, scene::Aov::Color).value.g, unshadowed, 1e-12);
    // Half of the light is left after 1 m, the ball's diameter, to a float's digits, and of that
    // `transmission`.
    scene.objects[1].material.clear().absorption = vec3(std::log(2.0f));
    scene.objects[1].material.clear().transmission = 0.25f;
    const double left = std::exp(-double(std::log(2.0f)));
    EXPECT_NEAR(middle(scene, scene::Aov::Color).value.g, 0.25 * left * unshadowed, 1e-12);
    // A wall above it shadows as before.
    scene.objects.push_back(matt(scene::Box{{1, 0.1f, 1}}, {0, 4, 0}));
    scene.objects[2].visible = false;
    EXPECT_EQ(middle(scene, scene::Aov::Color).value, dvec3(0));
    // In water it is a bubble, which bends light.
    scene.objects[2] = glass(scene::Box{{8, 1.5f, 8}}, 1.33f, {0, 2, 0});
    scene.objects[2].visible = false;
    EXPECT_EQ(middle(scene, scene::Aov::Color).value, dvec3(0));
}

/// The green radiance of `count` x `count` pixels.
struct Looks {
    std::vector<Pixel> pixels;
    Looks(const scene::Scene& scene, int count, int samples) {
        const GlassEstimator estimator =
            estimatorOf(scene, scene::Aov::Color, {.samples = samples, .seed = 5}, {count, count});
        for (int i = 0; i < count * count; ++i)
            pixels.push_back(estimator.solve({i % count, i / count}));
    }
    /// Mean of the squared differences in standard errors over the pixels that are left to chance: 1, give or
    /// take the square root of 2 over their number.
    double chiSquare(double expected) const {
        double sum = 0;
        int count = 0;
        for (const Pixel& pixel : pixels) {
            if (pixel.variance.g == 0) continue;
            sum += (pixel.value.g - expected) * (pixel.value.g - expected) / pixel.variance.g;
            ++count;
        }
        EXPECT_GT(count, 0);
        return sum / count;
    }
    double error() const {
        double sum = 0;
        for (const Pixel& pixel : pixels)
            sum += pixel.variance.g;
        return std::sqrt(sum) / double(pixels.size());
    }
    double mean() const {
        double sum = 0;
        for (const Pixel& pixel : pixels)
            sum += pixel.value.g;
        return sum / double(pixels.size());
    }
};

TEST(Glass, UnderAnEvenSkyAMattBallShowsItsAlbedo) {
    // E = pi L wherever nothing is in the way.
    scene::Scene scene = sceneOf({matt(scene::Sphere{0.5f})});
    scene.objects[0].material.diffuse = vec3(0.5f);
    lookDown(scene);
    test::addSky(scene, vec3(1, 2, 4));
    const Looks looks(scene, 20, 256);
    // pi / 4 of 400 pixels show it: sqrt(2 / 314) = 0.08. A pixel of the sky is certain.
    EXPECT_NEAR(looks.chiSquare(1), 1, 0.3);
    EXPECT_EQ(looks.pixels[0].value, dvec3(1, 2, 4));
    EXPECT_EQ(looks.pixels[0].variance, dvec3(0));
    const Pixel middle = looks.pixels[210];
    EXPECT_NEAR(middle.value.b, 4 * middle.value.r, 1e-9);
    // By the cosine alone there is no noise, by directions alone sqrt(5 / 3) E; both together, whose variance
    // is the integral of cos² / (1 / (4 pi) + cos / pi) over the half sphere, less what each brings squared:
    // at most half of the latter is asked for.
    EXPECT_LT(std::sqrt(middle.variance.r), 0.5 * 0.5 * std::sqrt(5 / 3.0) / 16);
}

TEST(Glass, AWallOverAnEndlessFloorSeesHalfOfWhatTheFloorSees) {
    scene::Scene scene =
        sceneOf({matt(scene::Plane{{20000, 20000}}), matt(scene::Box{{4, 4, 4}}, {0, 2, -2})});
    for (scene::Object& object : scene.objects)
        object.material.diffuse = vec3(1);
    test::addSky(scene, vec3(1));
    scene.camera.height = 0.1f;
    scene.camera.eye = {0, 2, 9}; // at the wall, z = 0
    scene.camera.target = {0, 2, 0};
    EXPECT_NEAR(Looks(scene, 10, 256).chiSquare(0.5), 1, 0.6); // sqrt(2 / 100) = 0.14
    lookDown(scene, 0.1f);
    scene.camera.eye = {900, 9, 0};
    scene.camera.target = {900, 0, 0};
    EXPECT_NEAR(Looks(scene, 10, 256).chiSquare(1), 1, 0.6);
}

TEST(Glass, ABoxDarkensTheFloorBesideIt) {
    // A long wall of height h at a distance of d hides the sky up to tan a = h / d: (1 + cos a) / 2 is left.
    scene::Scene scene =
        sceneOf({matt(scene::Plane{{90000, 90000}}), matt(scene::Box{{8000, 1, 1}}, {0, 0.5f, -0.5f})});
    scene.objects[0].material.diffuse = vec3(1);
    test::addSky(scene, vec3(1));
    double before = 0;
    for (const float d : {0.05f, 0.5f, 2.0f, 20.0f}) {
        lookDown(scene, 0.001f);
        scene.camera.eye.z = scene.camera.target.z = d;
        const double expected = 0.5 * (1 + double(d) / std::hypot(1.0, double(d)));
        const Looks looks(scene, 10, 256);
        EXPECT_NEAR(looks.chiSquare(expected), 1, 0.6) << d;
        EXPECT_LT(looks.error(), 0.005);
        EXPECT_GT(looks.mean(), before + 0.02);
        before = looks.mean();
    }
}

TEST(Glass, ClearObjectsAndMirrorsHideTheSky) {
    for (const scene::Object& shade : {glass(scene::Sphere{2}, 1.5f), mirror(scene::Sphere{2})}) {
        scene::Scene scene = sceneOf({matt(scene::Plane{{1, 1}}), shade});
        scene.objects[1].visible = false;
        lookDown(scene, 0.1f);
        test::addSky(scene, vec3(1));
        EXPECT_EQ(middle(scene, scene::Aov::Color).value, dvec3(0));
    }
}

TEST(Glass, ARoughTurnedSkyLightsAsTheSumOfAllItShows) {
    scene::Scene scene = sceneOf({matt(scene::Plane{{1, 1}})});
    scene.objects[0].material.diffuse = vec3(1);
    lookDown(scene, 0.1f);
    Image map(16, 8, 3);
    for (int i = 0; i < 128; ++i) // mostly dark, one sun
        for (int channel = 0; channel < 3; ++channel)
            map.pixels[std::size_t(3 * i + channel)] = i == 22 ? 50.0f : i % 7 < 4 ? 0.0f : float(i % 5);
    scene.environment.emplace();
    scene.environment->map = std::make_shared<Image>(map);
    scene.environment->rotation = {20, 70, -40};
    scene.environment->intensity = 0.5f;
    const Sky sky(*scene.environment);
    double expected = 0; // of L cos over the upper half, over pi
    constexpr int kBelts = 1000, kSectors = 2000;
    for (int belt = 0; belt < kBelts; ++belt)
        for (int sector = 0; sector < kSectors; ++sector) {
            const double up = (belt + 0.5) / kBelts, turn = 2 * kPi * (sector + 0.5) / kSectors;
            const double out = std::sqrt(1 - up * up);
            expected += 2.0 / (kBelts * double(kSectors)) * up *
                        sky.radiance({out * std::cos(turn), up, out * std::sin(turn)}).g;
        }
    const Looks looks(scene, 16, 1024);
    EXPECT_NEAR(looks.chiSquare(expected), 1, 0.35); // sqrt(2 / 256) = 0.09
    EXPECT_NEAR(looks.mean(), expected, 4 * looks.error());
    EXPECT_LT(looks.error(), 0.005 * expected);
}

TEST(Glass, SaysDirectionLayersNormalDepthAndPosition) {
    scene::Scene scene = sceneOf({glass(scene::Sphere{1}, 1.5f), glass(scene::Sphere{0.5f}, 1.2f),
                                  matt(scene::Plane{{9, 9}}, {0, -2, 0})});
    lookDown(scene);
    scene.camera.eye.x = scene.camera.target.x = 0.25f;
    const auto expect = [&](scene::Aov aov, dvec3 value) {
        EXPECT_NEAR(glm::distance(middle(scene, aov).value, value), 0, 1e-6) << int(aov);
        EXPECT_EQ(middle(scene, aov).coverage, 1);
    };
    const double b = 0.25, height = std::sqrt(1 - b * b);
    const double turn = 2 * (std::asin(b) - std::asin(b / 1.5) + std::asin(b / 0.75) - std::asin(b / 0.6));
    expect(scene::Aov::Direction, {-std::sin(turn), -std::cos(turn), 0});
    expect(scene::Aov::Layers, dvec3(4));
    expect(scene::Aov::Normal, {b, height, 0});
    expect(scene::Aov::Position, {b, height, 0});
    expect(scene::Aov::Depth, dvec3(5 - height));
    scene.objects[1].visible = false;
    expect(scene::Aov::Layers, dvec3(2));
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {0.25f, 1.5f, 0};
    expect(scene::Aov::Depth, dvec3(1.5 - height));
    scene.objects.clear();
    EXPECT_EQ(middle(scene, scene::Aov::Depth).coverage, 0);
    EXPECT_EQ(middle(scene, scene::Aov::Color).coverage, 0); // no sky
}

TEST(Glass, AnEyeInAPoolLooksOut) {
    // Under the critical angle the eye sees the sky, refracted away from the normal: Snell's window.
    scene::Scene scene = sceneOf({glass(scene::Water{.size = {20, 20}}, 1.33f)});
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {0, -1, 0};
    scene.camera.target = {0.5f, 0, 0};
    const Pixel pixel = middle(scene, scene::Aov::Direction);
    EXPECT_NEAR(pixel.value.x, double(1.33f) * std::sin(std::atan(0.5)), 1e-7);
    scene.camera.target = {2, 0, 0};
    EXPECT_LT(middle(scene, scene::Aov::Direction).value.y, 0); // totally reflected
}

TEST(Glass, WhatIsNotSeenThroughGlassIsRefused) {
    const scene::Scene scene = sceneOf({glass(scene::Sphere{1}, 1.5f)});
    const auto estimator = GlassEstimator::create(scene, {1, 1}, scene::Aov::Visibility, {});
    ASSERT_FALSE(estimator.ok());
    EXPECT_EQ(estimator.error().message,
              "truth: AOV visibility is none of what is seen through glass; must be "
              "color, direction, layers, normal, depth or position");
}

} // namespace
} // namespace lucent::truth
