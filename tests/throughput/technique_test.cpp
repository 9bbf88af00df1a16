// Whole scenes with precomputed objects: their passes, their light against closed forms and the exact dipole.
#include "diffusion/Profile.h"
#include "frame/Renderer.h"
#include "light/Samples.h"
#include "scene/Mesh.h"
#include "scene/Painting.h"
#include "technique/Technique.h"
#include "techniques/throughput/BakeFile.h"
#include "techniques/throughput/Throughput.h"
#include "tests/support/Gl.h"
#include "tests/throughput/Shapes.h"
#include "truth/Dipole.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lucent::throughput {
namespace {

scene::MeshShape shapeOf(scene::Mesh mesh) {
    scene::MeshShape shape;
    shape.mesh = std::make_shared<const scene::Mesh>(std::move(mesh));
    return shape;
}

struct Precomputed : support::GlTest {
    scene::Scene scene;

    Precomputed() {
        scene.size = {48, 48};
        scene.camera.eye = {0, 0, 1};
        scene.camera.height = 0.022f;
        technique::addSettings(scene);
        scene.lights = {scene::DistantLight{.direction = {-1, 0, 0}}};
        scene::Object ball;
        ball.name = "ball";
        ball.shape = shapeOf(scene::meshOf(scene::Sphere{0.01f}, 48));
        scene::Translucent inside;
        inside.scattering = {2190, 2620, 3000};
        inside.absorption = vec3(200);
        inside.precomputed = true;
        ball.material.kind = inside;
        scene.objects.push_back(ball);
        settings().side = 192;
    }
    Settings& settings() { return *static_cast<Settings*>(scene.technique.at("throughput").data()); }
    void makePatch() {
        scene.objects[0].shape = shapeOf(shapes::patch(0.02f, 40));
        scene.lights = {scene::DistantLight{.direction = {0, 0, -1}}};
        scene.camera.height = 0.004f;
    }
    Result<Image> draw(scene::Aov aov = scene::Aov::Radiosity) {
        frame::Renderer renderer(*context);
        scene.view.show = aov;
        if (Status done = renderer.finish(scene, 1, scene.size); !done) return done.error();
        return renderer.read(scene, aov);
    }
    Image picture(scene::Aov aov = scene::Aov::Radiosity) {
        Result<Image> image = draw(aov);
        EXPECT_TRUE(image.ok()) << image.error().message;
        return std::move(*image);
    }
    std::string explained() {
        frame::Renderer renderer(*context);
        const Result<std::string> text = renderer.explain(scene, scene.size);
        EXPECT_TRUE(text.ok()) << text.error().message;
        return *text;
    }
    bool runs(const std::string& pass) { return explained().find("\n  " + pass + ":") != std::string::npos; }
};

TEST_F(Precomputed, ABallRunsItsOwnPassesAndNoSplats) {
    for (const char* pass : {"throughput.place", "throughput.enter", "throughput.product",
                             "throughput.spread", "throughput.seen", "throughput.shade"})
        EXPECT_TRUE(runs(pass)) << pass;
    EXPECT_FALSE(runs("subsurface.shade"));
    EXPECT_FALSE(runs("brdf.light"));
    EXPECT_NE(explained().find("throughput: subsurface scattering of object \"ball\" is precomputed"),
              std::string::npos);
    scene.objects[0].material.translucent().precomputed = false;
    EXPECT_FALSE(runs("throughput.shade"));
    EXPECT_TRUE(runs("subsurface.shade"));
}

// What moves is drawn as if it were not precomputed.
TEST_F(Precomputed, WhatChangesItsShapeIsLeftToOthers) {
    scene.objects[0].wave.amplitude = {0, 0.001f, 0};
    EXPECT_FALSE(runs("throughput.shade"));
    EXPECT_TRUE(runs("subsurface.shade"));
    const std::vector<std::string> left = technique::notDrawn(scene);
    EXPECT_TRUE(std::any_of(left.begin(), left.end(), [](const std::string& line) {
        return line.find("precomputed light of what moves or has paint where light enters") !=
               std::string::npos;
    }));
}

// The surface texture of the paper's eq. 13 and 14: what texels and what vertices carry is multiplied by it
// alike.
TEST_F(Precomputed, PaintOnTopMultipliesWhatLeaves) {
    const Image plain = picture();
    const scene::Stroke half{{.map = scene::PaintMap::Outgoing, .value = {0.5f, 0.25f, 1}},
                             {},
                             scene::Stroke::Fill{vec3(-1, 0, -1), vec3(1)}};
    const auto paint = [&](const scene::Stroke& stroke) {
        const auto painted = scene::paint(scene.objects[0], std::array{stroke}, 256);
        ASSERT_TRUE(painted.ok()) << painted.error().message;
        scene.objects[0].painting = *painted;
    };
    paint(half);
    EXPECT_TRUE(runs("throughput.shade"));
    const Image painted = picture();
    for (int y = 0; y < plain.height; ++y)
        for (int x = 0; x < plain.width; ++x) {
            if (std::abs(y - plain.height / 2) < 3) continue; // texels across the border
            const bool isUpper = y < plain.height / 2;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(painted.at(x, y)[c], plain.at(x, y)[c] * (isUpper ? half.brush.value[c] : 1),
                            1e-5f * plain.at(x, y)[c] + 1e-9f);
        }
    EXPECT_EQ(picture(scene::Aov::Irradiance).pixels, [&] {
        scene.objects[0].painting.reset();
        return picture(scene::Aov::Irradiance).pixels;
    }()) << "paint on top changes nothing of what arrives";
    paint({{.map = scene::PaintMap::Translucency, .value = vec3(0.5f)}, {}, half.fill});
    EXPECT_FALSE(runs("throughput.shade")) << "light enters elsewhere";
    EXPECT_TRUE(runs("subsurface.shade"));
}

TEST_F(Precomputed, TheAtlasHoldsThePartsAndTheIlluminationMap) {
    const Image whole = picture(scene::Aov::Atlas);
    settings().part = Part::Local;
    const Image local = picture(scene::Aov::Atlas);
    settings().part = Part::Global;
    const Image global = picture(scene::Aov::Atlas);
    for (std::size_t i = 0; i < whole.pixels.size(); ++i)
        if (i % 4 != 3) {
            EXPECT_NEAR(whole.pixels[i], local.pixels[i] + global.pixels[i], 1e-5f * whole.pixels[i] + 1e-9f);
        }
    settings().part = Part::Illumination;
    // What enters is what arrives less what is reflected: 4 % of it straight on, all where it grazes.
    const Image enters = picture(), arrives = picture(scene::Aov::Irradiance);
    for (std::size_t i = 0; i < enters.pixels.size(); i += 4) {
        EXPECT_LE(enters.pixels[i], 0.961f * arrives.pixels[i] + 1e-6f);
        if (arrives.pixels[i] > 0.7f) {
            EXPECT_GT(enters.pixels[i], 0.94f * arrives.pixels[i]);
        }
    }
    // Under light of 1 W/m² no texel gets more than 1, and those that face it nearly as much; a sphere's
    // texels show half of it lit.
    const Image entering = picture(scene::Aov::Atlas);
    float most = 0;
    int lit = 0, shown = 0;
    for (std::size_t i = 0; i < entering.pixels.size(); i += 4) {
        most = std::max(most, entering.pixels[i]);
        shown += entering.pixels[i + 3] > 0;
        lit += entering.pixels[i] > 0;
    }
    EXPECT_LE(most, 0.961f);
    EXPECT_GT(most, 0.9f);
    EXPECT_GT(shown, entering.width * entering.height / 3);
    EXPECT_NEAR(float(lit) / float(shown), 0.5f, 0.05f);
}

TEST_F(Precomputed, EvenLightLeavesAPatchAsAHalfSpaceByEachMethod) {
    makePatch();
    const Medium medium = keyOf(scene.objects[0], {}, DipoleGeometry::Planar).medium;
    const vec3 exact = float(diffusion::transmittedShare(1, 1.5)) * Response(medium, 0.03, 0).total();
    for (const Local local : {Local::Live, Local::Stored})
        for (const Global global : {Global::Sparse, Global::Hierarchical}) {
            settings().local = local;
            settings().global = global;
            const Image image = picture();
            float worst = 0;
            for (int y = 0; y < image.height; ++y)
                for (int x = 0; x < image.width; ++x)
                    for (int c = 0; c < 3; ++c)
                        worst = std::max(worst, std::abs(image.at(x, y)[c] / exact[c] - 1));
            EXPECT_LT(worst, 0.01f) << int(local) << ' ' << int(global);
            EXPECT_GT(worst, 0);
        }
}

// Over the ball, against the integral without a bake; half of the picture is lit from the right.
TEST_F(Precomputed, LightOnABallIsPlacedAsTheExactDipoleHasIt) {
    scene.view.show = scene::Aov::Radiosity;
    truth::DipoleOptions options;
    options.aov = scene::Aov::Radiosity;
    options.samples = 512;
    const auto exact = truth::DipoleEstimator::create(scene, scene.size, options);
    ASSERT_TRUE(exact) << exact.error().message;
    Image expected(48, 48, 4);
    for (int y = 0; y < 48; y += 3)
        for (int x = 0; x < 48; x += 3) {
            const truth::Pixel pixel = exact->solve({x, y});
            for (int c = 0; c < 3; ++c)
                expected.at(x, y)[c] = float(pixel.value[c]);
        }
    for (const Local local : {Local::Live, Local::Stored}) {
        settings().local = local;
        const Image found = picture();
        double wrong = 0, all = 0;
        for (int y = 0; y < 48; y += 3)
            for (int x = 0; x < 48; x += 3)
                for (int c = 0; c < 3; ++c) {
                    wrong += std::abs(double(found.at(x, y)[c] - expected.at(x, y)[c])) / 2;
                    all += double(expected.at(x, y)[c]);
                }
        EXPECT_GT(all, 1);
        EXPECT_LT(wrong / all, 0.02) << int(local);
    }
}

// A small picture asks for what it shows, a large one for the whole atlas: every third pixel of it is the
// same place.
TEST_F(Precomputed, SmallPicturesShowWhatLargeOnesShow) {
    const Image small = picture();
    scene.size = {144, 144};
    const Image large = picture();
    float most = 0;
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x) {
            const float *one = small.at(x, y), *same = large.at(3 * x + 1, 3 * y + 1);
            if (one[3] == 0 || same[3] == 0) continue; // its edge is rounded either way
            for (int c = 0; c < 3; ++c)
                most = std::max(most, std::abs(one[c] - same[c]));
        }
    EXPECT_LT(most, 0.005f); // of 0.4: between texels the one has a kernel, the other a mean of four
    EXPECT_GT(most, 0);
}

TEST_F(Precomputed, EqualObjectsShareABake) {
    scene.objects.push_back(scene.objects[0]);
    scene.objects[1].name = "other";
    scene.objects[1].kept = {};
    scene.objects[1].transform.translate = {0.03f, 0, 0};
    picture();
    const auto bakeOfObject = [&](std::size_t i) { return *bakeOf(scene.objects[i], optionsOf(settings())); };
    EXPECT_EQ(bakeOfObject(0), bakeOfObject(1));
}

TEST_F(Precomputed, ItsLightTurnsAndMovesWithIt) {
    const Image before = picture();
    scene.objects[0].transform.translate = {0.3f, -0.2f, 0.1f};
    scene.objects[0].transform.rotate = {0, 0, 90};
    scene.camera.eye = {0.3f, -0.2f, 1.1f};
    scene.camera.target = {0.3f, -0.2f, 0.1f};
    scene.camera.up = {-1, 0, 0};
    scene.lights = {scene::DistantLight{.direction = {0, -1, 0}}};
    const Image after = picture();
    float most = 0;
    for (std::size_t i = 0; i < before.pixels.size(); ++i)
        most = std::max(most, std::abs(before.pixels[i] - after.pixels[i]));
    EXPECT_LT(most, 0.03f); // edges of its shadow fall on other texels of the lamp's view
    EXPECT_GT(most, 0);
}

TEST_F(Precomputed, WhatStandsInTheWayKeepsLightFromIt) {
    scene::Object wall;
    wall.name = "wall";
    wall.shape = scene::Box{{0.001f, 0.04f, 0.04f}};
    wall.transform.translate = {0.015f, 0, 0};
    wall.visible = false;
    scene.objects.push_back(wall);
    const Image image = picture();
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        EXPECT_LE(i % 4 < 3 ? image.pixels[i] : 0, 1e-6f);
}

TEST_F(Precomputed, TakesItsBakeFromAFileAndRefusesThatOfAnother) {
    const Image baked = picture();
    const BakeOptions options = optionsOf(settings());
    const Result<Bake> made = bake(scene.objects[0], options, DipoleGeometry::Planar);
    ASSERT_TRUE(made);
    const BakeKey key = keyOf(scene.objects[0], options, DipoleGeometry::Planar);
    scene.objects[0].bake = std::make_shared<const Bytes>(encodeBake(key, *made));
    scene.objects[0].bakeFile = "ball.bake";
    EXPECT_EQ(picture().pixels, baked.pixels);
    scene.objects[0].shape = shapeOf(scene::meshOf(scene::Sphere{0.009f}, 48));
    const Result<Image> refused = draw();
    ASSERT_FALSE(refused);
    EXPECT_TRUE(
        refused.error().message.starts_with("objects.ball.bake: ball.bake: is baked of another mesh, "))
        << refused.error().message;
}

// Colours of the same ball in light of a lamp and an environment: what mirrors is the same, what leaves
// nearly.
TEST_F(Precomputed, ItsSurfaceMirrorsAsIfItWereNotPrecomputed) {
    scene.lights.push_back(scene::PointLight{.position = {0.02f, 0.03f, 0.06f}, .intensity = 2});
    scene.environment.emplace();
    Image sky(16, 8, 3);
    std::fill(sky.pixels.begin(), sky.pixels.end(), 0.2f);
    scene.environment->map = std::make_shared<const Image>(std::move(sky));
    views::samplingOf(scene).directions = 16;
    const Image baked = picture(scene::Aov::Color);
    scene.objects[0].material.translucent().precomputed = false;
    const Image live = picture(scene::Aov::Color);
    double wrong = 0, all = 0, brightest = 0;
    for (std::size_t i = 0; i < baked.pixels.size(); ++i) {
        wrong += std::abs(double(baked.pixels[i] - live.pixels[i])) / 2;
        all += double(live.pixels[i]);
        brightest = std::max(brightest, double(live.pixels[i]));
    }
    EXPECT_LT(wrong / all, 0.02);
    EXPECT_GT(brightest, 1); // a highlight: what leaves is 0.3 at most
}

TEST_F(Precomputed, PartsAddUpToTheWhole) {
    const Image whole = picture();
    settings().part = Part::Local;
    const Image local = picture();
    settings().part = Part::Global;
    const Image global = picture();
    for (std::size_t i = 0; i < whole.pixels.size(); ++i)
        EXPECT_NEAR(i % 4 < 3 ? whole.pixels[i] - local.pixels[i] - global.pixels[i] : 0, 0, 1e-5f);
}

} // namespace
} // namespace lucent::throughput
