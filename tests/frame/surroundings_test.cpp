// What mirrors and glass show of what the camera does not see.
#include "frame/Renderer.h"
#include "light/Samples.h"
#include "technique/Technique.h"
#include "techniques/brdf/Brdf.h"
#include "techniques/refract/Refract.h"
#include "tests/support/Gl.h"
#include "truth/Glass.h"

#include <cmath>

namespace lucent::frame {
namespace {

using views::Around;

struct Surroundings : support::GlTest {
    scene::Scene scene;

    Surroundings() {
        scene.size = {64, 64};
        technique::addSettings(scene);
        views::samplingOf(scene).directions = 16; // what is lit by the sky is another test's
    }
    void show(Around around) {
        static_cast<brdf::Settings*>(scene.technique.at("brdf").data())->surroundings = around;
        static_cast<refract::Settings*>(scene.technique.at("refract").data())->surroundings = around;
    }
    scene::Object& add(scene::Shape shape, vec3 place, vec3 rotate = vec3(0)) {
        scene::Object object;
        object.name = "object " + std::to_string(scene.objects.size());
        object.shape = std::move(shape);
        object.transform.translate = place;
        object.transform.rotate = rotate;
        scene.objects.push_back(std::move(object));
        return scene.objects.back();
    }
    // Shines by itself and reflects nothing: its radiance is known wherever it is seen.
    void addGlowing(scene::Shape shape, vec3 place, vec3 radiance) {
        scene::Material& material = add(std::move(shape), place).material;
        material.base = radiance;
        material.diffuse = vec3(0);
    }
    void addMirror(scene::Shape shape, vec3 place, vec3 rotate = vec3(0), vec3 reflectance = vec3(0.9f)) {
        add(std::move(shape), place, rotate).material.kind = scene::Mirror{reflectance};
    }
    void addSky(vec3 radiance) {
        auto map = std::make_shared<Image>(8, 4, 3);
        for (std::size_t i = 0; i < map->pixels.size(); ++i)
            map->pixels[i] = radiance[int(i % 3)];
        scene.environment.emplace().map = std::move(map);
    }
    Image picture() {
        context->device().checkTargets(true); // NaN and infinity are errors
        Renderer renderer(*context);
        const Status finished = renderer.finish(scene, 1, scene.size);
        EXPECT_TRUE(finished.ok()) << (finished ? "" : finished.error().message);
        Result<Image> image = renderer.read(scene, scene::Aov::Color);
        EXPECT_TRUE(image.ok());
        return std::move(*image);
    }
    Image truth(int samples = 1) {
        const auto exact =
            truth::GlassEstimator::create(scene, scene.size, scene::Aov::Color, {.samples = samples});
        EXPECT_TRUE(exact.ok());
        return truth::render(*exact, scene.size, {}, {}, false)->values;
    }
    std::string explained() {
        Renderer renderer(*context);
        const Result<std::string> text = renderer.explain(scene, scene.size);
        EXPECT_TRUE(text.ok());
        return *text;
    }
};

struct Difference {
    double relative = 0; ///< RMSE over the mean of the other
    double worse = 0;    ///< share of pixels that differ by more than a tenth of the mean
};
Difference differenceOf(const Image& image, const Image& other) {
    double squares = 0, mean = 0, worse = 0;
    const std::size_t count = image.pixels.size() / 4;
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 4 * i; c < 4 * i + 3; ++c)
            mean += double(other.pixels[c]) / double(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        double most = 0;
        for (std::size_t c = 4 * i; c < 4 * i + 3; ++c) {
            const double d = double(image.pixels[c]) - double(other.pixels[c]);
            squares += d * d;
            most = std::max(most, std::abs(d));
        }
        worse += most > 0.1 * mean ? 1.0 / double(count) : 0;
    }
    return {std::sqrt(squares / double(3 * count)) / mean, worse};
}

TEST_F(Surroundings, AFlatMirrorAt45DegreesShowsABoxWhereGeometrySays) {
    // The eye looks along -z, the mirror turns that to +y: the pixel at (x, y) sees up from (x, y, -y). A box
    // above, beside the picture, from x = 0.1 to 0.5 and z = -0.1 to 0.3, shows from y = -0.3 to 0.1.
    scene.camera = {.eye = {0, 0, 5}, .height = 2};
    addMirror(scene::Plane{{4, 4}}, vec3(0), {45, 0, 0}, {0.9f, 0.6f, 0.3f});
    addGlowing(scene::Box{{0.4f, 0.5f, 0.4f}}, {0.3f, 2, 0.1f}, {1, 0.5f, 0.25f});
    const auto check = [&](const Image& image) {
        int inside = 0;
        for (int row = 0; row < scene.size.y; ++row)
            for (int column = 0; column < scene.size.x; ++column) {
                const float x = (float(column) + 0.5f) / 32 - 1, y = 1 - (float(row) + 0.5f) / 32;
                const float within = std::min(0.2f - std::abs(x - 0.3f), 0.2f - std::abs(y + 0.1f));
                if (std::abs(within) < 1e-3f) continue; // a pixel's middle on the border
                inside += within > 0;
                const vec3 expected = within > 0 ? vec3(0.9f, 0.3f, 0.075f) : vec3(0);
                for (int channel = 0; channel < 3; ++channel) // half floats
                    ASSERT_NEAR(image.at(column, row)[channel], expected[channel], 1e-3) << x << " " << y;
            }
        EXPECT_NEAR(inside, 0.16 * 32 * 32, 13); // a row of its border
    };
    check(picture());
    scene.objects[0].shape = scene::Box{{4, 0.01f, 4}}; // a side of it
    scene.objects[0].transform.translate = -0.005f * vec3(0, std::sqrt(0.5f), std::sqrt(0.5f));
    check(picture());
    // The mean over pixels: 4 / 5 of column 35 show the box, and all of 47, which it ends beside.
    views::samplingOf(scene).pixelSamples = 16;
    const Image mean = picture();
    EXPECT_NEAR(mean.at(35, 35)[0], 0.9 * 0.8, 0.09); // some of 16 samples lie beside the border
    EXPECT_NEAR(mean.at(47, 35)[0], 0.9, 1e-3);
    EXPECT_NEAR(mean.at(34, 35)[0], 0, 1e-3);
    views::samplingOf(scene).pixelSamples = 1;
    show(Around::Environment);
    EXPECT_EQ(picture().at(41, 35)[0], 0);
}

TEST_F(Surroundings, AMirrorBallShowsALitFloorAsTheExactSolutionDoes) {
    scene.camera = {.type = scene::Camera::Type::Perspective, .eye = {0, 0.6f, 3}, .fov = 40};
    scene.size = {96, 96};
    addMirror(scene::Sphere{0.8f}, {0, 0, 0});
    scene::Material& floor = add(scene::Plane{{6, 6}}, {0, -1, 0}).material;
    floor.diffuse = {0.8f, 0.5f, 0.3f};
    floor.base = {0.1f, 0.2f, 0.3f};
    addGlowing(scene::Box{vec3(0.5f)}, {1.2f, -0.75f, 0.9f}, {1, 0.1f, 0.1f});
    addGlowing(scene::Box{vec3(0.6f)}, {-1.5f, 0.2f, 1.8f}, {0.1f, 0.9f, 0.2f});
    // A lamp whose light does not reach the ball: it would throw some on.
    scene.lights = {scene::SpotLight{.position = {-1.6f, 1.5f, 0.4f},
                                     .direction = {-0.1f, -1, 0.1f},
                                     .intensity = 8,
                                     .innerAngle = 10,
                                     .outerAngle = 14}};
    const Image exact = truth(), image = picture();
    // What is left are outlines of the boxes: 20 pixels, where one of the cube is 1 degree wide. Measured:
    // 0.2 %, RMSE 0.23 of a mean that is dark; with the environment alone 15 % and 1.15.
    const Difference found = differenceOf(image, exact);
    EXPECT_LT(found.worse, 0.005);
    EXPECT_LT(found.relative, 0.3);
    show(Around::Environment);
    const Difference before = differenceOf(picture(), exact);
    EXPECT_GT(before.worse, 20 * found.worse);
    show(Around::View); // of the boxes and the floor beside the ball, what the camera sees
    const Difference seen = differenceOf(picture(), exact);
    EXPECT_LT(seen.worse, before.worse);
    EXPECT_GT(seen.worse, found.worse);
}

TEST_F(Surroundings, MirrorsThatFaceEachOtherShowEachOtherOnce) {
    // Two walls of mirror, seen from between: what the second bounce shows is exact, further ones show the
    // black around, so nothing grows.
    scene.camera = {
        .type = scene::Camera::Type::Perspective, .eye = {0.8f, 0.3f, 0}, .target = {-1, 0, 0}, .fov = 50};
    addMirror(scene::Plane{{4, 4}}, {-1, 0, 0}, {0, 0, -90}, vec3(0.9f));
    addMirror(scene::Plane{{4, 4}}, {1, 0, 0}, {0, 0, 90}, vec3(0.8f));
    addGlowing(scene::Sphere{0.2f}, {-0.2f, -0.5f, 0.1f}, vec3(1));
    const Image image = picture(), exact = truth();
    int once = 0, twice = 0, wrong = 0;
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        ASSERT_TRUE(std::isfinite(image.pixels[i]));
        ASSERT_LE(image.pixels[i], 1.001f);
        const float found = image.pixels[i], expected = exact.pixels[i];
        once += std::abs(found - 0.9f) < 2e-3f;
        twice += std::abs(found - 0.72f) < 2e-3f;
        if (expected > 0.7f && std::abs(found - expected) > 2e-3f) ++wrong;
    }
    EXPECT_GT(once, 20);
    EXPECT_GT(twice, 10);
    EXPECT_LT(wrong, 40); // the outlines of the second image, a pixel wide
    const std::string text = explained();
    EXPECT_NE(text.find("mirrors by way of two mirrors: the third one shows the environment"),
              std::string::npos);
}

TEST_F(Surroundings, RaysThatLeaveGlassForWhatTheCameraDoesNotSeeMeetIt) {
    // A ball fills the picture; the floor below and the wall behind the eye are beside it.
    scene.camera = {.type = scene::Camera::Type::Perspective, .eye = {0, 0, 3}, .fov = 36};
    addSky({0.1f, 0.1f, 0.2f});
    add(scene::Sphere{1}, {0, 0, 0}).material.kind = scene::Clear{};
    addGlowing(scene::Plane{{8, 8}}, {0, -1.3f, 0}, {0.9f, 0.5f, 0.2f});
    addGlowing(scene::Box{{8, 8, 0.1f}}, {0, 0, 5}, {0.1f, 0.6f, 0.1f});
    const Image exact = truth(), image = picture();
    const Difference found = differenceOf(image, exact);
    // The outlines of the ball, and of the floor in it. Measured: 1.7 %.
    EXPECT_LT(found.worse, 0.03);
    show(Around::View);
    EXPECT_GT(differenceOf(picture(), exact).worse, 0.1);
}

// What plays has no other picture: the first preview is a quick one, the second looks around, and once.
TEST_F(Surroundings, PreviewsLookAroundThemselvesWhereNoPictureHas) {
    scene.camera = {.type = scene::Camera::Type::Perspective, .eye = {0, 0, 3}, .fov = 36};
    addSky({0.1f, 0.1f, 0.2f});
    add(scene::Sphere{1}, {0, 0, 0}).material.kind = scene::Clear{};
    addGlowing(scene::Plane{{8, 8}}, {0, -1.3f, 0}, {0.9f, 0.5f, 0.2f});
    addGlowing(scene::Box{{8, 8, 0.1f}}, {0, 0, 5}, {0.1f, 0.6f, 0.1f});
    const Image exact = truth();
    Renderer renderer(*context);
    std::uint64_t revision = 0;
    const auto preview = [&] { // with the pixels of the exact picture, and passes it took
        ++revision;
        for (;;) {
            const Result<Progress> progress = renderer.advance(scene, revision, 2 * scene.size, true, 2);
            EXPECT_TRUE(progress.ok());
            if (!progress || progress->complete) break;
        }
        const Result<Image> shown = renderer.read(scene, scene::Aov::Color);
        EXPECT_TRUE(shown.ok());
        return std::pair(differenceOf(*shown, exact).worse, renderer.stats().passes);
    };
    const auto first = preview(), second = preview(), third = preview();
    EXPECT_GT(first.first, 0.1);
    EXPECT_LT(second.first, 0.05);
    EXPECT_EQ(third.first, second.first);
    EXPECT_LT(third.second, second.second - 5);
}

TEST_F(Surroundings, WhatAnObjectHidesFromTheMiddleIsSeenFromTheRim) {
    // From the middle of the mirror the ball hides all of the box; beside the middle of its image, none of
    // it.
    scene.camera = {
        .type = scene::Camera::Type::Perspective, .eye = {0, 0, 6}, .target = {0.6f, 0, 0}, .fov = 5};
    scene.size = {96, 96};
    addMirror(scene::Sphere{1}, {0, 0, 0});
    addGlowing(scene::Sphere{0.3f}, {1.7f, 0, 0.6f}, {0.9f, 0.1f, 0.1f});
    addGlowing(scene::Box{vec3(0.6f)}, {5, 0, 1.8f}, {0.1f, 0.9f, 0.1f});
    const Image exact = truth(), image = picture();
    const auto green = [](const Image& of) {
        int count = 0;
        for (std::size_t i = 0; i < of.pixels.size(); i += 4)
            count += of.pixels[i + 1] > 0.5f;
        return count;
    };
    ASSERT_GT(green(exact), 50);
    // A texel of the cube is 5 pixels wide here, and what it shows may end half of one early. Measured: 138
    // of 172, where without what the ball hides there is nothing; all outlines are 1.9 %.
    EXPECT_NEAR(green(image), green(exact), 0.25 * green(exact));
    EXPECT_LT(differenceOf(image, exact).worse, 0.025);
    const std::string text = explained();
    EXPECT_NE(text.find("1 of them also without what hides other objects"), std::string::npos) << text;
}

// Stripes on a table before the foot of a mirroring cylinder, which its middle sees under 5 to 7 degrees: a
// texel of its cube is wider than a stripe there.
TEST_F(Surroundings, WhatTheCameraSeesIsAsSharpInACurvedMirror) {
    scene.camera = {
        .type = scene::Camera::Type::Perspective, .eye = {0, 1.2f, 2}, .target = {0, 0, 0.4f}, .fov = 30};
    scene.size = {160, 160};
    addMirror(scene::Cylinder{.radius = 0.4f, .height = 0.1f}, {0, 0.051f, 0});
    addGlowing(scene::Plane{{4, 4}}, vec3(0), vec3(0.1f));
    for (int i = 0; i < 4; ++i)
        addGlowing(scene::Plane{{1.2f, 0.03f}}, {0, 0.001f, 0.42f + 0.06f * float(i)}, vec3(0.9f));
    const Image exact = truth(64);
    EXPECT_LT(differenceOf(picture(), exact).relative, 0.3); // measured 0.225; by the cube alone 0.465
}

// Stripes behind a turned slab: what lies between the camera's pixels is seen there.
TEST_F(Surroundings, WhatTheCameraSeesIsMovedByLessThanAPixelThroughGlass) {
    scene.size = {96, 96};
    scene.camera = {.type = scene::Camera::Type::Perspective, .eye = {0, 0, 4}, .fov = 20};
    scene::Material& glass = add(scene::Box{{4, 4, 0.5f}}, vec3(0), {0, 35, 0}).material; // fills the picture
    glass.kind = scene::Clear{.ior = 1.5f, .fresnel = false};
    addGlowing(scene::Box{{6, 6, 0.1f}}, {0, 0, -1.1f}, vec3(0.1f));
    for (int i = -6; i <= 6; ++i)
        addGlowing(scene::Box{{0.1f, 3, 0.02f}}, {0.2f * float(i), 0, -1.05f}, vec3(0.9f));
    // The middle: rays that leave it end within the picture.
    const auto middleOf = [&](const Image& image) {
        Image middle(32, 32, 4);
        for (int row = 0; row < 32; ++row)
            std::copy_n(image.at(32, 32 + row), 4 * 32, middle.at(0, row));
        return middle;
    };
    // Measured 0.193; by the pixel that a ray ends in 0.274.
    EXPECT_LT(differenceOf(middleOf(picture()), middleOf(truth(64))).relative, 0.23);
}

TEST_F(Surroundings, EverythingWhiteInMirrorsIsWhite) {
    addSky(vec3(1));
    scene.camera = {.type = scene::Camera::Type::Perspective, .eye = {0, 1, 4}};
    addMirror(scene::Sphere{0.6f}, {-0.7f, 0, 0}, vec3(0), vec3(1));
    addMirror(scene::Box{{0.8f, 1, 0.4f}}, {0.8f, 0, 0}, {0, -30, 0}, vec3(1));
    addGlowing(scene::Torus{0.3f, 0.1f}, {0.1f, 0.2f, 1.2f}, vec3(1));
    addGlowing(scene::Plane{{5, 5}}, {0, -0.7f, 0}, vec3(1));
    const Image image = picture();
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        ASSERT_NEAR(image.pixels[i], 1, 5e-3) << i;
}

TEST_F(Surroundings, AreDrawnOnceAScene) {
    scene.camera = {.type = scene::Camera::Type::Perspective, .eye = {0, 1, 4}};
    addMirror(scene::Sphere{0.6f}, {0, 0, 0});
    addGlowing(scene::Plane{{5, 5}}, {0, -0.7f, 0}, vec3(1));
    const auto passesOf = [&](Renderer& renderer, std::uint64_t revision) {
        EXPECT_TRUE(renderer.finish(scene, revision, scene.size).ok());
        return renderer.stats().passes;
    };
    Renderer renderer(*context);
    const int first = passesOf(renderer, 1);
    scene.camera.eye.x = 1;
    const int moved = passesOf(renderer, 2);
    EXPECT_GT(first, moved);
    scene.objects[1].material.base = vec3(0.5f);
    EXPECT_GT(passesOf(renderer, 3), moved + 5); // faces again
    scene.camera.eye.x = 2;
    EXPECT_EQ(passesOf(renderer, 4), moved);
    show(Around::Environment);
    scene.camera.eye.x = 3;
    EXPECT_EQ(passesOf(renderer, 5), moved - 2); // neither the camera's own picture nor its depths
}

TEST_F(Surroundings, AreNotDrawnWhereNoRayLooksForThem) {
    scene.camera = {.type = scene::Camera::Type::Perspective, .eye = {0, 1, 4}};
    add(scene::Box{}, {0, 0, 0});
    addGlowing(scene::Plane{{5, 5}}, {0, -0.7f, 0}, vec3(1));
    scene.lights = {scene::PointLight{.position = {1, 2, 1}}};
    const char* none = "reflection probes\n  no ray leaves what the camera shows";
    EXPECT_NE(explained().find(none), std::string::npos);
    addMirror(scene::Sphere{0.3f}, {1, 0, 0});
    EXPECT_NE(explained().find("from \"object 2\": "), std::string::npos);
    scene.objects[0].visible = scene.objects[1].visible = false; // there is only the mirror to be seen
    EXPECT_NE(explained().find(none), std::string::npos);
    scene.objects[2].material.kind = scene::Clear{};
    EXPECT_NE(explained().find(none), std::string::npos);
    scene.objects[1].visible = true;
    EXPECT_NE(explained().find("from \"object 2\": "), std::string::npos);
}

} // namespace
} // namespace lucent::frame
