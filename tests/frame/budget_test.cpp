// quality.maxError: the cheapest settings that keep a wanted error.
#include "scene/Environment.h"
#include "tests/support/Relief.h"

namespace lucent::frame {
namespace {

using support::reliefSettings;
using support::sceneOf;

struct Budget : support::ReliefTest {
    // RMSE over the mean; every pixel of these pictures shows the field.
    static double relativeError(const Image& image, const Image& exact) {
        double mean = 0;
        for (std::size_t i = 0; i < exact.pixels.size(); ++i)
            if (i % 4 != 3) mean += exact.pixels[i] / (0.75 * double(exact.pixels.size()));
        return support::difference(image, exact).rms / mean;
    }
    static scene::Scene bumps() { return sceneOf(support::noise({64, 64}), 0.2f, 0.03f); }
    // A board of one kind of material that fills the picture, and a post that keeps light from it.
    template <class Kind>
    static scene::Scene post(Kind kind) {
        scene::Scene scene = bumps();
        scene.objects[0].shape = scene::Box{{1.5f, 1.5f, 0.1f}};
        scene.objects[0].material.kind = kind;
        scene.objects.push_back(scene.objects[0]);
        scene.objects[1].name = "post";
        scene.objects[1].shape = scene::Box{{0.2f, 0.2f, 0.5f}};
        return scene;
    }
    static void light(scene::Scene& scene) {
        scene.environment.emplace();
        scene.environment->map = std::make_shared<const Image>(scene::proceduralEnvironment("direction"));
    }
    void expectKept(scene::Scene scene, std::initializer_list<float> errors) {
        views::samplingOf(scene).directions = 2048;
        views::samplingOf(scene).lamp = 1024;
        const Image exact = render(scene, scene::Aov::Color);
        int lightsBefore = 0;
        for (const float wanted : errors) {
            scene.quality.maxError = wanted;
            Renderer renderer(*context);
            ASSERT_TRUE(renderer.finish(scene, 1, scene.size));
            const Stats stats = renderer.stats();
            EXPECT_LE(relativeError(*renderer.read(scene, scene::Aov::Color), exact), wanted)
                << stats.settings;
            EXPECT_LE(stats.predicted, wanted);
            EXPECT_GT(stats.lights, lightsBefore) << stats.settings;
            EXPECT_LT(stats.lights, 1024) << stats.settings;
            lightsBefore = stats.lights;
        }
    }
};

TEST_F(Budget, KeepsTheErrorAndTakesFewerLightsForALargerOne) {
    auto scene = bumps();
    light(scene);
    expectKept(scene, {0.1f, 0.03f, 0.01f});
}

TEST_F(Budget, ChoosesDirectionsForMattShapesToo) {
    auto scene = post(scene::Matt{});
    light(scene);
    expectKept(scene, {0.2f, 0.03f});
}

TEST_F(Budget, CountsThatSamplesOfAPixelHaveLightSamplesOfTheirOwn) {
    auto scene = post(scene::Matt{});
    light(scene);
    const auto lightsFor = [&](int pixelSamples) {
        views::samplingOf(scene).pixelSamples = pixelSamples;
        scene.quality.maxError = 0.02f;
        Renderer renderer(*context);
        EXPECT_TRUE(renderer.finish(scene, 1, scene.size));
        return renderer.stats().lights;
    };
    EXPECT_LT(1.5 * lightsFor(5), lightsFor(1)); // 1.9 times the error for each is the same for all
    expectKept(scene, {0.1f, 0.02f});
}

TEST_F(Budget, ChoosesForALampAndAnEnvironmentTogether) {
    auto scene = post(scene::Matt{});
    light(scene);
    scene::PointLight lamp;
    lamp.position = {0.6f, 0.4f, 0.7f};
    lamp.radius = 0.2f;
    scene.lights.push_back(lamp);
    expectKept(scene, {0.2f, 0.04f});
}

TEST_F(Budget, CountsThePointsOfALargeLamp) {
    auto scene = bumps();
    scene::PointLight lamp;
    lamp.radius = 0.2f;
    scene.lights.push_back(lamp);
    views::samplingOf(scene).lamp = 1024;
    const Image exact = render(scene, scene::Aov::Color);
    scene.quality.maxError = 0.02f;
    Renderer renderer(*context);
    ASSERT_TRUE(renderer.finish(scene, 1, scene.size));
    EXPECT_LE(relativeError(*renderer.read(scene, scene::Aov::Color), exact), 0.02);
    EXPECT_LT(renderer.stats().lights, 256);
}

TEST_F(Budget, LeavesPointsAndDirectionsAlone) {
    auto scene = bumps();
    scene.lights.push_back(support::distantLight(40, 70));
    scene.quality.maxError = 0.1f;
    Renderer renderer(*context);
    ASSERT_TRUE(renderer.finish(scene, 1, scene.size));
    EXPECT_EQ(renderer.stats().settings, "");
    EXPECT_EQ(renderer.stats().lights, 1);
}

// What a device keeps by default must not cost more than what the scene itself asks for.
TEST_F(Budget, KeepsADefaultErrorWithNoMoreThanTheScenesOwnSamples) {
    auto scene = post(scene::Matt{});
    light(scene);
    Renderer renderer(*context);
    std::uint64_t revision = 0;
    const auto lightsOf = [&](int directions) {
        views::samplingOf(scene).directions = directions;
        EXPECT_TRUE(renderer.finish(scene, ++revision, scene.size));
        return renderer.stats().lights;
    };
    const int few = lightsOf(128), many = lightsOf(2048);
    const Image exact = *renderer.read(scene, scene::Aov::Color);
    renderer.setDefaultError(0.03f);
    EXPECT_EQ(lightsOf(128), few); // as many would be drawn to choose
    EXPECT_EQ(renderer.stats().settings, "");
    EXPECT_LT(lightsOf(2048), many / 2);
    EXPECT_NE(renderer.stats().settings, "");
    EXPECT_LE(relativeError(*renderer.read(scene, scene::Aov::Color), exact), 0.03);
    scene.quality.maxError = 0.2f; // its own comes first
    EXPECT_LT(lightsOf(2048), few);
    scene.quality.maxError = 0;
    renderer.setDefaultError(0);
    EXPECT_EQ(lightsOf(2048), many);
}

TEST_F(Budget, TakesATransferThatIsThere) {
    auto scene = bumps();
    scene.environment.emplace();
    scene.environment->map = std::make_shared<const Image>(scene::proceduralEnvironment("sky"));
    reliefSettings(scene).method = relief::Method::Transfer;
    reliefSettings(scene).terms = relief::kMostTerms;
    Renderer renderer(*context);
    ASSERT_TRUE(renderer.finish(scene, 1, scene.size));
    scene.quality.maxError = 0.1f; // 16 directions would do, but the transfer costs nothing any more
    ASSERT_TRUE(renderer.finish(scene, 2, scene.size));
    EXPECT_NE(renderer.stats().settings.find("transfer"), std::string::npos);
    EXPECT_EQ(renderer.stats().passes, 2);
}

} // namespace
} // namespace lucent::frame
