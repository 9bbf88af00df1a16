// One light: every lamp on every surface behind every other, against the exact solution and in closed forms.
#include "light/Samples.h"
#include "scene/Mesh.h"
#include "technique/Technique.h"
#include "tests/support/Fields.h"
#include "tests/support/Gl.h"
#include "tests/support/Misplaced.h"
#include "tests/truth/scenes.h"
#include "truth/Glass.h"
#include "truth/LightTracer.h"
#include "truth/Picture.h"

#include <atomic>
#include <functional>

namespace lucent::frame {
namespace {

std::shared_ptr<const Image> skyOf(const std::function<float(ivec2)>& radiance) {
    auto map = std::make_shared<Image>(64, 32, 3);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            std::fill_n(map->at(x, y), 3, radiance({x, y}));
    return map;
}

using support::boxAt;
using support::misplaced;

struct OneLight : support::GlTest {
    // A relief that lies on a floor, seen from above, and a box over both.
    scene::Scene scene = support::sceneOf(support::waves({64, 64}), 0.06f, 0.03f);
    OneLight() {
        scene.size = {64, 64};
        scene.camera = {};
        scene.camera.eye = {0, 4, 0};
        scene.camera.up = {0, 0, -1};
        scene.camera.height = 2;
        scene.objects[0].transform.rotate = {-90, 0, 0};
        scene::Object floor;
        floor.name = "floor";
        floor.shape = scene::Plane{{6, 6}};
        floor.transform.translate.y = -0.01f;
        scene.objects.push_back(floor);
        scene.objects.push_back(boxAt({0.35f, 0.4f, 0.1f}));
    }
    Image picture(scene::Aov aov = scene::Aov::Color) {
        Renderer renderer(*context);
        scene.view.show = aov;
        const Status finished = renderer.finish(scene, 1, scene.size);
        EXPECT_TRUE(finished.ok()) << finished.error().message;
        return *renderer.read(scene, aov);
    }
    Image truth(int samples) const {
        const std::atomic<bool> goOn = false;
        const auto exact =
            truth::GlassEstimator::create(scene, scene.size, scene::Aov::Color, {.samples = samples});
        return truth::render(*exact, scene.size, {}, {}, goOn)->values;
    }
};

// Of smooth stripes, so that no pixel stands on an edge.
scene::SpotLight projector() {
    auto stripes = std::make_shared<Image>(64, 32, 3);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c)
                stripes->at(x, y)[c] = 0.6f + 0.4f * std::sin(0.4f * float(x) + 0.3f * float(c * y));
    scene::SpotLight lamp{.position = {0.9f, 1.6f, 0.4f},
                          .direction = {-0.9f, -1.6f, -0.4f},
                          .intensity = 8,
                          .innerAngle = 40,
                          .outerAngle = 50};
    lamp.fov = 60;
    lamp.roll = 20;
    lamp.image = stripes;
    return lamp;
}

const scene::Light kLamps[] = {
    scene::PointLight{.position = {0.9f, 1.6f, 0.4f}, .intensity = 3},
    scene::PointLight{.position = {0.9f, 1.6f, 0.4f},
                      .intensity = 6,
                      .falloff = scene::LightFalloff::InverseSquare,
                      .radius = 0.1f},
    scene::SpotLight{.position = {0.9f, 1.6f, 0.4f},
                     .direction = {-0.9f, -1.6f, -0.4f},
                     .intensity = 8,
                     .innerAngle = 20,
                     .outerAngle = 30},
    scene::DistantLight{.direction = {-0.5f, -1, -0.2f}, .irradiance = 3, .angle = 4},
    scene::AreaLight{
        .corner = {0.7f, 1.6f, 0.2f}, .edgeU = {0.4f, 0, 0}, .edgeV = {0, 0, 0.4f}, .radiance = 40},
    projector(),
};

// Target 1 %: direct and shadowed cells of lucent bench compose. Measured on llvmpipe: see each line's
// number.
TEST_F(OneLight, EveryLampLightsAReliefAFloorAndABoxBehindEachOther) {
    for (std::size_t i = 0; i < std::size(kLamps); ++i) {
        scene.lights = {kLamps[i]};
        const double apart = misplaced(picture(), truth(512));
        EXPECT_LT(apart, 0.01) << "lamp " << i;
        std::printf("lamp %zu: %.2f %% of the light misplaced\n", i, 100 * apart);
    }
}

TEST_F(OneLight, AnEnvironmentIsOccludedByEverything) {
    scene.environment.emplace();
    scene.environment->map =
        skyOf([](ivec2 at) { return at.y < 16 && at.x > 40 && at.x < 50 ? 4.0f : 0.5f; });
    const double apart = misplaced(picture(), truth(2048));
    EXPECT_LT(apart, 0.01);
    std::printf("environment: %.2f %% of the light misplaced\n", 100 * apart);
}

TEST_F(OneLight, AReliefWithoutDepthIsTheMattSurfaceBesideIt) {
    scene = support::sceneOf(support::heights({32, 32}, [](int, int) { return 0.0f; }), 0.1f, 1e-6f);
    scene.size = {32, 32};
    scene.camera = {};
    scene.camera.eye = {0, 4, 0};
    scene.camera.up = {0, 0, -1};
    scene.camera.height = 1;
    scene.objects[0].transform.rotate = {-90, 0, 0};
    scene.objects[0].material.diffuse = vec3(0.6f);
    views::samplingOf(scene).lamp = 16; // as many as matt surfaces take
    for (const scene::Light& lamp : kLamps) {
        scene.lights = {lamp};
        const Image relief = picture(), irradiance = picture(scene::Aov::Irradiance);
        scene::Scene before = scene;
        scene.objects[0].shape = scene::Plane{{1, 1}};
        scene.objects[0].transform.rotate = {};
        const Image matt = picture();
        for (int i = 0; i < 32 * 32; ++i) {
            const std::size_t at = 4 * std::size_t(i);
            EXPECT_NEAR(relief.pixels[at], matt.pixels[at], 1e-3 * double(matt.pixels[at]));
            EXPECT_NEAR(irradiance.pixels[at] * 0.6f / kPi, matt.pixels[at], 1e-3 * double(matt.pixels[at]));
        }
        scene = before;
    }
}

TEST_F(OneLight, LampsAddAndScaleAndTheOrderOfObjectsIsOfNoMatter) {
    scene.lights = {kLamps[0]};
    const Image first = picture();
    scene.lights = {kLamps[3]};
    const Image second = picture();
    scene.lights = {kLamps[0], kLamps[3]};
    const Image both = picture();
    std::get<scene::PointLight>(scene.lights[0]).intensity *= 2;
    std::get<scene::DistantLight>(scene.lights[1]).irradiance *= 2;
    const Image doubled = picture();
    std::reverse(scene.objects.begin(), scene.objects.end());
    const Image reversed = picture();
    for (std::size_t i = 0; i < both.pixels.size(); ++i) {
        if (i % 4 == 3) continue;
        EXPECT_NEAR(both.pixels[i], first.pixels[i] + second.pixels[i], 1e-5);
        EXPECT_EQ(doubled.pixels[i], 2 * both.pixels[i]);
        EXPECT_NEAR(reversed.pixels[i], doubled.pixels[i], 1e-6);
    }
}

TEST_F(OneLight, AnOccluderFarToTheSideChangesNothing) {
    scene.lights = {kLamps[0]};
    const Image without = picture();
    scene.objects.push_back(boxAt({40, 0.4f, 30}));
    EXPECT_LT(misplaced(picture(), without), 1e-3); // texels of the shadow view lie elsewhere
}

TEST_F(OneLight, ShadowViewsAreDrawnOnceForAllThatTheyShade) {
    scene.lights = {kLamps[0]};
    Renderer renderer(*context);
    const std::string text = *renderer.explain(scene, scene.size);
    std::size_t views = 0;
    for (std::size_t at = text.find("views.shadow:"); at != std::string::npos;
         at = text.find("views.shadow:", at + 1))
        ++views;
    EXPECT_EQ(views, 2u); // for the relief without itself, and for all else
}

TEST_F(OneLight, ShadowViewsAndCausticMapsAreDrawnOnceForAllSamplesOfThePixels) {
    scene.lights = {kLamps[0]};
    const auto passes = [&](int samples) {
        technique::addSettings(scene);
        views::samplingOf(scene).pixelSamples = samples;
        Renderer renderer(*context);
        EXPECT_TRUE(renderer.finish(scene, 1, scene.size).ok());
        return renderer.stats().passes;
    };
    const int once = passes(1);
    // Two shadow views less, and the means; the last of these is drawn after they are counted.
    EXPECT_EQ(passes(3), once + 2 * (once - 2) + 2);
    scene.objects.back().material.kind = scene::Clear{};
    const int withGlass = passes(1);
    EXPECT_LT(passes(3), 2 * withGlass); // most of the first one's are the caustic's
}

// Draws that a preview of the scene takes.
int drawsOf(Renderer& renderer, const scene::Scene& scene, std::uint64_t revision, int downscale = 1) {
    for (bool complete = false; !complete;) {
        const Result<Progress> progress = renderer.advance(scene, revision, scene.size, true, downscale);
        EXPECT_TRUE(progress.ok());
        complete = !progress || progress->complete;
    }
    return renderer.stats().draws;
}

TEST_F(OneLight, ShadowsOfTheSkyStayWhileSomethingElseIsDragged) {
    scene::PointLight lamp{.position = {0, 1, 0}};
    scene.lights = {lamp};
    scene.environment.emplace().map = skyOf([](ivec2) { return 0.5f; });
    technique::addSettings(scene);
    Renderer renderer(*context);
    drawsOf(renderer, scene, 1); // a first look has fewer directions
    scene.objects.back().transform.translate.y += 0.01f;
    int first = drawsOf(renderer, scene, 2);
    lamp.position.x += 0.01f;
    scene.lights = {lamp};
    EXPECT_LT(drawsOf(renderer, scene, 3), first / 2) << "a lamp";
    scene.camera.eye.x += 0.1f;
    EXPECT_LT(drawsOf(renderer, scene, 4), first / 2) << "the camera";
    scene.objects.back().transform.translate.y += 0.01f;
    EXPECT_GT(drawsOf(renderer, scene, 5), first / 2) << "what casts them";
    scene.lights.clear(); // water throws their light anew
    scene.objects.push_back(test::glass(scene::Water{.size = {0.2f, 0.2f}}, 1.33f, {0, 0.1f, 0}));
    Renderer other(*context);
    drawsOf(other, scene, 1);
    scene.objects.front().transform.translate.y += 0.01f;
    first = drawsOf(other, scene, 2);
    scene.view.time += 0.01f;
    EXPECT_LT(drawsOf(other, scene, 3), first / 2) << "water";
}

TEST_F(OneLight, CausticsStayWhileTheCameraIsDragged) {
    scene.lights = {kLamps[0]};
    scene.objects.back().material.kind = scene::Clear{};
    technique::addSettings(scene);
    Renderer renderer(*context);
    const int first = drawsOf(renderer, scene, 1);
    drawsOf(renderer, scene, 2); // reflection probes, which stay too
    scene.camera.eye.x += 0.1f;
    EXPECT_LT(drawsOf(renderer, scene, 3), first / 2);
}

TEST_F(OneLight, PreviewsDoNotTouchThePicture) {
    scene.lights = {kLamps[0]};
    scene.objects.back().material.kind = scene::Translucent{.scattering = vec3(30), .absorption = vec3(1)};
    for (const float height : {0.8f, 1.1f, 1.4f}) { // more surfaces behind each other than previews have
        scene.objects.push_back(boxAt({0.3f, height, 0}));
        scene.objects.back().material.kind = scene::Clear{};
    }
    scene.objects.push_back(boxAt({-0.4f, 0.4f, 0}));
    scene.objects.back().shape.emplace<scene::MeshShape>().mesh = // and more triangles
        std::make_shared<scene::Mesh>(scene::meshOf(scene::Sphere{.radius = 0.2f}, 256));
    scene.environment.emplace().map = skyOf([](ivec2) { return 0.5f; });
    technique::addSettings(scene);
    Renderer dragged(*context), still(*context);
    drawsOf(dragged, scene, 1, 2);
    const auto picture = [&](Renderer& renderer) {
        EXPECT_TRUE(renderer.finish(scene, 2, scene.size).ok());
        return *renderer.read(scene, scene::Aov::Color);
    };
    EXPECT_EQ(picture(dragged).pixels, picture(still).pixels);
}

// --- the sky by way of water

struct SkyOverWater : support::GlTest {
    static constexpr float kIor = 1.33f, kDepth = 0.5f, kAbsorption = 0.8f;
    // A floor under water that lies still and is not seen, seen from above; so wide that no light comes
    // beside it.
    scene::Scene scene;
    SkyOverWater() {
        scene = test::sceneOf({test::matt(scene::Plane{{40, 40}}),
                               test::glass(scene::Water{.size = {200, 200}}, kIor, {0, kDepth, 0})});
        scene.objects[1].visible = false;
        scene.objects[1].material.clear().absorption = vec3(kAbsorption);
        scene.size = {64, 64};
        scene.camera.eye = {0, 20, 0};
        scene.camera.up = {0, 0, -1};
        scene.camera.height = 1;
        scene.lights.clear();
        scene.environment.emplace();
        scene.environment->map = skyOf([](ivec2) { return 1.0f; });
        technique::addSettings(scene);
        views::samplingOf(scene).directions = 4096;
        views::samplingOf(scene).pixelSamples = 1;
        scene.view.show = scene::Aov::Irradiance;
    }
    Image picture() {
        Renderer renderer(*context);
        const Status finished = renderer.finish(scene, 1, scene.size);
        EXPECT_TRUE(finished.ok()) << finished.error().message;
        return *renderer.read(scene, scene.view.show);
    }
    // On a horizontal surface under an even sky of radiance 1 and so much water, W/m²; what it lets in of it,
    // where it has an index of refraction.
    static double under(double depth, double surfaceIor = 1) {
        constexpr int kSteps = 4096;
        double sum = 0;
        for (int i = 0; i < kSteps; ++i) {
            const double angle = (i + 0.5) / kSteps * double(kPi) / 2;
            const double bent = depth > 0 ? std::asin(std::sin(angle) / double(kIor)) : angle;
            const double passed = depth > 0 ? (1 - test::fresnel(angle, 1 / double(kIor))) *
                                                  std::exp(-double(kAbsorption) * depth / std::cos(bent))
                                            : 1;
            const double let = surfaceIor > 1 ? 1 - test::fresnel(bent, 1 / surfaceIor) : 1;
            sum += passed * let * std::sin(angle) * std::cos(angle);
        }
        return 2 * double(kPi) * sum * double(kPi) / 2 / kSteps;
    }
};

TEST_F(SkyOverWater, AnEvenSkyLightsTheFloorByWhatTheSurfaceLetsInAndTheWaterLeaves) {
    const Image light = picture();
    const double wanted = under(double(kDepth));
    for (int i = 0; i < 64 * 64; ++i)
        ASSERT_NEAR(light.pixels[4 * std::size_t(i) + 1], wanted, 0.002 * wanted) << i;
}

TEST_F(SkyOverWater, WhatIsThinnerThanAirLetsInWhatItDoesNotMirror) {
    scene.objects[1].material.clear() = {.ior = 0.7f};
    scene.size = {16, 16};
    views::samplingOf(scene).directions = 16384; // what is let in falls steeply near the critical angle
    double wanted = 0;
    constexpr int kSteps = 4096;
    for (int i = 0; i < kSteps; ++i) {
        const double angle = (i + 0.5) / kSteps * double(kPi) / 2;
        wanted += (1 - test::fresnel(angle, 1 / 0.7)) * std::sin(angle) * std::cos(angle);
    }
    wanted *= double(kPi * kPi) / kSteps;
    const Image light = picture();
    EXPECT_NEAR(light.at(8, 8)[1], wanted, 0.01 * wanted);
    EXPECT_EQ(findNonFinite(light), ivec2(-1));
}

TEST_F(SkyOverWater, WhatStandsOverItBesideItAndInItHidesWhatItHides) {
    // A basin whose walls rise above the water, a block on its floor, and a lid over a part of it.
    std::get<scene::Water>(scene.objects[1].shape).size = {1.2f, 1};
    scene.camera.height = 2;
    const std::pair<vec3, vec3> boxes[] = {
        {{0.4f, 0.6f, 2}, {-0.8f, 0.3f, 0}},       {{0.4f, 0.6f, 2}, {0.8f, 0.3f, 0}},
        {{2, 0.6f, 0.4f}, {0, 0.3f, -0.7f}},       {{2, 0.6f, 0.4f}, {0, 0.3f, 0.7f}},
        {{0.25f, 0.2f, 0.3f}, {0.2f, 0.1f, 0.1f}}, {{0.5f, 0.02f, 0.5f}, {-0.3f, 0.8f, -0.2f}}};
    for (const auto& [size, place] : boxes)
        scene.objects.push_back(test::matt(scene::Box{size}, place));
    scene.objects.back().visible = false; // the lid
    scene.environment->map = skyOf([](ivec2 at) { return at.x > 24 && at.x < 40 ? 3.0f : 0.5f; });
    const std::atomic<bool> goOn = false;
    const Image truth =
        truth::traceLight(scene, scene.size, {.photons = 4000000, .samples = 1024}, {}, {}, goOn)->values;
    const double apart = misplaced(picture(), truth);
    EXPECT_LT(apart, 0.02);
    std::printf("sky over water: %.2f %% of the light misplaced\n", 100 * apart);
}

TEST_F(SkyOverWater, WhereBothWaysReachAPlaceBothCount) {
    // Beside and through a sheet with nothing around it.
    std::get<scene::Water>(scene.objects[1].shape).size = {1, 1};
    scene.camera.height = 2;
    scene.size = {32, 32};
    scene.environment->map = skyOf([](ivec2 at) { return at.y > 8 ? 2.0f : 0.1f; }); // most of it low
    const std::atomic<bool> goOn = false;
    const Image truth =
        truth::traceLight(scene, scene.size, {.photons = 4000000, .samples = 1024}, {}, {}, goOn)->values;
    const double apart = misplaced(picture(), truth);
    EXPECT_LT(apart, 0.02);
    std::printf("sky beside and through water: %.2f %% of the light misplaced\n", 100 * apart);
}

TEST_F(SkyOverWater, WhatScattersLightInItHasTheSameLight) {
    scene.view.show = scene::Aov::Radiosity; // without what its surface mirrors of the sky
    scene.size = {32, 32};
    views::samplingOf(scene).directions = 64;
    for (const bool precomputed : {false, true}) {
        scene::Object slab = test::matt(scene::Box{{0.8f, 0.2f, 0.8f}}, {0, 0.1f, 0});
        slab.material.kind = scene::Translucent{.precomputed = precomputed};
        const double ior = double(slab.material.translucent().surfaceIor());
        const scene::Scene empty = scene;
        scene.objects.push_back(slab);
        const Image wet = picture();
        scene.objects.erase(scene.objects.begin() + 1);
        const Image dry = picture();
        scene = empty;
        const double wanted = under(double(kDepth) - 0.2, ior) / under(0, ior);
        // A hundredth: so few directions.
        EXPECT_NEAR(double(wet.at(16, 16)[1] / dry.at(16, 16)[1]), wanted, 0.01 * wanted) << precomputed;
    }
}

} // namespace
} // namespace lucent::frame
