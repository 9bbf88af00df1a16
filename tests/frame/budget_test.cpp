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
};

TEST_F(Budget, KeepsTheErrorAndTakesFewerLightsForALargerOne) {
    auto scene = bumps();
    scene.environment.emplace();
    scene.environment->map = std::make_shared<const Image>(scene::proceduralEnvironment("direction"));
    views::samplingOf(scene).directions = 2048;
    const Image exact = render(scene, scene::Aov::Color);
    int lightsBefore = 0;
    for (float wanted : {0.1f, 0.03f, 0.01f}) {
        scene.quality.maxError = wanted;
        Renderer renderer(*context);
        ASSERT_TRUE(renderer.finish(scene, 1, scene.size));
        EXPECT_LE(relativeError(*renderer.read(scene, scene::Aov::Color), exact), wanted);
        EXPECT_GT(renderer.stats().lights, lightsBefore);
        EXPECT_LE(renderer.stats().predicted, wanted);
        lightsBefore = renderer.stats().lights;
    }
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
