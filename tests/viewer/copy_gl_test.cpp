// Viewers that show what another one shows, for pictures of other sizes.
#include "scene/Load.h"
#include "technique/Technique.h"
#include "tests/viewer/Page.h"

namespace lucent::viewer {
namespace {

using Copy = Page;

constexpr const char* kBall = R"({"lucent": 1, "title": "Ball", "size": [64, 64],
 "camera": {"type": "orthographic", "eye": [0, 0, 2], "height": 1},
 "lights": [{"type": "point", "position": [0.1, 0.1, 1]}],
 "technique": {"sampling": {"pixelSamples": 1}, "subsurface": {"method": "lambert"}},
 "objects": [{"name": "ball", "shape": {"type": "sphere", "radius": 0.25}, "material": {"preset": "marble"}}]})";

TEST_F(Copy, ShowsTheSamePictureWithChangesAndPaint) {
    open({80, 60});
    load(kBall);
    viewer->setPanelVisible(false);
    ASSERT_TRUE(viewer->set("view.exposure", "1").ok());
    ASSERT_TRUE(
        viewer
            ->paint(R"({"lucentStrokes": 1, "strokes": [{"brush": "translucency", "value": 0, "fill": {}}]})")
            .ok());
    ASSERT_TRUE(viewer->set("matt", "true").ok());
    settle();
    const Image shown = window->read();
    const std::string scene = viewer->sceneJson();
    {
        Viewer copy(*context, *host);
        copy.resize({80, 60}, 1);
        copy.setPanelVisible(false);
        copy.copy(*viewer);
        while (copy.draw(time += 0.02)) {
        }
        EXPECT_EQ(window->read().pixels, shown.pixels);
        EXPECT_EQ(copy.sceneJson(), scene);
        EXPECT_EQ(copy.failure(), "");
        ASSERT_TRUE(copy.set("view.exposure", "-2").ok());
    }
    EXPECT_EQ(viewer->sceneJson(), scene);
    settle();
    EXPECT_EQ(differences(window->read(), shown), 0);
}

TEST_F(Copy, BareHasNoLightDot) {
    open({80, 60});
    load(kBall);
    viewer->setPanelVisible(false);
    settle();
    const Image withDot = window->read();
    viewer->setBare(true);
    settle();
    const Image bare = window->read();
    EXPECT_GT(differences(bare, withDot), 10);
    ASSERT_TRUE(viewer->set("view.lightDot", "false").ok());
    settle();
    EXPECT_EQ(window->read().pixels, bare.pixels);
}

// The tone curve of the picture, undone: what is linear is what the renderer has before it.
TEST_F(Copy, LinearValuesAreThoseOfThePicture) {
    open({80, 60});
    load(kBall);
    viewer->setPanelVisible(false);
    viewer->setBare(true);
    settle();
    const Result<Image> linear = viewer->linear();
    ASSERT_TRUE(linear.ok()) << linear.error().message;
    ASSERT_EQ(linear->size(), ivec2(80, 60));
    const Image shown = window->read();
    const auto encoded = [](float light) {
        const float x = std::clamp(light, 0.0f, 1.0f);
        return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
    };
    const std::size_t middle = 4 * (30 * 80 + 40);
    for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(encoded(linear->pixels[middle + c]), shown.pixels[middle + c], 1.0f / 255) << c;
    Viewer fresh(*context, *host);
    EXPECT_EQ(fresh.linear().error().message, "picture: is not finished; must be drawn first");
}

TEST_F(Copy, AnotherSceneHasAnotherNumber) {
    openCoarse();
    EXPECT_EQ(viewer->sceneNumber(), 0);
    load(kBall);
    EXPECT_EQ(viewer->sceneNumber(), 1);
    ASSERT_TRUE(viewer->set("view.exposure", "1").ok());
    viewer->undo();
    EXPECT_EQ(viewer->sceneNumber(), 1);
    load(kBall);
    EXPECT_EQ(viewer->sceneNumber(), 2);
}

} // namespace
} // namespace lucent::viewer
