#include "truth/Lambert.h"

#include "truth/RenderRelief.h"

#include "tests/truth/fields.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lucent::truth {
namespace {
const std::atomic<bool> kGoOn = false;

/// A field in its limit, t far below half a texel, seen straight from above.
scene::Scene matt(const scene::HeightField& shape) {
    scene::Scene scene;
    scene::Object object;
    object.name = "field";
    object.shape = shape;
    object.material.diffuse = vec3(1);
    object.material.relief().depth = 1e-9f;
    scene.objects.push_back(object);
    return scene;
}
scene::Scene roughScene() { return matt(test::shapeOf(16, 16, 1, 0.2f, test::noise(3))); }
scene::Scene flatScene() {
    return matt(test::shapeOf(8, 8, 1, 0.1f, [](int, int) { return 0.5f; }));
}

void addSky(scene::Scene& scene, Image map) {
    scene.environment.emplace();
    scene.environment->intensity = 0.25f; // 4 pi sr over pi: colours are means over the sphere then
    scene.environment->map = std::make_shared<Image>(std::move(map));
}
Image white() {
    Image map(2, 1, 3);
    std::fill(map.pixels.begin(), map.pixels.end(), 1.f);
    return map;
}
Image spotted() {
    Image map(16, 8, 3);
    for (std::size_t i = 0; i < map.pixels.size(); ++i)
        map.pixels[i] = float(i % 5) / 4 + (i / 3 == 20 ? 50 : 0);
    return map;
}

Picture lambert(const scene::Scene& scene, ivec2 size, scene::Aov aov, int samples, std::uint64_t seed = 1) {
    auto estimator = LambertEstimator::create(scene, size, aov, {.samples = samples, .seed = seed});
    EXPECT_TRUE(estimator.ok());
    Result<Picture> picture = render(*estimator, size, {}, {}, kGoOn);
    EXPECT_TRUE(picture.ok());
    return *picture;
}
Picture relief(const scene::Scene& scene, ivec2 size, scene::Aov aov, int directions, int discSamples) {
    const ReliefEstimator estimator(
        scene, size, aov, {.environmentLights = directions, .discSamples = discSamples, .seed = 99});
    Result<Picture> picture = render(estimator, size, {}, {}, kGoOn);
    EXPECT_TRUE(picture.ok());
    return *picture;
}

/// Differences of two pictures in units of their standard errors.
struct Scores {
    double root = 0; ///< of the mean square, 1 when both tell their errors rightly
    double largest = 0;
};
Scores scores(const Picture& a, const Picture& b) {
    Scores found;
    double squares = 0;
    int count = 0;
    for (int y = 0; y < a.values.height; ++y)
        for (int x = 0; x < a.values.width; ++x) {
            const double sigma = std::hypot(double(a.errors.at(x, y)[1]), double(b.errors.at(x, y)[1])) +
                                 1e-7; // stored as floats
            const double score = (double(a.values.at(x, y)[1]) - double(b.values.at(x, y)[1])) / sigma;
            squares += score * score;
            found.largest = std::max(found.largest, std::abs(score));
            ++count;
        }
    found.root = std::sqrt(squares / count);
    return found;
}

TEST(Lambert, IsTheReliefModelsLimitUnderPointsAndSingleDirections) {
    scene::Scene scene = roughScene();
    scene::DistantLight low;
    low.direction = {-1, -0.3f, -0.4f};
    scene.lights = {scene::PointLight{}, low};
    for (const scene::Aov aov : {scene::Aov::Color, scene::Aov::Illumination}) {
        const Picture physics = lambert(scene, {40, 40}, aov, 1), model = relief(scene, {40, 40}, aov, 1, 1);
        EXPECT_EQ(physics.standardError(), 0);
        // Rounding may turn a ray by 1e-15, which shows where a shadow's edge runs through a pixel's very
        // middle: nowhere here.
        for (std::size_t i = 0; i < model.values.pixels.size(); ++i)
            ASSERT_NEAR(physics.values.pixels[i], model.values.pixels[i], 1e-6) << i;
    }
}

TEST(Lambert, IsTheReliefModelsLimitUnderSoftLightsAndSkies) {
    scene::Scene scene = roughScene();
    scene::PointLight lamp;
    lamp.radius = 0.2f;
    lamp.falloff = scene::LightFalloff::InverseSquare;
    scene::DistantLight sun;
    sun.direction = {-1, 0, -0.2f};
    sun.angle = 30; // partly below the horizon
    scene.lights = {lamp, sun};
    addSky(scene, spotted());
    for (const scene::Aov aov : {scene::Aov::Color, scene::Aov::Illumination}) {
        const Picture physics = lambert(scene, {16, 16}, aov, 1024),
                      model = relief(scene, {16, 16}, aov, 1 << 14, 1024);
        const Scores found = scores(physics, model);
        // 256 pixels know the root of 1 to 4.4 %: three of these, and what the model's shared sky adds.
        EXPECT_NEAR(found.root, 1, 0.2);
        EXPECT_LT(found.largest, 4.5); // of 256 normal numbers: one in 600 such pictures exceeds it
        EXPECT_LT(physics.standardError() / 10,
                  model.standardError() * 10); // neither hides the other's faults
    }
}

TEST(Lambert, NoLightComesThroughTheBottomOfThePointsOwnField) {
    // A steep pit whose walls reach z = 0 within a texel: light from its far rim downwards meets the ground.
    scene::Scene scene = matt(test::shapeOf(16, 16, 1, 1, test::noise(3)));
    Image below(1, 8, 3); // only the lower half shines
    std::fill(below.pixels.begin() + 12, below.pixels.end(), 1.f);
    addSky(scene, std::move(below));
    scene.environment->rotation = {90, 0, 0}; // the map's +y is the field's +z
    const Picture physics = lambert(scene, {16, 16}, scene::Aov::Color, 1024);
    const Picture model = relief(scene, {16, 16}, scene::Aov::Color, 1 << 13, 1);
    // Few directions see light, so single pixels are no normal numbers; the sum of all is.
    double off = 0, variance = 0, sum = 0;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) {
            off += double(physics.values.at(x, y)[1]) - double(model.values.at(x, y)[1]);
            variance += std::pow(double(physics.errors.at(x, y)[1]), 2);
            sum += double(model.values.at(x, y)[1]);
        }
    EXPECT_NEAR(off, 0, 4 * std::sqrt(variance));
    EXPECT_LT(std::sqrt(variance), 0.05 * sum); // or the line above says nothing
}

TEST(Lambert, AWhiteSkyLeavesAQuarterOnAFlatField) {
    scene::Scene scene = flatScene();
    addSky(scene, white());
    for (const scene::Aov aov : {scene::Aov::Color, scene::Aov::Illumination}) {
        const Picture picture = lambert(scene, {8, 8}, aov, 1000);
        double sum = 0;
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x) {
                EXPECT_NEAR(picture.values.at(x, y)[1], 0.25, 4 * double(picture.errors.at(x, y)[1]));
                // max(cos, 0) has the mean 1/4 and the mean square 1/6: a sample is off by sqrt(5/48).
                EXPECT_NEAR(picture.errors.at(x, y)[1], std::sqrt(5.0 / 48 / 1000), 1e-3);
                sum += double(picture.values.at(x, y)[1]) / 64;
            }
        EXPECT_NEAR(sum, 0.25, 4 * std::sqrt(5.0 / 48 / 64000));
    }
}

TEST(Lambert, TheStandardErrorShrinksWithTheRootOfTheSamples) {
    scene::Scene scene = roughScene();
    addSky(scene, spotted());
    const double before = lambert(scene, {16, 16}, scene::Aov::Color, 100).standardError();
    const double after = lambert(scene, {16, 16}, scene::Aov::Color, 1600).standardError();
    EXPECT_NEAR(before / after, 4, 0.1); // 256 pixels' variances from 100 samples each: known to about 1 %
}

TEST(Lambert, TwoSeedsDifferByTheirStandardErrors) {
    scene::Scene scene = roughScene();
    addSky(scene, spotted());
    const Scores found = scores(lambert(scene, {24, 24}, scene::Aov::Color, 256, 1),
                                lambert(scene, {24, 24}, scene::Aov::Color, 256, 2));
    EXPECT_NEAR(found.root, 1, 0.1); // 576 pixels: 3 %
}

TEST(Lambert, ObjectsShadowEachOtherThoseHiddenFromTheCameraToo) {
    // A sheet 0.25 m wide hangs 0.5 m over the middle of a field under a light from straight above.
    scene::Scene scene = flatScene();
    scene.lights = {scene::DistantLight{}};
    scene::Object sheet = scene.objects[0];
    sheet.shape = test::shapeOf(4, 4, 0.25f, 0, [](int, int) { return 0.f; });
    sheet.transform.translate = {0, 0, 0.5f};
    sheet.visible = false;
    scene.objects.push_back(sheet);
    const Picture picture = lambert(scene, {8, 8}, scene::Aov::Illumination, 1);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            const bool under = x >= 3 && x <= 4 && y >= 3 && y <= 4;
            EXPECT_NEAR(picture.values.at(x, y)[0], under ? 0 : 1, 1e-6) << x << ", " << y;
        }
}

TEST(Lambert, LeavesHighlightAndScatteringOutAndKeepsTheirShare) {
    scene::Scene scene = flatScene();
    scene::Material& material = scene.objects[0].material;
    material.base = vec3(0.5f);
    material.diffuse = {0.25f, 0.5f, 1};
    material.relief().specularity = 0.5f;
    material.relief().forwardScatter = 1;
    scene.lights = {scene::DistantLight{.irradiance = float(std::numbers::pi)}};
    const Picture picture = lambert(scene, {1, 1}, scene::Aov::Color, 1);
    for (int channel = 0; channel < 3; ++channel) // (1 - ks) (cB + cD 1)
        EXPECT_NEAR(picture.values.pixels[std::size_t(channel)],
                    0.5 * (0.5 + double(material.diffuse[channel])), 1e-6);
}

TEST(Lambert, ASceneWithoutLightIsDarkAndOtherQuantitiesAreRefused) {
    EXPECT_EQ(lambert(flatScene(), {2, 2}, scene::Aov::Illumination, 4).values.pixels[0], 0);
    scene::Scene black = flatScene();
    addSky(black, Image(2, 1, 3));
    EXPECT_EQ(lambert(black, {2, 2}, scene::Aov::Color, 4).values.pixels[0], 0);
    const auto refused = LambertEstimator::create(flatScene(), {2, 2}, scene::Aov::Normal, {});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().message, "truth: AOV \"normal\" has no reference; must be color or d");
}

} // namespace
} // namespace lucent::truth
