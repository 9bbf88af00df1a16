// One light: every lamp on every surface behind every other, against the exact solution and in closed forms.
#include "light/Samples.h"
#include "technique/Technique.h"
#include "tests/support/Fields.h"
#include "tests/support/Gl.h"
#include "truth/Glass.h"
#include "truth/Picture.h"

#include <atomic>

namespace lucent::frame {
namespace {

scene::Object boxAt(vec3 place) {
    scene::Object box;
    box.name = "box";
    box.shape = scene::Box{vec3(0.25f)};
    box.material.diffuse = {0.7f, 0.4f, 0.2f};
    box.transform.translate = place;
    return box;
}

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
    // Half the summed absolute difference over the light there is.
    static double misplaced(const Image& found, const Image& wanted) {
        double apart = 0, all = 0;
        for (std::size_t i = 0; i < wanted.pixels.size(); ++i) {
            if (i % 4 == 3) continue;
            apart += std::abs(double(found.pixels[i]) - double(wanted.pixels[i])) / 2;
            all += double(wanted.pixels[i]);
        }
        return apart / all;
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
    auto map = std::make_shared<Image>(64, 32, 3);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            std::fill_n(map->at(x, y), 3, y < 16 && x > 40 && x < 50 ? 4.0f : 0.5f);
    scene.environment->map = map;
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

} // namespace
} // namespace lucent::frame
