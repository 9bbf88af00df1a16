// Scenes that hold more than height fields: only the passes that a scene needs, and the techniques over each
// other.
#include "frame/Renderer.h"
#include "light/Samples.h"
#include "technique/Technique.h"
#include "techniques/caustics/Caustics.h"
#include "techniques/refract/Refract.h"
#include "tests/support/Fields.h"
#include "tests/support/Gl.h"
#include "truth/Glass.h"

#include <algorithm>
#include <chrono>
#include <deque>
#include <thread>

namespace lucent::frame {
namespace {

struct Composed : support::GlTest {
    scene::Scene scene;

    Composed() {
        scene.size = {64, 48};
        scene.camera.type = scene::Camera::Type::Perspective;
        scene.camera.eye = {0, 0.5f, 4};
        technique::addSettings(scene);
        scene.environment.emplace();
        auto map = std::make_shared<Image>(8, 4, 3);
        std::fill(map->pixels.begin(), map->pixels.end(), 0.5f);
        scene.environment->map = map;
    }
    void addBall() {
        scene::Object ball;
        ball.name = "ball";
        ball.shape = scene::Sphere{};
        ball.material.kind = scene::Clear{};
        scene.objects.push_back(ball);
    }
    void addFloor() {
        scene::Object floor;
        floor.name = "floor";
        floor.shape = scene::Plane{{8, 8}};
        floor.transform.translate = {0, -1.2f, 0};
        scene.objects.push_back(floor);
        scene.lights.push_back(scene::DistantLight{.direction = {-0.3f, -1, -0.2f}});
    }
    void addField() {
        scene::Object field = support::sceneOf(support::waves({40, 30}), 0.2f, 0.05f).objects[0];
        field.transform.translate = {0, 0, -1.5f};
        field.transform.scale = 3;
        scene.objects.push_back(field);
        if (scene.lights.empty()) scene.lights.push_back(scene::PointLight{});
    }
    // How often a pass of this name stands in what explain() says will run.
    int runs(const std::string& name) {
        Renderer renderer(*context);
        const Result<std::string> text = renderer.explain(scene, scene.size);
        EXPECT_TRUE(text.ok()) << text.error().message;
        int count = 0;
        for (std::size_t at = text->find("\n  " + name + ":"); at != std::string::npos;
             at = text->find("\n  " + name + ":", at + 1))
            ++count;
        return count;
    }
    Image picture(scene::Aov aov = scene::Aov::Color) {
        Renderer renderer(*context);
        scene.view.show = aov;
        EXPECT_TRUE(renderer.finish(scene, 1, scene.size).ok());
        Result<Image> image = renderer.read(scene, aov);
        EXPECT_TRUE(image.ok());
        return std::move(*image);
    }
};

TEST_F(Composed, AnIndexOfOneIsThePictureWithoutTheObject) {
    addFloor();
    scene.lights.push_back(scene::PointLight{.position = {0.4f, 1.8f, 0.3f}});
    const Image without = picture();
    addBall();
    scene.objects.back().material.clear().ior = 1;
    const Image within = picture();
    for (std::size_t i = 0; i < without.pixels.size(); ++i)
        if (i % 4 != 3 && without.pixels[i - i % 4 + 3] > 0) {
            ASSERT_NEAR(within.pixels[i], without.pixels[i], 1e-5) << i;
        }
    for (const char* pass : {"caustics.photon", "caustics.lookup"})
        EXPECT_EQ(runs(pass), 0) << pass;
}

// Heights of any material but relief are drawn as their body.
TEST_F(Composed, AReliefOfNoDepthIsTheMattBodyOfItsHeights) {
    // On a third of the texels its triangles, turned against their normals, shade each other a little.
    scene = support::sceneOf(support::waves({192, 144}), 0.05f, 1e-6f);
    scene.lights.push_back(scene::DistantLight{.direction = {-0.3f, 0.2f, -1}});
    views::samplingOf(scene).pixelSamples = 1; // texel centres: between them triangles cut corners
    const Image relief = picture();
    scene.objects[0].material.kind = scene::Matt{};
    EXPECT_EQ(runs("relief.light"), 0);
    EXPECT_EQ(runs("brdf.light"), 1);
    const Image body = picture();
    for (int y = 2; y < 142; ++y)
        for (int x = 2; x < 190; ++x)
            ASSERT_NEAR(body.at(x, y)[1], relief.at(x, y)[1], 1e-5) << x << " " << y;
}

TEST_F(Composed, AFlatFieldIsABoxOfWhateverItIsMadeOf) {
    addFloor();
    scene.lights.push_back(scene::PointLight{.position = {0.4f, 1.8f, 0.3f}});
    scene::Object thing;
    thing.name = "thing";
    thing.transform.translate = {0, 0.2f, 0};
    for (const scene::MaterialKinds& kind :
         {scene::MaterialKinds(scene::Matt{}), scene::MaterialKinds(scene::Mirror{vec3(0.5f)}),
          scene::MaterialKinds(scene::Clear{.absorption = {1, 0.2f, 0}}),
          scene::MaterialKinds(scene::Translucent{.scattering = vec3(30), .absorption = vec3(1)})}) {
        thing.material.kind = kind;
        thing.shape = scene::Box{{1, 0.3f, 0.5f}};
        scene.objects.push_back(thing);
        const Image box = picture();
        scene::Object& field = scene.objects.back();
        scene::HeightField flat;
        flat.heights = support::heights({8, 4}, [](int, int) { return 0.3f; });
        flat.heightScale = 1;
        field.shape = flat;
        field.transform.rotate = {-90, 0, 0};
        field.transform.translate = {0, 0.05f, 0};
        const Image body = picture();
        scene.objects.pop_back();
        double apart = 0, sum = 0;
        for (std::size_t i = 1; i < box.pixels.size(); i += 4) {
            apart += std::abs(double(box.pixels[i] - body.pixels[i]));
            sum += double(box.pixels[i]);
        }
        EXPECT_GT(sum, 0);
        // Edges fall on other sides of pixels' middles, and splats and rays of light on other triangles.
        EXPECT_LT(apart / sum, 0.01) << kind.index();
    }
}

TEST_F(Composed, ABallOfGlassRunsItsTwoLayersAndTheTraceOnly) {
    addBall();
    EXPECT_EQ(runs("views.peel"), 2);
    EXPECT_EQ(runs("refract.trace"), 1);
    EXPECT_EQ(runs("brdf.light"), 0);
    EXPECT_EQ(runs("relief.light"), 0);
    EXPECT_EQ(runs("views.surface"), 0);
}

// Frames of a page until the picture is complete, with what a display leaves a GPU between two of them:
// answers come meanwhile, however busy the machine is.
void complete(Renderer& renderer, const scene::Scene& scene, std::uint64_t revision, bool isPreview = false) {
    constexpr int kMostFrames = 3000;
    for (int frames = 0; frames < kMostFrames; ++frames) {
        const Result<Progress> progress = renderer.advance(scene, revision, scene.size, isPreview);
        ASSERT_TRUE(progress.ok()) << progress.error().message;
        if (progress->complete) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    FAIL() << "a picture is never complete";
}

// Balls in a row, seen from the side or along it.
TEST_F(Composed, LayersThatAppearAreDrawnWithoutReadingBack) {
    for (int i = 0; i < 3; ++i) {
        addBall();
        scene.objects.back().name = "ball " + std::to_string(i);
        scene.objects.back().shape = scene::Sphere{0.4f};
        scene.objects.back().transform.translate = {float(i) - 1, 0, 0};
    }
    scene.view.show = scene::Aov::Layers;
    const vec3 across{0, 0, 4}, along{4, 0, 0};
    for (const int delay : {0, 3}) { // of the answers
        context->device().delayQueries(delay);
        Renderer renderer(*context);
        std::uint64_t revision = 0;
        for (const vec3 eye : {across, along, across}) {
            scene.camera.eye = eye;
            complete(renderer, scene, ++revision);
            const Result<Image> found = renderer.read(scene, scene::Aov::Layers);
            ASSERT_TRUE(found.ok());
            const float most = *std::max_element(found->pixels.begin(), found->pixels.end());
            EXPECT_EQ(most, eye == along ? 6 : 2) << delay;
        }
    }
    context->device().delayQueries(0);
}

TEST_F(Composed, APreviewAsksNothingOfTheGpu) {
    addBall();
    addFloor(); // for its caustics
    context->device().delayQueries(1 << 30);
    Renderer renderer(*context);
    const int before = context->device().readCount();
    for (std::uint64_t revision = 1; revision < 4; ++revision) {
        scene.camera.eye.x += 0.1f;
        complete(renderer, scene, revision, true);
    }
    EXPECT_EQ(context->device().readCount(), before);
    complete(renderer, scene, 9); // an answer that does not come is read back in the end
    EXPECT_GT(context->device().readCount(), before);
    context->device().delayQueries(0);
}

// Where no knob is turned down, work goes on from it: its shadows must be the picture's.
TEST_F(Composed, APreviewOfAllPixelsIsThePicture) {
    scene.environment.reset();
    scene.size = {256, 192}; // shadows show their texels
    addBall();
    scene.objects[0].material.kind = scene::Matt{};
    addFloor();
    views::samplingOf(scene).shadowSize = 256;
    Renderer previewed(*context), once(*context);
    complete(previewed, scene, 1, true);
    complete(previewed, scene, 1);
    const Result<Image> looked = previewed.readDisplay(scene);
    ASSERT_TRUE(looked.ok() && once.finish(scene, 1, scene.size).ok());
    EXPECT_EQ(looked->pixels, once.readDisplay(scene)->pixels);
}

TEST_F(Composed, TrianglesAreMadeAnewOnlyWhereSomethingMoved) {
    addBall();
    Renderer renderer(*context);
    std::uint64_t revision = 0;
    const auto passes = [&] {
        EXPECT_TRUE(renderer.finish(scene, ++revision, scene.size).ok());
        return renderer.stats().passes;
    };
    const int first = passes();
    scene.camera.eye.x = 0.3f;
    EXPECT_EQ(passes(), first - 1);
    scene.objects[0].transform.translate.x = 0.1f;
    EXPECT_EQ(passes(), first);
    scene.objects[0].material.clear().ior = 1.2f;
    EXPECT_EQ(passes(), 2); // what is behind, and the rays
    // What moves by itself is where a fresh renderer shows it.
    scene.objects[0].wave.amplitude = {0, 0.05f, 0};
    for (const float time : {0.1f, 0.3f}) {
        scene.view.time = time;
        passes();
        const Result<Image> kept = renderer.read(scene, scene::Aov::Color);
        ASSERT_TRUE(kept.ok());
        EXPECT_EQ(kept->pixels, picture().pixels) << time;
    }
}

// Passes run portion by portion, when whoever gave the scene may have changed it.
TEST_F(Composed, WhatBecomesOfASceneLaterChangesNoPictureOfIt) {
    addBall();
    scene.size = {640, 480};
    const Image whole = picture();
    Renderer renderer(*context);
    std::deque<scene::Scene> given;
    for (bool complete = false; !complete;) {
        scene::Scene& one = given.emplace_back(scene);
        const Result<Progress> progress = renderer.advance(one, 1, one.size);
        ASSERT_TRUE(progress.ok()) << progress.error().message;
        complete = progress->complete;
        one.objects[0].transform.translate.x += 0.5f;
        ASSERT_LT(given.size(), 10000u);
    }
    EXPECT_GT(given.size(), 1u);
    EXPECT_EQ(renderer.read(scene, scene::Aov::Color)->pixels, whole.pixels);
}

// Two layers, a spare one, and two ranges for each pair of them.
TEST_F(Composed, LayersAreDrawnAnewOnlyWhereTheEyeOrASurfaceMoved) {
    addBall();
    addFloor();
    // Views from elsewhere have layers of their own.
    static_cast<refract::Settings*>(scene.technique.at("refract").data())->surroundings = views::Around::View;
    Renderer renderer(*context);
    std::uint64_t revision = 0;
    const auto passes = [&] {
        EXPECT_TRUE(renderer.finish(scene, ++revision, scene.size).ok());
        return renderer.stats().passes;
    };
    passes();
    scene.environment->rotation.y = 90;
    const int still = passes();
    constexpr int kLayerPasses = 3 + 2 * 2;
    const auto expectSameAsAnew = [&](int expected, const char* what) {
        EXPECT_EQ(passes(), expected) << what;
        const Result<Image> kept = renderer.read(scene, scene::Aov::Color);
        ASSERT_TRUE(kept.ok());
        EXPECT_EQ(kept->pixels, picture().pixels) << what;
    };
    scene.environment->rotation.y = 180;
    expectSameAsAnew(still, "a turned map");
    scene.objects[0].material.clear().ior = 1.3f;
    expectSameAsAnew(still, "other glass");
    scene.camera.eye.y += 0.1f;
    expectSameAsAnew(still + kLayerPasses + 1, "another eye"); // and the surfaces that it sees
    scene.objects[1].transform.translate.y -= 0.1f;
    expectSameAsAnew(still + kLayerPasses + 1, "another floor");
    auto& settings = *static_cast<refract::Settings*>(scene.technique.at("refract").data());
    settings.pathLength = refract::PathLength::Optical;
    const int withoutCaustics = passes();
    EXPECT_LT(withoutCaustics, still) << "their maps stay";
    settings.maxLayers = 1;
    expectSameAsAnew(withoutCaustics + 1 + 2, "fewer layers");
}

TEST_F(Composed, AFloorRunsNoLayers) {
    addFloor();
    EXPECT_EQ(runs("views.surface"), 1);
    EXPECT_EQ(runs("brdf.light"), 1);
    EXPECT_EQ(runs("views.peel"), 0);
    EXPECT_EQ(runs("refract.trace"), 0);
    EXPECT_EQ(runs("relief.light"), 0);
}

TEST_F(Composed, AHeightFieldRunsRelief) {
    addField();
    EXPECT_GE(runs("relief.light"), 1);
    EXPECT_EQ(runs("brdf.light"), 0);
    EXPECT_EQ(runs("views.peel"), 0);
}

TEST_F(Composed, AllTogetherRunOneAfterTheOther) {
    addFloor();
    addField();
    addBall();
    for (const char* pass : {"relief.light", "brdf.light", "refract.trace"})
        EXPECT_GE(runs(pass), 1) << pass;
}

// In an even environment a ball that absorbs nothing cannot be told from what is behind it, but for light
// that is mirrored more than once inside: at the rim of the ball that is up to a fifth.
TEST_F(Composed, AClearBallInAnEvenEnvironmentIsNearlyInvisible) {
    addBall();
    const Image image = picture();
    for (ivec2 pixel : {ivec2(32, 24), ivec2(36, 20), ivec2(2, 2)})
        // The chain leaves out what is mirrored inside: R + T T at 0 to 40 degrees, R about 0.04, is
        // 0.04 + 0.9216 = 0.9616 of 0.5.
        EXPECT_NEAR(image.at(pixel.x, pixel.y)[0], pixel.x == 2 ? 0.5 : 0.4808, 2e-3);
}

TEST_F(Composed, ABallHidesNothingOfTheFieldBesideIt) {
    addField();
    scene.lights.clear(); // whose caustic would fall there
    const Image before = picture();
    addBall();
    // So near the field that the near plane, and with it the rounding of eye rays, stays where it is.
    scene.objects.back().transform = {.translate = {0, 0, -0.8f}, .scale = 0.2f};
    const Image after = picture();
    const Image layers = picture(scene::Aov::Layers);
    int seen = 0;
    for (int y = 0; y < scene.size.y; ++y) {
        for (int x = 0; x < scene.size.x; ++x) {
            if (before.at(x, y)[3] == 0 || layers.at(x, y)[0] > 0) continue;
            ++seen;
            EXPECT_EQ(after.at(x, y)[0], before.at(x, y)[0]);
        }
    }
    EXPECT_GT(seen, 100);
}

TEST_F(Composed, RaysOutOfGlassMeetTheTableRightBelowIt) {
    // A ball on a wide table that glows red, under a blue sky: whatever leaves the ball steeply downwards is
    // red.
    scene.size = {360, 360};
    scene.camera.eye = {0, 1.15f, 3.1f};
    scene.camera.target = {0, 0.42f, 0};
    addBall();
    scene.objects[0].shape = scene::Sphere{.radius = 0.5f};
    scene.objects[0].transform.translate = {0, 0.501f, 0};
    scene::Object table;
    table.name = "table";
    table.shape = scene::Plane{{8, 8}};
    table.material.base = {1, 0, 0};
    table.material.diffuse = vec3(0);
    scene.objects.push_back(table);
    auto sky = std::make_shared<Image>(8, 4, 3);
    for (std::size_t i = 2; i < sky->pixels.size(); i += 3)
        sky->pixels[i] = 1;
    scene.environment->map = sky;
    scene.objects[0].material.clear().fresnel = false;
    const Image color = picture(), direction = picture(scene::Aov::Direction);
    int steep = 0, missed = 0;
    for (int y = 0; y < 360; ++y)
        for (int x = 0; x < 360; ++x)
            if (direction.at(x, y)[3] > 0 && direction.at(x, y)[1] < -0.5f) {
                ++steep;
                missed += color.at(x, y)[0] < 0.9f;
            }
    EXPECT_GT(steep, 4000);
    EXPECT_EQ(missed, 0);
}

TEST_F(Composed, GeometryIsThatOfTheFirstThingGlassToo) {
    addFloor();
    addBall();
    const Image depth = picture(scene::Aov::Depth);
    // Straight ahead the ball's front is |eye| - 1 = sqrt(16.25) - 1 m away; 256 segments stand in for the
    // sphere.
    EXPECT_NEAR(depth.at(32, 24)[0], std::sqrt(16.25) - 1, 5e-3);
    EXPECT_GT(depth.at(32, 40)[0], depth.at(32, 47)[0]); // the floor comes nearer downwards
}

TEST_F(Composed, WhatMovesIsDrawnAgainAtAnotherTime) {
    addBall();
    scene.objects[0].wave = {.amplitude = {0, 0.2f, 0}};
    scene.view.time = 0.1f;
    const Image before = picture(scene::Aov::Direction);
    scene.view.time = 0.3f;
    EXPECT_NE(picture(scene::Aov::Direction).pixels, before.pixels);
}

TEST_F(Composed, ALayerIsShownByItsDepthItsNormalAndAColourForItsObject) {
    addBall();
    const auto center = [&](scene::Aov aov, int layer) {
        scene.view.layer = layer;
        const Image image = picture(aov);
        const float* at = image.at(32, 24);
        return vec4(at[0], at[1], at[2], at[3]);
    };
    // Straight ahead the ball reaches from |eye| - 1 to |eye| + 1; 256 segments stand in for the sphere.
    const float distance = std::sqrt(16.25f);
    EXPECT_NEAR(center(scene::Aov::LayerDepth, 1).x, distance - 1, 5e-3);
    EXPECT_NEAR(center(scene::Aov::LayerDepth, 2).x, distance + 1, 5e-3);
    EXPECT_EQ(center(scene::Aov::LayerDepth, 3), vec4(0)); // there is none
    const vec3 towardsEye = glm::normalize(scene.camera.eye);
    // The middle of the pixel lies 0.5 pixels of 0.06 m beside: 2 degrees on the ball, a little more behind.
    EXPECT_GT(glm::dot(vec3(center(scene::Aov::LayerNormal, 1)), towardsEye), 0.998f);
    EXPECT_LT(glm::dot(vec3(center(scene::Aov::LayerNormal, 2)), towardsEye), -0.998f);
    const vec4 outside = center(scene::Aov::LayerObject, 1), inside = center(scene::Aov::LayerObject, 2);
    EXPECT_EQ(outside.w, 1);
    EXPECT_LT(inside.x + inside.y + inside.z, 0.5f * (outside.x + outside.y + outside.z));
}

// Glass that bends and mirrors nothing lets the light through as it came: 1 of what falls there undisturbed,
// and all of what met it is received.
TEST_F(Composed, ACausticMapOfAnIndexNearOneIsAsBrightAsTheUndisturbedLight) {
    addFloor();
    addBall();
    scene.objects.back().material.clear().ior = 1.0001f; // at 1 no caustic is made
    scene.objects.back().material.clear().fresnel = false;
    scene.size = {48, 48};
    scene.camera.eye = {0, 3, 7}; // all of the floor that the light reaches by way of the ball
    Renderer renderer(*context);
    scene.view.show = scene::Aov::CausticMap;
    ASSERT_TRUE(renderer.finish(scene, 1, scene.size).ok());
    const Result<Image> image = renderer.read(scene, scene.view.show);
    ASSERT_TRUE(image.ok());
    std::vector<float> lit; // the median leaves the ball's outline out
    for (std::size_t i = 0; i < image->pixels.size(); i += 4)
        if (image->pixels[i] > 0) lit.push_back(image->pixels[i]);
    ASSERT_GT(lit.size(), 20u);
    std::nth_element(lit.begin(), lit.begin() + std::ptrdiff_t(lit.size() / 2), lit.end());
    // Found 0.973 on llvmpipe: pixels of the picture are means over whole texels, which the edges of beams
    // cut.
    EXPECT_NEAR(lit[lit.size() / 2], 1, 0.05);
    const auto balance = renderer.balance(scene, "caustics");
    ASSERT_TRUE(balance.ok());
    ASSERT_GE(balance->size(), 2u);
    EXPECT_EQ((*balance)[0].first, "incident");
    EXPECT_EQ((*balance)[1].first, "received");
    const dvec3 met = (*balance)[0].second, received = (*balance)[1].second;
    EXPECT_GT(met.r, 0);
    EXPECT_NEAR(received.r / met.r, 1, 5e-3);
}

// A scene seen and lit straight from above; a height field of the same height everywhere is a floor.
struct FlatField : Composed {
    FlatField() {
        scene.environment.reset();
        scene.size = {64, 64};
        scene.camera = {};
        scene.camera.eye = {0, 20, 0};
        scene.camera.up = {0, 0, -1};
        scene.camera.height = 3;
        scene.lights = {scene::DistantLight{.direction = {0, -1, 0}}};
    }
    scene::Object flatField(float width) const {
        scene::Object field;
        field.name = "field";
        scene::HeightField shape;
        shape.width = width;
        shape.heights = std::make_shared<Image>(48, 48, 1);
        field.shape = shape;
        field.transform.rotate = {-90, 0, 0};
        return field;
    }
};

TEST_F(FlatField, ACausticOnAHeightFieldIsThatOnAFloor) {
    addBall();
    scene.objects[0].visible = false;
    scene.objects[0].transform.translate = {0, 1.2f, 0};
    scene::Object floor;
    floor.name = "floor";
    floor.shape = scene::Plane{{4, 4}};
    scene.objects.push_back(floor);
    const Image onFloor = picture(scene::Aov::Irradiance);
    scene.objects[1] = flatField(4);
    const Image onField = picture(), arriving = picture(scene::Aov::Irradiance);
    const double diffuse = double(scene.objects[1].material.diffuse.g);
    double apart = 0, all = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const double wanted = double(onFloor.at(x, y)[1]);
            apart += std::abs(double(onField.at(x, y)[1]) * std::numbers::pi / diffuse - wanted) / 2;
            EXPECT_NEAR(arriving.at(x, y)[1] / std::numbers::pi * diffuse, onField.at(x, y)[1], 1e-5);
            all += wanted;
        }
    // Of 9 m² what the ball mirrors is missing, 0.27, and what it sends beside the picture.
    EXPECT_GT(all * 9 / (64 * 64), 8.2);
    EXPECT_LT(all * 9 / (64 * 64), 8.8);
    EXPECT_LT(apart / all, 0.005); // the map lies by the box around what receives
}

TEST_F(FlatField, AHeightFieldCastsShadowsOnOtherObjects) {
    scene::Object floor;
    floor.name = "floor";
    floor.shape = scene::Plane{{4, 4}};
    scene.objects.push_back(floor);
    scene.objects.push_back(flatField(1));
    scene.objects[1].transform.translate = {0, 0.5f, 0};
    scene.lights = {scene::DistantLight{.direction = {1, -1, 0}}};
    const Image light = picture(scene::Aov::Irradiance);
    const auto at = [&](float x) { return light.at(int((x / 3 + 0.5f) * 64), 32)[1]; };
    EXPECT_NEAR(at(0.75f), 0, 1e-6); // the field's shadow reaches from 0 to 1
    EXPECT_NEAR(at(1.25f), std::sqrt(0.5), 1e-3);
    EXPECT_NEAR(at(-0.75f), std::sqrt(0.5), 1e-3);
}

// RMSE over the mean of the other.
double errorOf(const Image& image, const Image& exact) {
    double squares = 0, mean = 0;
    for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
        if (i % 4 == 3) continue;
        squares += std::pow(image.pixels[i] - exact.pixels[i], 2);
        mean += exact.pixels[i];
    }
    const double count = 0.75 * double(exact.pixels.size());
    return std::sqrt(squares / count) / (mean / count);
}

TEST_F(Composed, ACausticKeepsTheWantedErrorWithNoMoreRaysThanItNeeds) {
    addFloor();
    addBall();
    scene.size = {96, 72};
    auto& settings = *static_cast<caustics::Settings*>(scene.technique.at("caustics").data());
    settings.grid = 512;
    settings.mapSize = 2048;
    const Image exact = picture();
    settings = {};
    int gridBefore = 0;
    for (const float wanted : {0.4f, 0.1f}) {
        scene.quality.maxError = wanted;
        Renderer renderer(*context);
        ASSERT_TRUE(renderer.finish(scene, 1, scene.size).ok());
        const Stats stats = renderer.stats();
        const int grid = stats.technique.at("caustics").as<caustics::Settings>().grid;
        EXPECT_GT(grid, gridBefore) << stats.settings;
        gridBefore = grid;
        const Result<Image> image = renderer.read(scene, scene::Aov::Color);
        ASSERT_TRUE(image.ok());
        EXPECT_LE(errorOf(*image, exact), wanted) << stats.settings;
        EXPECT_LE(stats.predicted, wanted) << stats.settings;
    }
    // Twice as many rays as 128 change it little here, and twice as many again more: no step foretells the
    // next.
    scene.quality.maxError = 0.001f;
    Renderer renderer(*context);
    ASSERT_TRUE(renderer.finish(scene, 1, scene.size).ok());
    const Result<Image> image = renderer.read(scene, scene::Aov::Color);
    ASSERT_TRUE(image.ok());
    EXPECT_GT(renderer.stats().predicted, errorOf(*image, exact)) << renderer.stats().settings;
}

TEST_F(Composed, CausticMapsOfTheEnvironmentStayWhileOnlyOtherSettingsChange) {
    addFloor();
    addBall();
    static_cast<caustics::Settings*>(scene.technique.at("caustics").data())->directions = 32;
    views::samplingOf(scene).directions = 8;
    Renderer renderer(*context);
    ASSERT_TRUE(renderer.finish(scene, 1, scene.size).ok());
    const int draws = renderer.stats().draws;
    views::samplingOf(scene).directions = 9;
    ASSERT_TRUE(renderer.finish(scene, 2, scene.size).ok());
    EXPECT_LT(renderer.stats().draws, draws / 2);
    const Image kept = *renderer.read(scene, scene::Aov::Color);
    EXPECT_EQ(kept.pixels, picture().pixels);
}

TEST_F(Composed, PreviewsWithFewPixelsAreTheCoarsest) {
    addFloor();
    addBall();
    for (const auto [downscale, grid, layers] : {std::array{4, 64, 4}, std::array{8, 32, 2}}) {
        Renderer renderer(*context);
        for (bool complete = false; !complete;) {
            const auto progress = renderer.advance(scene, 1, {640, 480}, true, downscale);
            ASSERT_TRUE(progress.ok());
            complete = progress->complete;
        }
        const auto used = renderer.stats().technique;
        EXPECT_EQ(used.at("caustics").as<caustics::Settings>().grid, grid);
        EXPECT_EQ(used.at("caustics").as<caustics::Settings>().mapSize, 4 * grid);
        EXPECT_EQ(used.at("refract").as<refract::Settings>().maxLayers, layers);
    }
}

TEST_F(Composed, APictureTakesTheCausticMapsWithWhichItsSettingsWereChosen) {
    addFloor();
    addBall();
    static_cast<caustics::Settings*>(scene.technique.at("caustics").data())->directions = 32;
    views::samplingOf(scene).directions = 300;
    views::samplingOf(scene).pixelSamples = 1;
    Renderer chooses(*context);
    chooses.setDefaultError(0.1f);
    const auto draws = [&] { return context->device().drawCount(); };
    int planned = draws();
    for (bool complete = false; !complete;) {
        const auto progress = chooses.advance(scene, 1, scene.size);
        ASSERT_TRUE(progress.ok());
        if (progress->task == Task::Settings) planned = draws();
        complete = progress->complete;
    }
    const int after = draws() - planned;
    const Image taken = *chooses.read(scene, scene::Aov::Color);
    scene.technique = chooses.stats().technique;
    ASSERT_LT(views::samplingOf(scene).directions, 200);
    Renderer fresh(*context);
    ASSERT_TRUE(fresh.finish(scene, 1, scene.size).ok());
    EXPECT_LT(after, fresh.stats().draws / 2);
    EXPECT_EQ(taken.pixels, fresh.read(scene, scene::Aov::Color)->pixels);
}

TEST_F(Composed, AnErrorChoosesNoMoreLayersThanChangeThePicture) {
    addBall();
    scene.quality.maxError = 0.01f;
    Renderer renderer(*context);
    ASSERT_TRUE(renderer.finish(scene, 1, scene.size).ok());
    // A ball has two surfaces behind each other.
    EXPECT_EQ(renderer.stats().technique.at("refract").as<refract::Settings>().maxLayers, 2);
    EXPECT_NE(renderer.stats().settings.find("2 layers"), std::string::npos);
}

TEST_F(Composed, ALampThatIsNotThereThrowsNothing) {
    addFloor();
    addBall();
    scene.view.layer = 2;
    const Image image = picture(scene::Aov::CausticMap);
    EXPECT_TRUE(
        std::all_of(image.pixels.begin(), image.pixels.end(), [](float value) { return value == 0; }));
}

} // namespace
} // namespace lucent::frame
