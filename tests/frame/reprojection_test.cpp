// The last picture as a camera sees it that has moved on, against the picture drawn from there.
#include "frame/Renderer.h"
#include "technique/Technique.h"
#include "tests/support/Fields.h"
#include "tests/support/Gl.h"
#include "tests/viewer/Window.h"

namespace lucent::frame {
namespace {

using support::boxAt;

struct Reprojection : support::GlTest {
    ivec2 size{192, 128};
    std::optional<Window> window;
    std::unique_ptr<Renderer> renderer;
    std::uint64_t revision = 0;
    // A relief on a floor that ends before the horizon, with boxes before it.
    scene::Scene scene = support::sceneOf(support::waves({64, 64}), 0.06f, 0.03f);

    void SetUp() override {
        GlTest::SetUp();
        if (!context) return;
        window.emplace(size);
        ASSERT_TRUE(window->ok());
        renderer = std::make_unique<Renderer>(*context);
        scene.objects[0].transform.rotate = {-90, 0, 0};
        scene::Object floor;
        floor.name = "floor";
        floor.shape = scene::Plane{{3, 3}};
        floor.transform.translate.y = -0.01f;
        scene.objects.push_back(floor);
        scene.objects.push_back(boxAt({0.35f, 0.3f, 0.1f}));
        scene.objects.push_back(boxAt({-0.3f, 0.25f, 0.4f}));
        scene.lights = {scene::DistantLight{.direction = {-1, -1.5f, -0.6f}, .irradiance = 3}};
        scene.camera.type = scene::Camera::Type::Perspective;
        scene.camera.target = {0, 0.1f, 0};
        look(0);
        technique::addSettings(scene);
    }
    void TearDown() override {
        renderer.reset();
        window.reset();
        GlTest::TearDown();
    }

    // From a place on a circle around the middle, at an angle of `degrees`.
    void look(float degrees) {
        const float angle = glm::radians(degrees);
        scene.camera.eye = {2.6f * std::sin(angle), 1.4f, 2.6f * std::cos(angle)};
    }
    // Draws the scene as it stands, a preview with half the pixels or a whole picture.
    void draw(bool coarse) {
        ++revision;
        for (;;) {
            const Result<Progress> progress =
                renderer->advance(scene, revision, size, coarse, coarse ? 2 : 1);
            ASSERT_TRUE(progress.ok()) << progress.error().message;
            if (progress->complete) return;
        }
    }
    // In the second frame: the first does not wait for programs that it asks for.
    Image shown(const scene::Camera* from = nullptr) {
        for (int frame = 0; frame < 2; ++frame) {
            const Status presented = renderer->present(scene, from);
            EXPECT_TRUE(presented.ok()) << presented.error().message;
        }
        return window->read();
    }
    // Mean difference of what a display shows, [0,1].
    static double apart(const Image& a, const Image& b) {
        double sum = 0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i)
            sum += std::abs(double(a.pixels[i]) - double(b.pixels[i]));
        return sum / double(a.pixels.size());
    }
    // What a reprojection by 8 degrees differs from the picture drawn there, and the picture from before.
    std::pair<double, double> differences(bool coarse) {
        draw(coarse);
        const Image before = shown();
        EXPECT_FALSE(renderer->isReprojected());
        look(8);
        const scene::Camera moved = scene.camera;
        if (!coarse) { // the next picture has begun
            const Result<Progress> begun = renderer->advance(scene, ++revision, size, true);
            EXPECT_TRUE(begun.ok() && !begun->complete);
        }
        const Image reprojected = shown(&moved);
        EXPECT_TRUE(renderer->isReprojected());
        draw(coarse);
        const Image drawn = shown(&moved);
        EXPECT_FALSE(renderer->isReprojected()) << "it is drawn from there";
        return {apart(reprojected, drawn), apart(before, drawn)};
    }
};

// A matt surface looks the same from everywhere: what differs is what was hidden, and outlines by half a
// pixel, of which a preview has few.
TEST_F(Reprojection, APreviewIsSeenByACameraThatHasMovedOn) {
    const auto [reprojected, before] = differences(true);
    EXPECT_LT(reprojected, 0.5 * before);
}

TEST_F(Reprojection, SoIsAWholePictureWhileTheNextIsDrawn) {
    if (!context->caps().software) GTEST_SKIP() << "this GPU draws the next one at once";
    size = {1536, 1024}; // takes several slices of work
    window.reset();
    window.emplace(size);
    const auto [reprojected, before] = differences(false);
    EXPECT_LT(reprojected, 0.25 * before);
}

// Overexposed, all is black or white. What a display shows is smoothed: light would be white far beyond
// outlines. With twice the pixels, shares of four texels are sixteenths.
TEST_F(Reprojection, PreviewsAreSmoothedAsTheyAreShown) {
    scene.objects.erase(scene.objects.begin());
    scene.view.exposure = 12;
    draw(true);
    int between = 0;
    for (const float value : shown().pixels) {
        const float sixteenths = 16 * value;
        EXPECT_NEAR(sixteenths, std::round(sixteenths), 16 * 1.01f / 255) << "a display has 255 steps";
        between += value > 0.1f && value < 0.9f;
    }
    EXPECT_GT(between, 100);
}

// It moves with its surface, not with what is seen through it.
TEST_F(Reprojection, GlassMovesWithItsSurface) {
    for (std::size_t i : {2, 3})
        scene.objects[i].material.kind = scene::Clear{};
    const auto [reprojected, before] = differences(true);
    EXPECT_LT(reprojected, 0.5 * before);
}

// What comes into the picture beside its old border is known, too.
TEST_F(Reprojection, TheEnvironmentStandsWhereItStands) {
    auto map = std::make_shared<Image>(64, 32, 3);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            std::fill_n(map->at(x, y), 3, 0.5f + 0.4f * std::sin(0.6f * float(x)));
    scene.environment.emplace().map = map;
    draw(true);
    const Image before = shown();
    look(25);
    const scene::Camera moved = scene.camera;
    const Image reprojected = shown(&moved);
    draw(true);
    const Image drawn = shown();
    double wrong = 0, changed = 0;
    for (int x = 0; x < size.x; ++x) {
        wrong = std::max(wrong, std::abs(double(reprojected.at(x, 4)[0]) - double(drawn.at(x, 4)[0])));
        changed = std::max(changed, std::abs(double(before.at(x, 4)[0]) - double(drawn.at(x, 4)[0])));
    }
    EXPECT_LT(wrong, 2.5 / 255);
    EXPECT_GT(changed, 0.2);
}

// Its pictures have no depths, and those of a picture before it are not theirs.
TEST_F(Reprojection, AnotherQuantityIsNotReprojected) {
    draw(true);
    draw(true);
    scene.view.show = scene::Aov::Normal;
    draw(true);
    look(8);
    const scene::Camera moved = scene.camera;
    shown(&moved);
    EXPECT_FALSE(renderer->isReprojected());
}

TEST_F(Reprojection, AParallelViewIsReprojectedToo) {
    scene.camera.type = scene::Camera::Type::Orthographic;
    scene.camera.height = 1.6f;
    const auto [reprojected, before] = differences(true);
    EXPECT_LT(reprojected, 0.25 * before);
}

} // namespace
} // namespace lucent::frame
