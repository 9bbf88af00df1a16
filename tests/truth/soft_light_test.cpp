#include "truth/RenderRelief.h"

#include "tests/truth/fields.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace lucent::truth {
namespace {
using test::fieldOf;
using test::noise;

constexpr dvec3 kDown{0, 0, -1};
const std::atomic<bool> kGoOn = false;

LightSource sun(const dvec3& toLight, double radius) {
    LightSource light;
    light.place = glm::normalize(toLight);
    light.distant = true;
    light.radius = radius;
    return light;
}

scene::Object flatObject(float depth) {
    scene::Object object;
    object.shape = test::shapeOf(64, 64, 8, 0.1f, [](int, int) { return 0.5f; });
    object.material.diffuse = vec3(1);
    object.material.relief().depth = depth;
    return object;
}

Shading shadeMiddle(const scene::Object& object, const LightSource& lamp, int samples = 256,
                    std::uint64_t seed = 1) {
    const Field field(object.field());
    return shade(field, object, field.pointAbove({0, 0}), kDown, {{lamp}, {}}, Attenuation::Ratio,
                 {samples, Random(seed, 0, 0)});
}

/// The estimate is near its closed form, by its own standard error: 4 sigma, and some rounding.
void expectWithin(double estimate, double variance, double exact, double largestError) {
    EXPECT_NEAR(estimate, exact, 4 * std::sqrt(variance) + 1e-12);
    EXPECT_LT(std::sqrt(variance), largestError); // or the first line says nothing
}

TEST(SoftLight, PlacesOnTheDiscAreEvenByArea) {
    // Cells of equal area: as many of 8² = 64 in the inner half of the area as outside it, by symmetry a mean
    // of 0, and a mean squared radius of 1/2.
    constexpr int kRings = 8;
    dvec2 mean{0};
    double squares = 0;
    Random random(3, 0, 0);
    for (int round = 0; round < 200; ++round)
        for (int cell = 0; cell < kRings * kRings; ++cell) {
            const dvec2 place = placeInDiscCell(kRings, cell, random.nextPair());
            ASSERT_LT(glm::length(place), 1 + 1e-12);
            mean += place;
            squares += glm::dot(place, place);
        }
    constexpr double kCount = 200 * kRings * kRings;
    EXPECT_NEAR(glm::length(mean) / kCount, 0, 1e-3); // a cell is 1/8 wide: 0.04/sqrt(12800) an axis, times 3
    EXPECT_NEAR(squares / kCount, 0.5, 1e-3);
}

TEST(SoftLight, ASunInTheZenithGivesTheMeanCosineOfItsDisc) {
    // cos = 1 / sqrt(1 + T² q²) at the share q of the radius: its mean by area is 2 (sqrt(1 + T²) - 1) / T²,
    // which is 2 / (sqrt(1 + T²) + 1).
    for (const double degrees : {0.53, 20.0, 90.0}) {
        const double T = std::tan(degrees * std::numbers::pi / 360);
        const Shading shading = shadeMiddle(flatObject(0.05f), sun({0, 0, 1}, T));
        expectWithin(shading.illumination, shading.illuminationVariance, 2 / (std::sqrt(1 + T * T) + 1),
                     1e-4);
        expectWithin(shading.color.g, shading.colorVariance.g, 2 / (std::sqrt(1 + T * T) + 1), 1e-4);
    }
}

TEST(SoftLight, ALampWiderThanItsDistanceFadesPointByPoint) {
    // The lamp hangs D over p', 3 D in radius. Without falloff the mean cosine is as that of a sun with T =
    // 3; with the square of each point's own distance it is 2/R² (1 - D / sqrt(D² + R²)).
    const scene::Object object = flatObject(0.25f);
    const Field field(object.field());
    const double D = 0.5, R = 3 * D;
    LightSource lamp;
    lamp.place = field.pointAbove({0, 0}).position + dvec3(0, 0, D - 0.25);
    lamp.radius = R;
    const Shading plain = shadeMiddle(object, lamp);
    expectWithin(plain.illumination, plain.illuminationVariance, 2 * (std::sqrt(10) - 1) / 9, 1e-3);
    lamp.inverseSquare = true;
    const Shading fading = shadeMiddle(object, lamp);
    expectWithin(fading.color.r, fading.colorVariance.r, 2 / (R * R) * (1 - D / std::hypot(D, R)), 1e-2);
}

TEST(SoftLight, OfADiscOnTheHorizonTheUpperHalfShines) {
    // The directions (1, T y, T z) with z > 0; cos = T z / sqrt(1 + T² q²). Over the disc it has the mean
    // (sqrt(1 + T²) / T - asinh(T) / T²) / pi.
    const double T = std::tan(15 * std::numbers::pi / 180);
    const Shading shading = shadeMiddle(flatObject(1e-6f), sun({1, 0, 0}, T), 4096);
    expectWithin(shading.illumination, shading.illuminationVariance,
                 (std::sqrt(1 + T * T) / T - std::asinh(T) / (T * T)) / std::numbers::pi, 1e-3);
}

TEST(SoftLight, TheDiscFacesTheMovedPoint) {
    LightSource lamp;
    lamp.place = {1, 2, 3};
    lamp.radius = 0.5;
    const dvec3 from{-1, 0, 2};
    const dvec3 way = glm::normalize(lamp.place - from);
    for (const dvec2 place : {dvec2(1, 0), dvec2(0, 1), dvec2(-0.3, 0.8)}) {
        const LightSource point = pointOnDisc(lamp, from, place);
        EXPECT_NEAR(glm::dot(point.place - lamp.place, way), 0, 1e-12);
        EXPECT_NEAR(glm::distance(point.place, lamp.place), 0.5 * glm::length(place), 1e-12);
        EXPECT_EQ(point.radius, 0);
    }
    // At the lamp's own place there is no way to face: nothing that is not a number comes of it.
    EXPECT_NEAR(glm::distance(pointOnDisc(lamp, lamp.place, {1, 0}).place, lamp.place), 0.5, 1e-12);
}

TEST(SoftLight, HardFieldsAndDiscsNeverLeaveTheUnitInterval) {
    for (const float height : {0.f, 0.3f, 1e4f})
        for (const float depth : {1e-6f, 0.05f, 10.f}) {
            scene::Object object = flatObject(depth);
            object.shape = test::shapeOf(9, 7, 1, height, noise(2));
            const Field field(object.field());
            const SurfacePoint point = field.pointAbove({0.1, 0.05});
            const dvec3 below = point.position - double(depth) * point.normal;
            for (const double radius : {1e-9, 0.3, 1e6})
                for (const dvec3& place :
                     {point.position, below, dvec3(0, 0, -3), dvec3(0.3, 0.1, 1e-4), dvec3(1e6, 0, 5)})
                    for (const bool distant : {false, true}) {
                        if (distant && glm::length(place) == 0) continue;
                        LightSource lamp = sun(place, radius);
                        if (!distant) {
                            lamp.distant = false;
                            lamp.place = place;
                        }
                        const Shading shading = shade(field, object, point, kDown, {{lamp}, {}},
                                                      Attenuation::Ratio, {16, Random(1, 0, 0)});
                        EXPECT_GE(shading.illumination, 0);
                        EXPECT_LE(shading.illumination, 1 + 1e-12);
                        EXPECT_GE(shading.illuminationVariance, 0);
                        EXPECT_LE(shading.illuminationVariance, 1); // no NaN: that compares false
                        EXPECT_LE(shading.color.r, 1 + 1e-12);
                    }
        }
}

/// Root of the mean of ((estimate - exact) / standard error)² over places and seeds; 1 when errors are
/// honest.
struct Honesty {
    double score = 0;
    double error = 0; ///< root of the mean variance
};
Honesty honesty(int count, const std::function<Shading(int seed)>& estimate, double exact) {
    double scores = 0, variances = 0;
    for (int seed = 0; seed < count; ++seed) {
        const Shading shading = estimate(seed);
        const double off = shading.illumination - exact;
        scores += off * off;
        variances += shading.illuminationVariance;
    }
    return {std::sqrt(scores / variances), std::sqrt(variances / count)};
}

TEST(SoftLight, TheStandardErrorIsThatOfOtherSeedsAndShrinks) {
    // A rough field, the lamp half hidden behind it. 400 seeds know their own spread to 4 %, and the
    // variances' heavy tails are left room.
    scene::Object object = flatObject(0.05f);
    object.shape = test::shapeOf(16, 16, 1, 0.3f, noise(5));
    LightSource lamp;
    lamp.place = {0.4, 0.3, 0.35};
    lamp.radius = 0.2;
    const double exact = shadeMiddle(object, lamp, 1 << 16).illumination;
    double before = 1;
    for (const int samples : {16, 64, 256}) {
        const Honesty found = honesty(
            400, [&](int seed) { return shadeMiddle(object, lamp, samples, std::uint64_t(seed)); }, exact);
        EXPECT_NEAR(found.score, 1, 0.2) << samples;
        EXPECT_LT(found.error, before / 2 * 1.1) << samples; // strata do better than 1/sqrt(n)
        before = found.error;
    }
}

TEST(Environment, TheStandardErrorIsThatOfOtherSeedsAndShrinks) {
    Image map(64, 32, 3);
    for (std::size_t i = 0; i < map.pixels.size(); ++i)
        map.pixels[i] = float((i / 3) % 7) + (i / 3 == 500 ? 300 : 0);
    scene::Environment environment;
    environment.map = std::make_shared<Image>(map);
    scene::Object object = flatObject(0.05f);
    object.shape = test::shapeOf(16, 16, 1, 0.3f, noise(5));
    const Field field(object.field());
    const auto estimate = [&](int count, Choice choice, int seed) {
        const Lighting lighting{{}, environmentLights(environment, count, choice, std::uint64_t(seed))};
        Shading shading =
            shade(field, object, field.pointAbove({0.1, 0.1}), kDown, lighting, Attenuation::Ratio);
        if (choice == Choice::ByLight) {
            shading.illumination = shading.color.g;
            shading.illuminationVariance = shading.colorVariance.g;
        }
        return shading;
    };
    for (const Choice choice : {Choice::Evenly, Choice::ByLight}) {
        const double exact = estimate(1 << 17, choice, 9999).illumination;
        double before = 1e9;
        for (const int count : {64, 256, 1024}) {
            const Honesty found = honesty(
                200, [&](int seed) { return estimate(count, choice, seed); }, exact);
            EXPECT_NEAR(found.score, 1, 0.2) << count;
            EXPECT_LT(found.error, before / 2 * 1.1) << count;
            before = found.error;
        }
    }
}

/// A rough field under a soft lamp and a sky.
scene::Scene softScene() {
    scene::Scene scene;
    scene::Object object;
    object.name = "field";
    object.shape = test::shapeOf(16, 16, 1, 0.2f, noise(3));
    object.material.relief().depth = 0.04f;
    scene.objects.push_back(object);
    scene::PointLight lamp;
    lamp.radius = 0.1f;
    scene.lights.push_back(lamp);
    scene.environment.emplace();
    Image map(4, 2, 3);
    for (std::size_t i = 0; i < map.pixels.size(); ++i)
        map.pixels[i] = float(i) / 24;
    scene.environment->map = std::make_shared<Image>(map);
    return scene;
}

Picture solved(const scene::Scene& scene, ivec2 size, const ReliefOptions& options, const Tile& tile = {}) {
    const ReliefEstimator estimator(scene, size, scene::Aov::Color, options);
    Result<Picture> picture = render(estimator, size, tile, {.threads = options.threads}, kGoOn);
    EXPECT_TRUE(picture.ok());
    return *picture;
}

TEST(ReliefEstimator, DependsOnTheSeedAndNotOnThreadsOrTiles) {
    const scene::Scene scene = softScene();
    const ivec2 size(13, 11);
    const ReliefOptions options{.environmentLights = 64, .threads = 1, .discSamples = 16, .seed = 5};
    const Picture whole = solved(scene, size, options);
    ReliefOptions other = options;
    other.threads = 4;
    EXPECT_EQ(solved(scene, size, other).values.pixels, whole.values.pixels);
    other.seed = 6;
    EXPECT_NE(solved(scene, size, other).values.pixels, whole.values.pixels);
    for (const int count : {2, 3, 11})
        for (int index = 0; index < count; ++index) {
            const Tile tile{index, count};
            const Picture part = solved(scene, size, options, tile);
            ASSERT_EQ(part.values.height, tile.rows(size.y));
            for (int row = 0; row < part.values.height; ++row)
                for (int x = 0; x < size.x; ++x) {
                    for (int channel = 0; channel < 4; ++channel)
                        EXPECT_EQ(part.values.at(x, row)[channel],
                                  whole.values.at(x, tile.row(row))[channel]);
                    for (int channel = 0; channel < 3; ++channel)
                        EXPECT_EQ(part.errors.at(x, row)[channel],
                                  whole.errors.at(x, tile.row(row))[channel]);
                }
        }
}

TEST(ReliefEstimator, ThePicturesStandardErrorIsItsRmseToTheExactOne) {
    const scene::Scene scene = softScene();
    const ivec2 size(16, 16);
    const Picture rough = solved(scene, size, {.environmentLights = 64, .discSamples = 16, .seed = 1});
    const Picture fine =
        solved(scene, size, {.environmentLights = 1 << 14, .discSamples = 1 << 10, .seed = 2});
    double squares = 0;
    for (int i = 0; i < 16 * 16; ++i)
        for (int channel = 0; channel < 3; ++channel) {
            const double off = double(rough.values.pixels[std::size_t(4 * i + channel)]) -
                               double(fine.values.pixels[std::size_t(4 * i + channel)]);
            squares += off * off;
        }
    // The sky's error is common to all pixels: one picture is one throw of the dice, so a factor of 2 either
    // way.
    const double rmse = std::sqrt(squares / (3 * 16 * 16));
    EXPECT_LT(fine.standardError(), rough.standardError() / 10);
    EXPECT_GT(rmse, rough.standardError() / 2);
    EXPECT_LT(rmse, rough.standardError() * 2);
}

TEST(ReliefEstimator, ScalingEverythingTheLampsRadiusTooChangesNothing) {
    scene::Scene scene = softScene();
    scene.environment.reset();
    const ReliefOptions options{.discSamples = 16};
    const Picture before = solved(scene, {12, 12}, options);
    EXPECT_GT(before.standardError(), 0);
    auto& lamp = std::get<scene::PointLight>(scene.lights[0]);
    for (float* length : {&scene.objects[0].transform.scale, &scene.objects[0].material.relief().depth,
                          &lamp.radius, &scene.camera.height})
        *length *= 4;
    lamp.position *= 4;
    scene.camera.eye *= 4;
    const Picture after = solved(scene, {12, 12}, options);
    for (std::size_t i = 0; i < after.values.pixels.size(); ++i) // powers of two: the same digits
        EXPECT_NEAR(after.values.pixels[i], before.values.pixels[i], 1e-6);
}

TEST(ReliefEstimator, IsWithoutErrorUnderPointsAndSingleDirections) {
    scene::Scene scene = softScene();
    scene.environment.reset();
    scene.lights = {scene::PointLight{}, scene::DistantLight{}};
    EXPECT_EQ(solved(scene, {8, 8}, {}).standardError(), 0);
}

} // namespace
} // namespace lucent::truth
