// What the camera meets, against closed forms.
#include "tests/support/Fields.h"
#include "tests/support/Gl.h"

namespace lucent::views {
namespace {

struct Surface : support::GlTest {
    Image show(scene::Scene& scene, scene::Aov aov, ivec2 size) {
        scene.view.show = aov;
        frame::Renderer renderer(*context);
        EXPECT_TRUE(renderer.finish(scene, 1, size).ok());
        Result<Image> image = renderer.read(scene, aov);
        EXPECT_TRUE(image.ok());
        return std::move(*image);
    }
};

TEST_F(Surface, SeenFromAboveEveryPixelIsATexel) {
    auto scene = support::sceneOf(support::waves({32, 24}), 0.3f, 0.05f);
    const Image position = show(scene, scene::Aov::Position, {32, 24});
    for (int y = 0; y < 24; ++y) {
        for (int x = 0; x < 32; ++x) {
            // Texel centres: x grows to the right, image row 0 is at +y; the field is 1 m wide and 24/32 m
            // high.
            EXPECT_NEAR(position.at(x, y)[0], (x + 0.5f) / 32 - 0.5f, 1e-6);
            EXPECT_NEAR(position.at(x, y)[1], 24.0f / 64 - (y + 0.5f) / 32, 1e-6);
            EXPECT_NEAR(position.at(x, y)[2], 0.3f * *scene.objects[0].field().heights->at(x, y), 1e-6);
            EXPECT_EQ(position.at(x, y)[3], 1);
        }
    }
}

TEST_F(Surface, ASlopeSeenFromTheSideIsThePlaneAndTheWall) {
    // Height rises with x: z = 0.2 (x + 1/2) between the outer texel centres.
    const auto ramp = support::heights({64, 64}, [](int x, int) { return (float(x) + 0.5f) / 64; });
    auto scene = support::sceneOf(ramp, 0.2f, 0.05f);
    scene.camera.eye = {1.5f, 0, 1.5f};
    scene.camera.up = {0, 0, 1};
    scene.camera.height = 1.2f;
    const Image position = show(scene, scene::Aov::Position, {96, 96});
    const Image normal = show(scene, scene::Aov::Normal, {96, 96});
    int onPlane = 0, onWall = 0;
    for (int y = 0; y < 96; ++y) {
        for (int x = 0; x < 96; ++x) {
            const float* p = position.at(x, y);
            const float* n = normal.at(x, y);
            if (p[3] == 0) continue;
            if (n[0] > 0.99f) { // the wall at +x faces the camera
                EXPECT_NEAR(p[0], 0.5f, 1e-5);
                EXPECT_GE(p[2], -1e-6);
                ++onWall;
            } else if (std::abs(p[0]) < 0.48f) {
                EXPECT_NEAR(p[2], 0.2f * (p[0] + 0.5f), 2e-6);
                EXPECT_NEAR(n[0], -0.2 / std::sqrt(1.04), 1e-5); // (-slope, 0, 1) normalised
                ++onPlane;
            }
        }
    }
    EXPECT_GT(onPlane, 1500);
    EXPECT_GT(onWall, 100);
}

TEST_F(Surface, PerspectiveDepthIsTheDistanceAlongTheAxis) {
    auto scene = support::sceneOf(support::heights({8, 8}, [](int, int) { return 0.5f; }), 0.2f, 0.05f);
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {0, 0, 3};
    scene.camera.fov = 10;
    const Image depth = show(scene, scene::Aov::Depth, {16, 16});
    for (int i = 0; i < 16 * 16; ++i)
        EXPECT_NEAR(depth.pixels[i * 4], 2.9f, 1e-5); // 3 - 0.1 everywhere
}

TEST_F(Surface, TheNearerObjectHidesTheFarther) {
    auto scene = support::sceneOf(support::heights({8, 8}, [](int, int) { return 0.0f; }), 0.1f, 0.05f);
    scene::Object upper = scene.objects[0];
    upper.name = "upper";
    upper.transform.translate = {0.25f, 0, 0.5f};
    for (bool upperFirst : {false, true}) {
        scene::Scene both = scene;
        both.objects.insert(upperFirst ? both.objects.begin() : both.objects.end(), upper);
        const Image depth = show(both, scene::Aov::Position, {32, 32});
        EXPECT_NEAR(depth.at(24, 16)[2], 0.5f, 1e-5);
        EXPECT_NEAR(depth.at(4, 16)[2], 0.0f, 1e-5);
    }
}

TEST_F(Surface, AlphaMasksThePictureOnly) {
    auto scene = support::sceneOf(support::waves({32, 32}), 0.1f, 0.05f);
    scene.objects[0].field().alpha = support::heights({2, 1}, [](int x, int) { return float(x); });
    const Image image = show(scene, scene::Aov::Position, {32, 32});
    // Two alpha texels, 0 and 1, bilinear between their centres at a quarter and three quarters of the width.
    EXPECT_EQ(image.at(4, 16)[3], 0);
    EXPECT_NEAR(image.at(15, 16)[3], (15.5 / 32 - 0.25) / 0.5, 1e-5);
    EXPECT_EQ(image.at(28, 16)[3], 1);
}

TEST_F(Surface, AnObjectTurnsWithItsTransform) {
    auto scene = support::sceneOf(support::waves({32, 32}), 0.2f, 0.05f);
    const Image before = show(scene, scene::Aov::Position, {32, 32});
    scene.objects[0].transform.rotate = {0, 0, 90};
    const Image after = show(scene, scene::Aov::Position, {32, 32});
    // Turned a quarter to the left, the texel that stood at column x, row y stands at column y, row 31 - x.
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
            EXPECT_NEAR(after.at(y, 31 - x)[2], before.at(x, y)[2], 1e-5);
}

} // namespace
} // namespace lucent::views
