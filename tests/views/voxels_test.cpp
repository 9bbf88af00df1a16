// Slices of depth: the same surfaces as peeling to half a slice, however few images a pass draws into, and
// what is left of those that share a slice.
#include "views/Voxels.h"

#include "tests/support/Gl.h"
#include "tests/truth/scenes.h"
#include "views/FieldTextures.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace lucent::views {
namespace {

using test::glass;

constexpr ivec2 kSize{64, 48};
constexpr float kNoDepth = -1e30f;

// Square sheets of glass at these distances from an orthographic eye.
scene::Scene sheets(const std::vector<float>& depths) {
    std::vector<scene::Object> objects;
    for (const float depth : depths) {
        objects.push_back(glass(scene::Plane{{3, 3}}, 1.5f, {0, 0, 5 - depth}));
        objects.back().transform.rotate = {90, 0, 0};
    }
    scene::Scene scene = test::sceneOf(std::move(objects));
    scene.camera.eye = {0, 0, 5};
    return scene;
}

// Balls inside each other.
scene::Scene shells(int count) {
    std::vector<scene::Object> balls;
    for (int i = 0; i < count; ++i)
        balls.push_back(glass(scene::Sphere{1 - float(i) / float(count)}, 1.5f));
    scene::Scene scene = test::sceneOf(std::move(balls));
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {0, 0, 3};
    scene.camera.fov = 45;
    return scene;
}

/// What was found, read back.
struct Found {
    vec2 bounds;
    std::vector<Image> peeled;  ///< depths, kNoDepth where there is none
    std::vector<Image> depths;  ///< by slices; empty on the fly
    std::vector<Image> extreme; ///< nearest, negated, and farthest
    Image deepest;
};

struct VoxelsTest : support::GlTest {
    void SetUp() override {
        GlTest::SetUp();
        if (context) cache.emplace(*context);
    }
    std::optional<ImageCache> cache; // of the test: tables of triangles take long to make

    /// @param peels  peeled layers as well
    Found find(const scene::Scene& scene, int count, const VoxelSettings& settings, bool peels = true) {
        graph::TexturePool pool(context->device());
        const Eye eye = makeEye(scene, float(kSize.x) / float(kSize.y));
        const auto drawn = drawablesOf(scene, *cache);
        graph::FrameGraph graph;
        const auto posed = recordPose(graph, *context, *drawn, 0);
        const auto layers = recordLayers(graph, *context, eye, *posed, kSize, count, {});
        const auto depths = recordVoxels(graph, *context, eye, *posed, kSize, count, settings);
        EXPECT_TRUE(layers.ok() && depths.ok());
        Found found{.bounds = depths->bounds, .peeled = {}, .depths = {}, .extreme = {}, .deepest = {}};
        const graph::Texture unused(context->device(), {.size = {1, 1}}, "unused");
        const graph::TextureId target = graph.import(unused.handle(), unused.desc(), "unused");
        graph.keep(target);
        graph.addPass("read", [&](graph::PassBuilder& pass) -> graph::Execute {
            if (peels) pass.sample(layers->images);
            sampleDepths(pass, *depths);
            pass.sample(depths->deepest);
            pass.write(target);
            return [&](const graph::Resources& resources, graph::Commands&) {
                gl::Device& device = context->device();
                found.deepest = device.read(resources[depths->deepest]);
                for (int i = 0; i < 2; ++i)
                    found.extreme.push_back(device.read(resources[depths->extreme], i));
                for (int layer = 0; peels && layer < count; ++layer) {
                    const Image texels = device.read(resources[layers->images], layer);
                    Image& peeled = found.peeled.emplace_back(kSize.x, kSize.y, 1);
                    for (std::size_t i = 0; i < peeled.pixels.size(); ++i)
                        peeled.pixels[i] = texels.pixels[4 * i + 3] > 0 ? texels.pixels[4 * i] : kNoDepth;
                }
                for (int layer = 0; !settings.onTheFly && layer < count; ++layer) {
                    const Image four = device.read(resources[depths->images], layer / 4);
                    Image& depth = found.depths.emplace_back(kSize.x, kSize.y, 1);
                    for (std::size_t i = 0; i < depth.pixels.size(); ++i)
                        depth.pixels[i] = four.pixels[4 * i + std::size_t(layer % 4)];
                }
            };
        });
        EXPECT_TRUE(graph.compile().ok());
        graph.execute(pool);
        return found;
    }
    VoxelCount count(const scene::Scene& scene, const VoxelSettings& settings = {}) {
        graph::TexturePool pool(context->device());
        const auto drawn = drawablesOf(scene, *cache);
        const auto found = countVoxels(pool, *context, makeEye(scene, float(kSize.x) / float(kSize.y)),
                                       *drawn, 0, kSize, settings);
        EXPECT_TRUE(found.ok());
        return *found;
    }
};

/// How many slices depths are off at most, and in how many places there is a surface in one and none in the
/// other.
struct Difference {
    double most = 0;
    int missing = 0, compared = 0;
};
Difference difference(const Found& found, const VoxelSettings& settings) {
    Difference result;
    for (std::size_t layer = 0; layer < found.peeled.size(); ++layer)
        for (std::size_t i = 0; i < found.peeled[layer].pixels.size(); ++i) {
            const float exact = found.peeled[layer].pixels[i], depth = found.depths[layer].pixels[i];
            if (exact == kNoDepth && depth == kNoDepth) continue;
            if (exact == kNoDepth || depth == kNoDepth) {
                ++result.missing;
                continue;
            }
            const double nearest = settings.local ? found.peeled[0].pixels[i] : found.bounds.x;
            const double farthest = settings.local ? found.extreme[1].pixels[4 * i] : found.bounds.y;
            const double slice = (farthest - nearest) / (settings.slices - 1);
            ++result.compared;
            // Depths near 3 m round by 2.4e-7, of two shaders apart.
            result.most = std::max(result.most, std::max(0.0, std::abs(exact - depth) - 1e-6) / slice);
        }
    return result;
}

TEST_F(VoxelsTest, TheFirstAndTheLastSurfaceAreThoseOfPeeling) {
    // By MAX, and, without blending of 32-bit floats, by the depth test.
    for (const bool blends : {true, false}) {
        const Found found = find(shells(3), 6, {.floatBlend = blends});
        int compared = 0;
        for (std::size_t i = 0; i < found.peeled[0].pixels.size(); ++i) {
            float last = kNoDepth;
            for (const Image& layer : found.peeled)
                last = std::max(last, layer.pixels[i]);
            const float first = found.peeled[0].pixels[i];
            EXPECT_NEAR(found.extreme[0].pixels[4 * i], first == kNoDepth ? kNoDepth : -first, 1e-6);
            EXPECT_NEAR(found.extreme[1].pixels[4 * i], last, 1e-6);
            compared += first != kNoDepth;
        }
        EXPECT_GT(compared, 800);
    }
}

TEST_F(VoxelsTest, SlicesAreHalfASliceFromPeeledLayers) {
    struct Case {
        int balls, slices;
        bool local;
    };
    for (const Case& one : {Case{1, 256, false}, {1, 512, true}, {10, 256, true}, {10, 512, false}}) {
        const VoxelSettings settings{.slices = one.slices, .local = one.local};
        const Difference found = difference(find(shells(one.balls), 2 * one.balls, settings), settings);
        EXPECT_LE(found.most, 0.501) << one.balls << " " << one.slices;
        EXPECT_EQ(found.missing, 0) << one.balls << " " << one.slices;
        EXPECT_GT(found.compared, 1600);
    }
}

TEST_F(VoxelsTest, FewerTargetsFindTheSame) {
    for (const auto& [slices, targets] : {std::pair(256, 1), std::pair(512, 5)}) {
        const Found eight = find(shells(5), 10, {.slices = slices}, false);
        const Found fewer = find(shells(5), 10, {.slices = slices, .targets = targets}, false);
        for (std::size_t layer = 0; layer < 10; ++layer)
            EXPECT_EQ(fewer.depths[layer].pixels, eight.depths[layer].pixels) << targets << " " << layer;
        EXPECT_EQ(fewer.deepest.pixels, eight.deepest.pixels);
    }
}

TEST_F(VoxelsTest, EveryLayersFarthestDepthIsFoundAtOnceOrOnTheFly) {
    for (const int slices : {256, 512}) {
        const Found once = find(shells(10), 20, {.slices = slices}, false);
        for (std::size_t layer = 0; layer < 20; ++layer) {
            const Image& depths = once.depths[layer];
            // Four layers a texel, from the left, four texels a row; the lowest row is the first.
            const int texel = int(layer) / 4;
            const float found = once.deepest.at(texel % 4, once.deepest.height - 1 - texel / 4)[layer % 4];
            EXPECT_EQ(found, *std::max_element(depths.pixels.begin(), depths.pixels.end())) << layer;
        }
        EXPECT_EQ(find(shells(10), 20, {.slices = slices, .onTheFly = true}, false).deepest.pixels,
                  once.deepest.pixels);
    }
}

TEST_F(VoxelsTest, TwoSheetsInOneSliceStayTwoAndLeaveTheOthersAlone) {
    // Slices of 1 cm between 5 m and 7.55 m. The second and third sheet share one: a carry, into a bit that
    // is free (slice 10) or taken (9 and 10), or, in the last of eight (slice 15), saturation.
    constexpr int kPixels = kSize.x * kSize.y;
    struct Case {
        std::vector<float> depths;
        long sharing, saturated;
    };
    for (const Case& one : {Case{{5, 5.1f, 5.101f, 6, 7.55f}, 2, 0}, Case{{5, 5.15f, 5.151f, 6, 7.55f}, 2, 1},
                            Case{{5, 5.1f, 5.3f, 6, 7.55f}, 0, 0}}) {
        const scene::Scene scene = sheets(one.depths);
        const Found found = find(scene, 6, {}, false);
        for (std::size_t layer = 0; layer < 5; ++layer)
            for (const float depth : found.depths[layer].pixels)
                EXPECT_NEAR(depth, one.depths[layer], 0.005 + 1e-5) << layer;
        for (const float depth : found.depths[5].pixels)
            EXPECT_EQ(depth, kNoDepth);
        const VoxelCount counted = count(scene);
        EXPECT_EQ(counted.surfaces, 5 * kPixels);
        EXPECT_EQ(counted.sharing, one.sharing * kPixels);
        EXPECT_EQ(counted.saturated, one.saturated * kPixels);
    }
}

TEST_F(VoxelsTest, MoreThanTwoInASliceStayAsManyAndNearIt) {
    // Three sheets in slice 10, one in 12: bits of their byte add up to 4 + 4 + 4 + 16 = 28, which reads as
    // slices 9, 9, 11 and 12.
    const std::vector<float> depths{5, 5.1f, 5.1005f, 5.101f, 5.12f, 7.55f};
    const Found found = find(sheets(depths), 7, {}, false);
    for (std::size_t layer = 0; layer < 6; ++layer)
        for (const float depth : found.depths[layer].pixels)
            EXPECT_NEAR(depth, depths[layer], 0.015 + 1e-5) << layer; // a slice and a half
    EXPECT_EQ(count(sheets(depths)).sharing, 4 * kSize.x * kSize.y);
}

TEST_F(VoxelsTest, AShellThinnerThanASliceIsReported) {
    // The shell's surfaces lie 1 mm apart at its middle and 1 mm / c where they stand at a cosine c to the
    // view; slices are 2 m c / 255 there. Rounded to the same one they are up to c = 0.5: on three quarters
    // of the disc.
    scene::Scene scene = shells(1);
    scene.objects.push_back(glass(scene::Sphere{0.999f}, 1));
    const VoxelCount thin = count(scene);
    EXPECT_GT(thin.sharing, thin.surfaces * 6 / 10);
    EXPECT_EQ(count(shells(1)).sharing, 0);
    EXPECT_EQ(difference(find(scene, 4, {}), {}).missing, 0);
}

TEST_F(VoxelsTest, TheNearestThirtyTwoOfFortySurfacesAreFound) {
    std::vector<float> depths;
    for (int i = 0; i < 40; ++i)
        depths.push_back(5 + 0.1f * float(i));
    const scene::Scene scene = sheets(depths);
    for (const int slices : {256, 512}) {
        const Found found = find(scene, kMostLayers, {.slices = slices}, false);
        const double half = 0.5 * 3.9 / (slices - 1) + 1e-5;
        for (std::size_t layer = 0; layer < std::size_t(kMostLayers); ++layer)
            EXPECT_NEAR(found.depths[layer].at(10, 10)[0], depths[layer], half) << layer;
        EXPECT_EQ(count(scene, {.slices = slices}).surfaces, 40 * kSize.x * kSize.y);
    }
}

} // namespace
} // namespace lucent::views
