// Layered images: every surface once and in order, and how many there are without waiting for the GPU.
#include "views/Layers.h"

#include "tests/support/Gl.h"
#include "tests/truth/scenes.h"
#include "views/FieldTextures.h"

#include <set>

namespace lucent::views {
namespace {

using test::glass;

constexpr ivec2 kSize{32, 32};

// Square sheets of glass behind each other, 0.1 m apart, the nearest 5 m from an orthographic eye.
scene::Scene sheets(int count) {
    std::vector<scene::Object> objects;
    for (int i = 0; i < count; ++i) {
        objects.push_back(glass(scene::Plane{{2, 2}}, 1.5f, {0, 0, -0.1f * float(i)}));
        objects.back().transform.rotate = {90, 0, 0};
    }
    scene::Scene scene = test::sceneOf(std::move(objects));
    scene.camera.eye = {0, 0, 5};
    scene.camera.height = 1;
    return scene;
}

struct LayersTest : support::GlTest {
    int count(const scene::Scene& scene) {
        graph::TexturePool pool(context->device());
        ImageCache images(*context);
        Readings readings;
        return *countLayers(readings, "", pool, *context, makeEye(scene, 1), *drawablesOf(scene, images), 0,
                            kSize);
    }
    /// Draws layers and gives them back, nearest first.
    std::vector<Image> draw(const scene::Scene& scene, int count, const LayerQueries& queries = {}) {
        graph::TexturePool pool(context->device());
        ImageCache images(*context);
        graph::FrameGraph graph;
        const auto posed = recordPose(graph, *context, *drawablesOf(scene, images), 0);
        const auto layers =
            recordLayers(graph, *context, makeEye(scene, 1), *posed, kSize, count, {}, queries);
        EXPECT_TRUE(layers.ok());
        std::vector<Image> found(static_cast<std::size_t>(count));
        // What keeps the layers alive, and reads them while they are.
        const graph::Texture unused(context->device(), {.size = {1, 1}}, "unused");
        const graph::TextureId target = graph.import(unused.handle(), unused.desc(), "unused");
        graph.keep(target);
        graph.addPass("read", [&](graph::PassBuilder& pass) -> graph::Execute {
            sampleLayers(pass, *layers);
            pass.write(target);
            return
                [this, &found, images = layers->images](const graph::Resources& resources, graph::Commands&) {
                    for (std::size_t i = 0; i < found.size(); ++i)
                        found[i] = context->device().read(resources[images], int(i));
                };
        });
        const Status compiled = graph.compile();
        EXPECT_TRUE(compiled.ok());
        graph.execute(pool);
        return found;
    }
};

TEST_F(LayersTest, EverySheetIsALayerNearestFirst) {
    const scene::Scene scene = sheets(7);
    EXPECT_EQ(count(scene), 7);
    const auto layers = draw(scene, 8);
    for (int i = 0; i < 8; ++i) {
        const float* texel = layers[std::size_t(i)].at(13, 17);
        // Facing the eye: code 2 * object + 1; behind the last one nothing.
        EXPECT_EQ(texel[3], i < 7 ? float(2 * i + 1) : 0.0f) << i;
        EXPECT_NEAR(texel[0], i < 7 ? 5 + 0.1 * i : 0, 1e-6) << i;
        // The triangle's number: those of each object begin a row of their own, and two make a sheet.
        EXPECT_EQ(int(texel[1]) / kVerticesPerRow, i < 7 ? i : 0) << i;
        std::set<float> numbers;
        for (const ivec2 pixel : {ivec2(3, 9), ivec2(9, 28), ivec2(28, 22), ivec2(22, 3)})
            numbers.insert(layers[std::size_t(i)].at(pixel.x, pixel.y)[1]);
        EXPECT_EQ(numbers.size(), i < 7 ? 2u : 1u) << i;
    }
}

TEST_F(LayersTest, SheetsInOnePlaceAreBothThere) {
    scene::Scene scene = sheets(2);
    scene.objects[1].transform.translate = scene.objects[0].transform.translate;
    EXPECT_EQ(count(scene), 2);
    const auto layers = draw(scene, 2);
    EXPECT_EQ(layers[0].at(5, 5)[0], layers[1].at(5, 5)[0]);
    EXPECT_EQ(layers[0].at(5, 5)[3], 1);
    EXPECT_EQ(layers[1].at(5, 5)[3], 3);
}

TEST_F(LayersTest, MoreSurfacesThanLayersAreCapped) {
    // 20 balls inside each other: 40 surfaces.
    std::vector<scene::Object> balls;
    for (int i = 0; i < 20; ++i)
        balls.push_back(glass(scene::Sphere{1 - 0.01f * float(i)}, 1.5f));
    scene::Scene scene = test::sceneOf(std::move(balls));
    scene.camera.eye = {0, 0, 5};
    scene.camera.height = 1;
    testing::internal::CaptureStderr();
    EXPECT_EQ(count(scene), kMostLayers);
    EXPECT_EQ(
        testing::internal::GetCapturedStderr(),
        "warning: views: 40 refractive surfaces lie behind each other; the nearest 32 are drawn, and rays go "
        "straight on behind them\n");
}

TEST_F(LayersTest, ACountFollowsTheSceneWithoutReadingBack) {
    for (const int delay : {0, 3}) { // of the answers
        context->device().delayQueries(delay);
        LayerCount counter(context->device());
        const auto frame = [&](const scene::Scene& scene) {
            const bool again = counter.poll();
            const int layers = counter.drawn();
            draw(scene, layers, counter.ask());
            return again;
        };
        // Frames until the count is right and no answer changes it any more.
        const auto settle = [&](const scene::Scene& scene, int expected) {
            int redraws = 0, changedLast = 0;
            for (int i = 0; i < 60; ++i) {
                const int before = counter.drawn();
                redraws += frame(scene);
                if (counter.drawn() != before) changedLast = i;
            }
            EXPECT_EQ(counter.drawn(), expected) << delay;
            EXPECT_LT(changedLast, 50) << delay;
            return redraws;
        };
        counter.start(count(sheets(3)));
        EXPECT_EQ(counter.drawn(), 3);
        EXPECT_EQ(settle(sheets(3), 3), 0) << "a still scene asks for no redraw";
        EXPECT_EQ(settle(sheets(6), 6), 3) << "each answer finds one surface more";
        EXPECT_EQ(settle(sheets(2), 2), 0) << "fewer surfaces are no reason to draw again";
    }
    context->device().delayQueries(0);
}

} // namespace
} // namespace lucent::views
