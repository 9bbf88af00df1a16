#include "truth/RenderRelief.h"

#include "tests/truth/fields.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace lucent::truth {
namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const std::atomic<bool> kGoOn = false;

scene::Environment environmentOf(Image map) {
    scene::Environment environment;
    environment.map = std::make_shared<Image>(std::move(map));
    return environment;
}

TEST(EnvironmentLights, ShareTheWholeSphereEqually) {
    Image white(1, 1, 3);
    white.pixels = {1, 1, 1};
    for (const Choice choice : {Choice::Evenly, Choice::ByLight})
        for (const auto& [wanted, count] : {std::pair{1, 4}, {2, 4}, {7, 8}, {64, 64}, {1000, 1000}}) {
            const auto lights = environmentLights(environmentOf(white), wanted, choice, 1);
            ASSERT_EQ(int(lights.size()), count);
            double weights = 0, colors = 0;
            for (const LightSource& light : lights) {
                EXPECT_NEAR(light.weight, 1.0 / count, 1e-12);
                EXPECT_NEAR(glm::length(light.place), 1, 1e-12);
                weights += light.weight;
                colors += light.color.r;
            }
            EXPECT_NEAR(weights, 1, 1e-12);
            EXPECT_NEAR(colors, 1, 1e-12);
        }
}

TEST(EnvironmentLights, KeepTheMapsMeanWeightedBySolidAngle) {
    // Eight rows whose value is their number; a row from polar angle a to b has the share (cos a - cos b)
    // / 2.
    Image map(3, 8, 3);
    double mean = 0;
    for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 9; ++x)
            map.at(0, y)[x] = float(y);
        mean += y * (std::cos(std::numbers::pi * y / 8) - std::cos(std::numbers::pi * (y + 1) / 8)) / 2;
    }
    // Where red, green and blue go together, choosing by light finds a cell's mean wherever it looks.
    for (const int count : {5, 100}) {
        double sum = 0;
        for (const LightSource& light : environmentLights(environmentOf(map), count, Choice::ByLight, 3))
            sum += light.color.g;
        EXPECT_NEAR(sum, mean, 1e-12);
    }
}

TEST(EnvironmentLights, ASmallSunIsNeverMissed) {
    // One pixel of 512 x 256, a 5e-5th of the sphere near the belt, shines 1e4 times as bright as the rest.
    Image map(512, 256, 3);
    std::fill(map.pixels.begin(), map.pixels.end(), 1.f);
    for (int channel = 0; channel < 3; ++channel)
        map.at(100, 120)[channel] = 1e4f;
    const double share =
        (std::cos(std::numbers::pi * 120 / 256) - std::cos(std::numbers::pi * 121 / 256)) / 2 / 512;
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        double sum = 0;
        for (const LightSource& light : environmentLights(environmentOf(map), 64, Choice::ByLight, seed))
            sum += light.color.r;
        EXPECT_NEAR(sum, 1 + share * (1e4 - 1), 1e-9);
    }
}

TEST(EnvironmentLights, TheMapsCentreIsMinusZAndItsRightIsPlusX) {
    // One bright pixel a little right of the centre, one row above the equator.
    Image map(64, 32, 3);
    map.at(48, 15)[0] = 1; // 48.5/64 - 1/2 = a quarter turn to the right: +x
    map.at(32, 15)[1] = 1; // the centre column
    map.at(20, 0)[2] = 1;  // the top row
    scene::Environment environment = environmentOf(map);
    const auto brightest = [&](int channel) {
        dvec3 sum{0};
        for (const LightSource& light : environmentLights(environment, 20000, Choice::ByLight, 1))
            sum += light.color[channel] * light.place;
        return glm::normalize(sum);
    };
    EXPECT_GT(brightest(0).x, 0.99);
    EXPECT_GT(-brightest(1).z, 0.99);
    EXPECT_GT(brightest(2).y, 0.99);
    environment.rotation = {0, 90, 0}; // +x goes to -z, -z to -x
    EXPECT_GT(-brightest(0).z, 0.99);
    EXPECT_GT(-brightest(1).x, 0.99);
    environment.rotation = {90, 90, 0}; // x first: +y goes to +z, and then to +x
    EXPECT_GT(brightest(2).x, 0.99);
    environment.rotation = {0, 90, 90}; // y before z: +x goes to -z and stays there
    EXPECT_GT(-brightest(0).z, 0.99);
}

TEST(EnvironmentLights, WhiteSkyOverAFlatFieldInTheLimitGivesAQuarter) {
    const Field field = test::fieldOf(8, 8, 1, 0.1f, [](int, int) { return 0.5f; });
    Image white(2, 1, 3);
    white.pixels = {1, 1, 1, 1, 1, 1};
    double mean = 0;
    for (const LightSource& light : environmentLights(environmentOf(white), 4096, Choice::Evenly, 1))
        mean += light.weight * illumination(field, field.pointAbove({0, 0}), 1e-6, light, Attenuation::Ratio);
    // The integral of max(cos, 0) over the sphere is pi, of 4 pi. Mirrored pairs leave only the cells on the
    // horizon: about 50 of 1024, each off by less than 0.03 of its share, at random.
    EXPECT_NEAR(mean, 0.25, 5e-4);
}

TEST(FirstHit, SeesTopAndWallsAndNothingFromBelow) {
    // A block 1 m wide whose surface is at 0.2 and whose walls end at z = 0.
    const Field field = test::fieldOf(4, 4, 1, 0.2f, [](int, int) { return 1.f; });
    const auto hit = [&](dvec3 from, dvec3 direction) {
        return firstHit(field, {from, dvec3(0), glm::normalize(direction)}, {0, kInfinity});
    };
    const auto expectHit = [](const std::optional<SurfacePoint>& found, dvec3 position, dvec3 normal) {
        ASSERT_TRUE(found);
        EXPECT_NEAR(glm::distance(found->position, position), 0, 1e-7); // 0.2f
        EXPECT_NEAR(glm::distance(found->normal, normal), 0, 1e-12);
    };
    expectHit(hit({0.1, 0.1, 2}, {0, 0, -1}), {0.1, 0.1, 0.2}, {0, 0, 1});
    expectHit(hit({0, 0.1, 2.2}, {0.1, 0, -1}), {0.2, 0.1, 0.2}, {0, 0, 1});
    expectHit(hit({-1, 0.1, 0.1}, {1, 0, 0}), {-0.5, 0.1, 0.1}, {-1, 0, 0});
    expectHit(hit({0.2, 1, 0.15}, {0, -1, -0.1}), {0.2, 0.5, 0.1}, {0, 1, 0});
    EXPECT_FALSE(hit({0.2, 0.1, -1}, {0, 0, 1}));
    EXPECT_FALSE(hit({-1, 0.1, -1}, {1, 0, 1.2}));
    EXPECT_FALSE(hit({-1, 0.1, 0.3}, {1, 0, 0}));
    EXPECT_FALSE(hit({-1, 0.1, -0.1}, {1, 0, 0}));
    EXPECT_FALSE(hit({0.6, 0, 2}, {0, 0, -1}));
    EXPECT_FALSE(hit({0, 0, 0.1}, {1, 0, 0.2})); // starts inside
    EXPECT_FALSE(hit({0, 0, 2}, {0, 0, 1}));     // looks away
}

TEST(FirstHit, ASurfaceThatLiesOnTheBottomIsSeen) {
    const Field field = test::fieldOf(4, 4, 1, 0.2f, [](int, int) { return 0.f; });
    EXPECT_TRUE(firstHit(field, {{0.1, 0.1, 2}, dvec3(0), {0, 0, -1}}, {0, kInfinity}));
    EXPECT_TRUE(
        firstHit(field, {{0.1, 0.1, 2}, dvec3(0), glm::normalize(dvec3(0.1, 0, -1))}, {0, kInfinity}));
}

TEST(FirstHit, LandsOnTheSurfaceWithNothingInsideBefore) {
    const Field field = test::fieldOf(17, 11, 1, 0.3f, test::noise(8));
    test::Random random(2);
    int hits = 0;
    for (int trial = 0; trial < 500; ++trial) {
        const dvec3 from{random.between(-1, 1), random.between(-1, 1), random.between(0.4, 1)};
        const dvec3 target{random.between(-0.5, 0.5), random.between(-0.3, 0.3), random.between(0, 0.3)};
        const Ray ray{from, dvec3(0), glm::normalize(target - from)};
        const auto hit = firstHit(field, ray, {0, kInfinity});
        if (!hit || hit->normal.z == 0) continue;
        ++hits;
        const double distance = glm::dot(hit->position - from, ray.direction);
        EXPECT_NEAR(glm::distance(hit->position, from + distance * ray.direction), 0, 1e-9);
        EXPECT_EQ(hit->position.z, field.height(dvec2(hit->position)));
        EXPECT_NEAR(insideLength(field, ray, {0, distance}), 0, 1e-9);
    }
    EXPECT_GT(hits, 200);
}

/// A rough field under one lamp and a camera that looks straight down on all of it.
scene::Scene roughScene() {
    scene::Scene scene;
    scene::Object object;
    object.name = "field";
    object.shape = test::shapeOf(16, 16, 1, 0.2f, test::noise(3));
    object.material.base = vec3(0.1f);
    object.material.relief().depth = 0.04f;
    object.material.relief().specularity = 0.3f;
    scene.objects.push_back(object);
    scene.lights.push_back(scene::PointLight{});
    return scene;
}

Image rendered(const scene::Scene& scene, ivec2 size, scene::Aov aov, int threads = 0) {
    auto result = renderRelief(
        scene, size, aov, {.threads = threads}, [](double) {}, kGoOn);
    EXPECT_TRUE(result.ok());
    return *result;
}

TEST(RenderRelief, FromAboveEveryPixelIsTheModelAtItsPlace) {
    const scene::Scene scene = roughScene();
    const Image image = rendered(scene, {8, 8}, scene::Aov::Illumination);
    const Field field(scene.objects[0].field());
    LightSource lamp;
    lamp.place = dvec3(scene::PointLight{}.position);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            const SurfacePoint point = field.pointAbove({(x + 0.5) / 8 - 0.5, 0.5 - (y + 0.5) / 8});
            EXPECT_EQ(image.at(x, y)[0],
                      float(illumination(field, point, double(0.04f), lamp, Attenuation::Ratio)));
            EXPECT_EQ(image.at(x, y)[3], 1);
        }
}

TEST(RenderRelief, TurningCameraObjectAndLightTogetherChangesNothing) {
    scene::Scene scene = roughScene();
    scene.camera.eye = {0.4f, 0.2f, 2};
    const Image before = rendered(scene, {20, 12}, scene::Aov::Color);
    // A turn by 90 degrees about x takes (x, y, z) to (x, -z, y).
    const auto turned = [](vec3 v) { return vec3(v.x, -v.z, v.y); };
    auto& lamp = std::get<scene::PointLight>(scene.lights[0]);
    lamp.position = turned(lamp.position);
    scene.camera.eye = turned(scene.camera.eye);
    scene.camera.up = turned(scene.camera.up);
    scene.objects[0].transform.rotate = {90, 0, 0};
    const Image after = rendered(scene, {20, 12}, scene::Aov::Color);
    for (std::size_t i = 0; i < after.pixels.size(); ++i)
        EXPECT_NEAR(after.pixels[i], before.pixels[i], 1e-6);
}

TEST(RenderRelief, ScalingEverythingTheDepthTooChangesNothing) {
    scene::Scene scene = roughScene();
    scene.camera.type = scene::Camera::Type::Perspective;
    const Image before = rendered(scene, {20, 12}, scene::Aov::Color);
    scene.objects[0].transform.scale = 4;
    scene.objects[0].material.relief().depth *= 4;
    scene.objects[0].transform.translate = {1, 2, 3};
    scene.camera.eye = 4.f * scene.camera.eye + vec3(1, 2, 3);
    scene.camera.target = vec3(1, 2, 3);
    auto& lamp = std::get<scene::PointLight>(scene.lights[0]);
    lamp.position = 4.f * lamp.position + vec3(1, 2, 3);
    const Image after = rendered(scene, {20, 12}, scene::Aov::Color);
    // The lamp's place is a float: rounded to 2e-7 of a metre.
    for (std::size_t i = 0; i < after.pixels.size(); ++i)
        EXPECT_NEAR(after.pixels[i], before.pixels[i], 1e-5);
}

TEST(RenderRelief, TheNearerObjectHidesTheOtherAndNothingIsBesideThem) {
    scene::Scene scene = roughScene();
    scene.objects.push_back(scene.objects[0]);
    scene.objects[1].material.base = vec3(0.9f);
    scene.objects[1].transform.translate = {0.5f, 0, 1};
    scene.lights.clear();
    scene.camera.height = 2;
    const Image image = rendered(scene, {8, 8}, scene::Aov::Color);
    const float keep = 1 - 0.3f;                       // 1 - ks of the base colour
    EXPECT_NEAR(image.at(2, 4)[0], 0.1f * keep, 1e-6); // x = -0.375: the lower one
    EXPECT_NEAR(image.at(4, 4)[0], 0.9f * keep, 1e-6); // x = 0.125: both
    EXPECT_EQ(image.at(0, 0)[3], 0);                   // the corner: none
    scene.objects[1].visible = false;
    EXPECT_NEAR(rendered(scene, {8, 8}, scene::Aov::Color).at(4, 4)[0], 0.1f * keep, 1e-6);
}

TEST(RenderRelief, AlphaIsCoverageOnly) {
    scene::Scene scene = roughScene();
    const Image opaque = rendered(scene, {4, 4}, scene::Aov::Color);
    auto alpha = std::make_shared<Image>(2, 1, 1);
    alpha->pixels = {0, 1};
    scene.objects[0].field().alpha = alpha;
    const Image masked = rendered(scene, {4, 4}, scene::Aov::Color);
    // Pixel centres at 1/8, 3/8, 5/8, 7/8; alpha is 0 up to 1/4 and 1 from 3/4, linear between.
    const float expected[] = {0, 0.25f, 0.75f, 1};
    for (int x = 0; x < 4; ++x) {
        EXPECT_NEAR(masked.at(x, 1)[3], expected[x], 1e-6);
        EXPECT_EQ(masked.at(x, 1)[0], x == 0 ? 0 : opaque.at(x, 1)[0]);
    }
}

TEST(RenderRelief, NormalisingDividesTheLightAndNotTheBaseColour) {
    scene::Scene scene = roughScene();
    scene.objects[0].material.base = vec3(0);
    const Image one = rendered(scene, {4, 4}, scene::Aov::Color);
    scene.lights.push_back(scene.lights[0]);
    const Image two = rendered(scene, {4, 4}, scene::Aov::Color);
    const auto divided = renderRelief(
        scene, {4, 4}, scene::Aov::Color, {.normalise = true}, [](double) {}, kGoOn);
    ASSERT_TRUE(divided.ok());
    for (int x = 0; x < 4; ++x) {
        EXPECT_NEAR(two.at(x, 1)[0], 2 * one.at(x, 1)[0], 1e-6);
        EXPECT_NEAR(divided->at(x, 1)[0], one.at(x, 1)[0], 1e-6);
    }
    scene.objects[0].material.base = vec3(0.5f);
    const auto based = renderRelief(
        scene, {4, 4}, scene::Aov::Color, {.normalise = true}, [](double) {}, kGoOn);
    EXPECT_NEAR(based->at(1, 1)[0] - divided->at(1, 1)[0], 0.7f * 0.5f, 1e-6); // 1 - ks
}

TEST(RenderRelief, ThreadsDoNotChangeThePicture) {
    const scene::Scene scene = roughScene();
    EXPECT_EQ(rendered(scene, {16, 9}, scene::Aov::Color, 1).pixels,
              rendered(scene, {16, 9}, scene::Aov::Color, 5).pixels);
}

TEST(RenderRelief, ReportsProgressUpToTheEnd) {
    std::vector<double> shares;
    ASSERT_TRUE(renderRelief(
                    roughScene(), {16, 16}, scene::Aov::Color, {},
                    [&](double share) { shares.push_back(share); }, kGoOn)
                    .ok());
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
    EXPECT_EQ(shares.back(), 1);
}

TEST(RenderRelief, StopsWhenCancelledAndRefusesOtherQuantities) {
    const std::atomic<bool> cancelled = true;
    const auto stopped = renderRelief(
        roughScene(), {16, 16}, scene::Aov::Color, {}, [](double) {}, cancelled);
    ASSERT_FALSE(stopped.ok());
    EXPECT_EQ(stopped.error().message, "truth: stopped before the picture was complete");
    const auto other = renderRelief(
        roughScene(), {16, 16}, scene::Aov::Depth, {}, [](double) {}, kGoOn);
    ASSERT_FALSE(other.ok());
    EXPECT_EQ(other.error().message, "truth: AOV \"depth\" has no reference; must be color or d");
}

} // namespace
} // namespace lucent::truth
