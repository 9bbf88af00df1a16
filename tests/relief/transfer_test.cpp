// Transfer: one dot product a texel for any environment, against sums over thousands of directions.
#include "scene/Environment.h"
#include "techniques/relief/Transfer.h"
#include "tests/support/Relief.h"

namespace lucent::relief {
namespace {

using support::difference;
using support::reliefSettings;
using support::sceneOf;
using Transfer = support::ReliefTest;

void setEnvironment(scene::Scene& scene, std::shared_ptr<const Image> map) {
    scene.environment.emplace();
    scene.environment->map = std::move(map);
}

std::shared_ptr<const Image> named(const char* name) {
    return std::make_shared<const Image>(scene::proceduralEnvironment(name));
}

// Waves so long that a texel differs little from its neighbours.
float gentle(int x, int y) { return 0.5f + 0.5f * std::sin(0.2f * float(x)) * std::cos(0.15f * float(y)); }

// A dim sky with a disc of 10 degrees that sends half of the light, 40 degrees above the horizon.
std::shared_ptr<const Image> sunny() {
    auto map = std::make_shared<Image>(256, 128, 3);
    for (int y = 0; y < 128; ++y) {
        for (int x = 0; x < 256; ++x) {
            const float polar = (float(y) + 0.5f) / 128 * kPi, azimuth = (float(x) + 0.5f) / 128 * kPi;
            const vec3 d(std::sin(azimuth) * std::sin(polar), std::cos(polar),
                         std::cos(azimuth) * std::sin(polar));
            const vec3 sun(0.5f, 0.643f, 0.58f);
            const bool inside = glm::dot(d, glm::normalize(sun)) > std::cos(glm::radians(10.0f));
            for (int c = 0; c < 3; ++c)
                map->at(x, y)[c] = 0.5f + (inside ? 60.0f : 0.0f);
        }
    }
    return map;
}

double mean(const Image& image) {
    double sum = 0, covered = 0;
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        covered += image.pixels[i + 3] > 0 ? 3 : 0;
        sum += image.pixels[i] + image.pixels[i + 1] + image.pixels[i + 2];
    }
    return sum / covered;
}

double coverage(const Image& image) {
    double covered = 0;
    for (std::size_t i = 3; i < image.pixels.size(); i += 4)
        covered += image.pixels[i] > 0;
    return 4 * covered / double(image.pixels.size());
}

// RMSE of the colour over its mean where the field is seen, against 1500 directions summed exactly: those err
// by 0.2 % themselves.
double relativeError(support::ReliefTest& test, scene::Scene scene) {
    reliefSettings(scene).method = Method::Transfer;
    const Image fast = test.render(scene, scene::Aov::Color);
    reliefSettings(scene).method = Method::Hierarchy;
    views::samplingOf(scene).directions = 1500;
    const Image exact = test.render(scene, scene::Aov::Color);
    return difference(fast, exact).rms / std::sqrt(coverage(exact)) / mean(exact);
}

TEST_F(Transfer, IsWithinOnePercentOfManyDirections) {
    for (const auto& map : {named("rainbow"), named("sky"), sunny()}) {
        auto scene = sceneOf(support::noise({48, 48}), 0.2f, 0.04f);
        setEnvironment(scene, map);
        EXPECT_LE(relativeError(*this, scene), 0.01);
    }
}

TEST_F(Transfer, ScattersForwardAndShinesLikeTheSum) {
    for (auto type : {scene::Camera::Type::Orthographic, scene::Camera::Type::Perspective}) {
        auto scene = sceneOf(support::heights({48, 48}, gentle), 0.2f, 0.04f);
        setEnvironment(scene, named("rainbow"));
        scene.camera.type = type;
        scene.camera.eye = {0.3f, -0.8f, 1.2f}; // walls are seen
        scene.objects[0].material.relief().forwardScatter = 0.7f;
        scene.objects[0].material.relief().specularity = 0.3f;
        scene.objects[0].material.relief().specularFalloff = {0.2f, 1};
        scene.objects[0].transform.rotate = {20, -30, 10};
        // From an oblique eye a pixel lies between texels, where light is interpolated; the facets of the
        // bilinear surface, which are steeper or flatter than its texels' normals, then cost about a percent.
        EXPECT_LE(relativeError(*this, scene), 0.02);
    }
}

TEST_F(Transfer, TurnsTheEnvironmentWithoutTracingAgain) {
    auto scene = sceneOf(support::noise({48, 48}), 0.2f, 0.04f);
    setEnvironment(scene, named("direction"));
    reliefSettings(scene).method = Method::Transfer;
    frame::Renderer renderer(*context);
    ASSERT_TRUE(renderer.finish(scene, 1, scene.size));
    const Image before = *renderer.read(scene, scene::Aov::Color);
    scene.environment->rotation = {0, 120, 0};
    ASSERT_TRUE(renderer.finish(scene, 2, scene.size));
    EXPECT_EQ(renderer.stats().passes, 2); // gather and light
    EXPECT_GT(difference(*renderer.read(scene, scene::Aov::Color), before).rms, 0.01);
    scene.environment->rotation = {0, 360, 0};
    ASSERT_TRUE(renderer.finish(scene, 3, scene.size));
    // A full turn moves no direction by more than its rounding, 360 degrees * 2^-24, and few into another
    // cell.
    EXPECT_LE(difference(*renderer.read(scene, scene::Aov::Color), before).rms / mean(before), 1e-3);
}

TEST_F(Transfer, KeepsTheMeanUnderAUniformEnvironment) {
    auto scene = sceneOf(support::heights({32, 32}, [](int, int) { return 0.5f; }), 0.2f, 1e-6f);
    auto white = std::make_shared<Image>(4, 2, 3);
    std::fill(white->pixels.begin(), white->pixels.end(), 1.0f);
    setEnvironment(scene, white);
    reliefSettings(scene).method = Method::Transfer;
    // Mean of the cosine over the upper half, 1/2, and of nothing over the lower: 1/4. The cells of 6 degrees
    // and two stores in half floats (1e-3 each) are what is off.
    const Image d = render(scene);
    EXPECT_NEAR(d.at(16, 16)[0], 0.25, 0.25 * 5e-3);
}

} // namespace
} // namespace lucent::relief
