// Samples of a pixel: a picture is the mean over each pixel, and grows sample by sample.
#include "frame/Renderer.h"
#include "light/Samples.h"
#include "technique/Technique.h"
#include "tests/support/Fields.h"
#include "tests/support/Gl.h"
#include "truth/Glass.h"
#include "truth/Picture.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace lucent::frame {
namespace {

struct Pixels : support::GlTest {
    scene::Scene scene;

    // A glowing box whose right side lies `edge` pixels from the left of a picture 8 pixels wide.
    void addGlow(float edge) {
        scene.size = {8, 4};
        scene.camera.type = scene::Camera::Type::Orthographic;
        scene.camera.eye = {0, 0, 2};
        scene.camera.height = 4; // a metre a pixel
        technique::addSettings(scene);
        scene::Object box;
        box.name = "box";
        box.shape = scene::Box{{8, 8, 1}};
        box.transform.translate = {edge - 8, 0, 0};
        box.material.base = {1, 0.5f, 0.25f};
        box.material.diffuse = vec3(0);
        scene.objects.push_back(box);
    }
    void setSamples(int count) { views::samplingOf(scene).pixelSamples = count; }
    Image picture(scene::Aov aov = scene::Aov::Color) {
        Renderer renderer(*context);
        scene.view.show = aov;
        EXPECT_TRUE(renderer.finish(scene, 1, scene.size).ok());
        Result<Image> image = renderer.read(scene, aov);
        EXPECT_TRUE(image.ok());
        return std::move(*image);
    }
    Image exact() {
        const auto size = truth::PixelMean::sizeOf(scene.size);
        auto places = truth::GlassEstimator::create(scene, size, scene::Aov::Color, {.samples = 1});
        EXPECT_TRUE(places.ok());
        const truth::PixelMean mean(std::make_unique<truth::GlassEstimator>(std::move(*places)), 1);
        return truth::render(mean, scene.size, {}, {}, false)->values;
    }
};

TEST(PixelOffset, HasItsMeanInTheMiddleAndIsEvenInRowsAndColumns) {
    for (int count = 1; count <= 64; ++count) {
        if (count % 2) {
            EXPECT_EQ(views::pixelOffset(0, count), vec2(0));
        }
        std::vector<float> across, up;
        vec2 sum(0);
        for (int i = 0; i < count; ++i) {
            const vec2 offset = views::pixelOffset(i, count);
            sum += offset;
            if (i % 2 == (count + 1) % 2) {
                EXPECT_LT(glm::length(sum), 1e-4f) << i << " of " << count;
            }
            across.push_back(offset.x);
            up.push_back(offset.y);
        }
        for (auto* one : {&across, &up}) {
            std::sort(one->begin(), one->end());
            EXPECT_GE(one->front(), -0.5f);
            EXPECT_LT(one->back(), 0.5f);
            for (int i = 1; i < count; ++i)
                EXPECT_NEAR((*one)[std::size_t(i)] - (*one)[std::size_t(i - 1)], 1.0 / count, 1e-5) << count;
        }
    }
}

TEST_F(Pixels, AnEdgeCoversItsPixelByTheAreaThatItHasThere) {
    addGlow(0);
    for (const int count : {4, 5, 16})
        for (const float edge : {3.2f, 3.5f, 3.8f}) {
            setSamples(count);
            scene.objects[0].transform.translate.x = edge - 8;
            const Image image = picture(), filtered = exact();
            for (int y = 0; y < 4; ++y) {
                EXPECT_EQ(image.at(2, y)[3], 1);
                EXPECT_EQ(image.at(4, y)[3], 0);
                EXPECT_NEAR(image.at(3, y)[3], edge - 3, 1.001 / count) << count << " samples";
                EXPECT_NEAR(filtered.at(3, y)[3], edge - 3, 0.5 / truth::PixelMean::kPlaces + 1e-6);
                for (int c = 0; c < 3; ++c) // light is that of what is covered
                    EXPECT_NEAR(image.at(3, y)[c], scene.objects[0].material.base[c], 1e-5);
            }
        }
}

TEST_F(Pixels, AnEdgeBeforeSomethingMixesTheColoursOfBoth) {
    addGlow(3.4f);
    scene::Object wall = scene.objects[0];
    wall.name = "wall";
    wall.transform.translate = {0, 0, -2};
    wall.material.base = {0, 0, 1};
    scene.objects.push_back(wall);
    setSamples(10);
    const Image image = picture(), filtered = exact();
    for (int y = 0; y < 4; ++y) {
        EXPECT_NEAR(image.at(3, y)[0], 0.4, 0.1001);
        EXPECT_NEAR(filtered.at(3, y)[0], 0.4, 0.5 / truth::PixelMean::kPlaces + 1e-6);
        EXPECT_EQ(image.at(3, y)[3], 1);
    }
}

TEST_F(Pixels, AnEvenAreaStaysAsItIs) {
    addGlow(8);
    const Image one = picture();
    setSamples(9);
    const Image several = picture();
    for (std::size_t i = 0; i < one.pixels.size(); ++i)
        EXPECT_NEAR(several.pixels[i], one.pixels[i], 1e-5);
}

// Normals, depths and counts of different things have no mean.
// A hidden box shades a plane under a sky that is bright on one side, and under a large lamp.
TEST_F(Pixels, EachSampleIsLitByOthersOfTheLight) {
    scene.size = {24, 24};
    scene.camera.eye = {0, 2, 0};
    scene.camera.up = {0, 0, -1};
    scene.camera.height = 2;
    technique::addSettings(scene);
    const auto add = [&](const char* name, scene::Shape shape, vec3 place) -> scene::Object& {
        scene::Object& object = scene.objects.emplace_back();
        object.name = name;
        object.shape = std::move(shape);
        object.material.kind = scene::Matt{};
        object.transform.translate = place;
        return object;
    };
    add("plane", scene::Plane{{4, 4}}, vec3(0));
    add("box", scene::Box{{0.7f, 0.1f, 0.7f}}, {0, 0.5f, 0}).visible = false;
    auto sky = std::make_shared<Image>(32, 16, 3);
    for (int i = 0; i < 32 * 16; ++i)
        for (int c = 0; c < 3; ++c)
            sky->pixels[std::size_t(3 * i + c)] = i % 32 < 14 ? 1.5f : 0.3f;
    const auto errorOf = [&](int count, const Image& reference) {
        setSamples(count);
        views::Sampling& sampling = views::samplingOf(scene);
        sampling.lamp = 32;
        sampling.directions = 32 * count; // which they share
        const Image found = picture();
        double square = 0;
        for (std::size_t i = 0; i < found.pixels.size(); i += 4)
            square += std::pow(double(found.pixels[i] - reference.pixels[i]), 2);
        return std::sqrt(square);
    };
    for (const bool isSky : {true, false}) {
        views::Sampling& sampling = views::samplingOf(scene);
        if (isSky)
            scene.environment.emplace().map = sky;
        else
            scene.lights = {scene::AreaLight{
                .corner = {-0.4f, 1.6f, 0.4f}, .edgeU = {0, 0, -0.8f}, .edgeV = {0.8f, 0, 0}, .radiance = 8}};
        sampling.directions = sampling.lamp = 2048;
        setSamples(1);
        const Image reference = picture();
        // Of five independent sets 0.45.
        EXPECT_LT(errorOf(5, reference), 0.6 * errorOf(1, reference)) << isSky;
        scene.environment.reset();
    }
}

TEST_F(Pixels, OtherQuantitiesAreThoseOfTheMiddles) {
    addGlow(3.6f);
    for (const scene::Aov aov : {scene::Aov::Normal, scene::Aov::Depth, scene::Aov::Position}) {
        setSamples(1);
        const Image one = picture(aov);
        setSamples(5);
        EXPECT_EQ(picture(aov).pixels, one.pixels);
    }
}

TEST_F(Pixels, SamplesArriveOneAfterTheOtherAndEndWhereOnePictureEnds) {
    addGlow(3.3f);
    scene.lights.push_back(scene::PointLight{.position = {1, 2, 3}});
    scene.objects[0].material.diffuse = vec3(0.5f);
    setSamples(1);
    const Image middles = picture();
    setSamples(5);
    const Image atOnce = picture();
    Renderer renderer(*context);
    std::uint64_t revision = 0;
    for (const bool looked : {false, true}) { // a drag ends with a look
        ++revision;
        if (looked)
            while (!renderer.advance(scene, revision, scene.size, true)->complete) {
            }
        int last = looked ? 1 : 0, slices = 0; // nothing was to be coarsened
        for (;; ++slices) {
            const Result<Progress> progress = renderer.advance(scene, revision, scene.size);
            ASSERT_TRUE(progress.ok()) << progress.error().message;
            ASSERT_LE(progress->samples, last + 1);
            last = progress->samples;
            if (progress->complete) break;
            ASSERT_LT(slices, 100);
        }
        EXPECT_EQ(last, 5);
        EXPECT_EQ(renderer.read(scene, scene::Aov::Color)->pixels, atOnce.pixels);
    }
    EXPECT_NE(atOnce.pixels, middles.pixels);
    // A change begins with the middles again.
    scene.objects[0].material.base.x = 0.9f;
    EXPECT_LE(renderer.advance(scene, ++revision, scene.size)->samples, 1);
}

// Refraction asks what lies behind its layers: each sample waits for the answer.
TEST_F(Pixels, GlassIsTheMeanOfWhatItsShiftedViewsShow) {
    addGlow(8);
    scene.objects[0].material.base = vec3(0);
    scene.size = {32, 32};
    scene::Object ball;
    ball.name = "ball";
    ball.shape = scene::Sphere{};
    ball.transform.translate = {0, 0, 1.7f};
    ball.material.kind = scene::Clear{.ior = 1.0001f, .fresnel = false}; // next to nothing is bent
    scene.objects.push_back(ball);
    scene.objects[0].transform.translate = {-4, 0, -1}; // half of what is behind
    scene.objects[0].material.base = vec3(1);
    setSamples(8);
    const Image image = picture();
    scene.objects.pop_back();
    const Image without = picture();
    for (std::size_t i = 0; i < image.pixels.size(); i += 4)
        if (without.pixels[i + 3] == 1) {
            EXPECT_NEAR(image.pixels[i], without.pixels[i], 2e-3) << i / 4;
        }
}

} // namespace
} // namespace lucent::frame
