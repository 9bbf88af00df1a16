// The relief technique on the GPU: known answers, then the exact model in double precision.
#include "tests/support/Relief.h"

namespace lucent::relief {
namespace {

using support::difference;
using support::distantLight;
using support::reliefSettings;
using support::sceneOf;
using Relief = support::ReliefTest;

std::shared_ptr<const Image> flat(int size) {
    return support::heights({size, size}, [](int, int) { return 0.5f; });
}

// --- known answers

TEST_F(Relief, FlatFieldGivesTheSineOfTheElevation) {
    for (double elevation : {90.0, 60.0, 30.0, 10.0}) {
        for (float depth : {0.02f, 0.05f, 1e-6f}) {
            auto scene = sceneOf(flat(64), 0.2f, depth);
            scene.lights.push_back(distantLight(elevation, 0));
            const Image d = render(scene);
            const double sine = std::sin(elevation * std::numbers::pi / 180);
            // Farther from the border at +x than t / tan(elevation), the ray leaves through the surface.
            const int last = 63 - int(std::ceil(64 * depth / std::tan(elevation * std::numbers::pi / 180)));
            for (int x = 0; x < last; ++x)
                EXPECT_NEAR(d.at(x, 32)[0], sine, 2e-6) << elevation << " " << depth;
        }
    }
}

TEST_F(Relief, TiltedPlaneGivesTheCosineForEverySlope) {
    for (double slope : {0.1, 0.5, 1.0, 3.0}) {
        // Heights rise along x by `slope` metres a metre.
        auto scene = sceneOf(support::heights({64, 64}, [](int x, int) { return (float(x) + 0.5f) / 64; }),
                             float(slope), 0.02f);
        scene.lights.push_back(distantLight(70, 150));
        const glm::dvec3 n = glm::normalize(glm::dvec3(-slope, 0, 1));
        const double cosine =
            glm::dot(n, -glm::dvec3(std::get<scene::DistantLight>(scene.lights[0]).direction));
        ASSERT_GT(cosine, 0.5);
        const Image d = render(scene);
        // Away from the border: the outer half texel is level, and the ray's way is 0.02 / cosine.
        for (int y = 24; y < 40; ++y)
            for (int x = 24; x < 40; ++x)
                EXPECT_NEAR(d.at(x, y)[0], cosine, 5e-6) << slope;
    }
}

TEST_F(Relief, DepthTowardsZeroIsLambertOnWhatTheLightSees) {
    // A ridge of 0.1 m between columns 30 and 33, lit from -x at 45 degrees: it shades 0.1 m = 6.4 texels
    // behind.
    auto scene = sceneOf(
        support::heights({64, 64}, [](int x, int) { return x >= 30 && x <= 33 ? 1.0f : 0.0f; }), 0.1f, 1e-6f);
    scene.lights.push_back(distantLight(45, 180));
    const Image d = render(scene);
    for (int x : {5, 15, 25, 45, 60})
        EXPECT_NEAR(d.at(x, 32)[0], std::sqrt(0.5), 1e-6) << x;
    for (int x : {36, 37, 38})
        EXPECT_EQ(d.at(x, 32)[0], 0) << x;
}

TEST_F(Relief, WhiteSkyOnAFlatFieldMeansAQuarterOfTheSphere) {
    auto scene = sceneOf(flat(16), 0.2f, 1e-6f);
    scene.environment.emplace();
    auto white = std::make_shared<Image>(8, 4, 3);
    std::fill(white->pixels.begin(), white->pixels.end(), 1.0f);
    scene.environment->map = white;
    // The mean of max(cos, 0) over the sphere is 1/4; over 1000 directions the midpoint rule is off by 0.1 %.
    views::samplingOf(scene).directions = 1000;
    EXPECT_NEAR(render(scene).at(8, 8)[0], 0.25, 2.5e-4);
    // All directions together: the integral of the cosine, pi, over pi. What the horizon cuts of a cell of
    // half width h is lost, h² / 3 of all: 1.3e-3 for 1000 discs; cells are squares, which reach farther.
    EXPECT_NEAR(render(scene, scene::Aov::Color).at(8, 8)[0], 1, 2e-3);
}

TEST_F(Relief, LightAndFieldTurnedTogetherTurnTheImage) {
    auto scene = sceneOf(support::waves({48, 48}), 0.2f, 0.04f);
    scene.lights.push_back(distantLight(25, 10));
    const Image before = render(scene);
    const auto& map = *scene.objects[0].field().heights;
    // A quarter turn to the left: the texel at column x, row y goes to column y, row 47 - x.
    auto turned =
        sceneOf(support::heights({48, 48}, [&](int x, int y) { return *map.at(47 - y, x); }), 0.2f, 0.04f);
    turned.lights.push_back(distantLight(25, 100));
    const Image after = render(turned);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x)
            EXPECT_NEAR(after.at(y, 47 - x)[0], before.at(x, y)[0], 1e-5);
}

TEST_F(Relief, TheWholeWorldTurnedLeavesTheImageUnchanged) {
    auto scene = sceneOf(support::waves({32, 32}), 0.2f, 0.04f);
    scene.environment.emplace();
    auto map = std::make_shared<Image>(32, 16, 3);
    for (std::size_t i = 0; i < map->pixels.size(); ++i)
        map->pixels[i] = float(i % 7) / 7;
    scene.environment->map = map;
    const Image before = render(scene, scene::Aov::Color);
    // Field, environment and camera turn about the camera's axis.
    scene.objects[0].transform.rotate = {0, 0, 90};
    scene.environment->rotation = {0, 0, 90};
    scene.camera.up = {-1, 0, 0};
    const auto changed = difference(render(scene, scene::Aov::Color), before);
    EXPECT_LT(changed.max, 1e-5);
}

TEST_F(Relief, EnvironmentAndCameraTurnedTogetherLeaveALevelFieldUnchanged) {
    auto scene = sceneOf(flat(32), 0.2f, 0.01f);
    scene.environment.emplace();
    auto map = std::make_shared<Image>(32, 16, 3);
    for (std::size_t i = 0; i < map->pixels.size(); ++i)
        map->pixels[i] = float(i % 5) / 5;
    scene.environment->map = map;
    const Image before = render(scene, scene::Aov::Color);
    scene.environment->rotation = {0, 0, 90};
    scene.camera.up = {-1, 0, 0};
    EXPECT_LT(difference(render(scene, scene::Aov::Color), before).max, 1e-5);
}

TEST_F(Relief, AFullTurnOfTheEnvironmentKeepsTheMean) {
    auto scene = sceneOf(support::waves({24, 24}), 0.2f, 0.04f);
    scene.environment.emplace();
    auto map = std::make_shared<Image>(32, 16, 3);
    for (std::size_t i = 0; i < map->pixels.size(); ++i)
        map->pixels[i] = float((i / 3) % 32) / 32;
    scene.environment->map = map;
    const Image before = render(scene, scene::Aov::Color);
    scene.environment->rotation = {0, 360, 0};
    EXPECT_LT(difference(render(scene, scene::Aov::Color), before).max, 1e-5);
}

TEST_F(Relief, ANewBlockerOutsideTheNeighboursNeverBrightens) {
    auto scene = sceneOf(support::waves({32, 32}), 0.1f, 0.03f);
    scene.lights.push_back(distantLight(20, 0));
    const Image before = render(scene);
    auto higher = std::make_shared<Image>(*scene.objects[0].field().heights);
    *higher->at(24, 16) = 2;
    scene.objects[0].field().heights = higher;
    const Image after = render(scene);
    for (int y = 0; y < 32; ++y) {
        for (int x = 0; x < 32; ++x) {
            if (std::max(std::abs(x - 24), std::abs(y - 16)) < 2)
                continue; // their own normal or height changed
            EXPECT_LE(after.at(x, y)[0], before.at(x, y)[0] + 1e-6);
        }
    }
    EXPECT_LT(after.at(20, 16)[0], before.at(20, 16)[0]); // and in front of it something did darken
}

TEST_F(Relief, LightsAddAndTheBaseCountsOnce) {
    auto scene = sceneOf(support::waves({16, 16}), 0.1f, 0.03f);
    scene.objects[0].material.base = {0.1f, 0.2f, 0.3f};
    const auto colorWith = [&](std::vector<scene::Light> lights) {
        scene.lights = std::move(lights);
        return render(scene, scene::Aov::Color);
    };
    const Image none = colorWith({});
    EXPECT_FLOAT_EQ(none.at(8, 8)[2], 0.3f);
    const Image a = colorWith({distantLight(30, 0)});
    const Image b = colorWith({distantLight(50, 200)});
    const Image both = colorWith({distantLight(30, 0), distantLight(50, 200)});
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(both.at(8, 8)[i], a.at(8, 8)[i] + b.at(8, 8)[i] - none.at(8, 8)[i], 1e-6);
    reliefSettings(scene).normalise = true;
    const Image mean = colorWith({distantLight(30, 0), distantLight(50, 200)});
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(mean.at(8, 8)[i], 0.5 * (a.at(8, 8)[i] + b.at(8, 8)[i]), 1e-6);
}

TEST_F(Relief, InverseSquareFallsWithTheSquareOfTheDistance) {
    // A field so small that every point is 0.5 or 1 m from the light; t/r does not matter straight below it.
    auto scene = sceneOf(flat(4), 0, 1e-6f);
    scene.objects[0].field().width = 1e-3f;
    scene.camera.height = 1e-3f;
    scene::PointLight light{
        .position = {0, 0, 0.5f}, .intensity = kPi, .falloff = scene::LightFalloff::InverseSquare};
    scene.lights = {light};
    EXPECT_NEAR(render(scene, scene::Aov::Color).at(2, 2)[0], 4, 1e-4);
    light.position.z = 1;
    scene.lights = {light};
    EXPECT_NEAR(render(scene, scene::Aov::Color).at(2, 2)[0], 1, 1e-4);
}

TEST_F(Relief, LampsWithASizeAgreeWithTheTruth) {
    auto scene = sceneOf(support::noise({64, 64}), 0.2f, 0.03f);
    scene::DistantLight sun = distantLight(25, 60);
    sun.angle = 15;
    scene::PointLight bulb;
    bulb.radius = 0.25f;
    bulb.falloff = scene::LightFalloff::InverseSquare;
    scene.objects[0].material.specularity = 0.3f;
    scene.objects[0].material.forwardScatter = 0.5f;
    scene.lights = {sun, bulb};
    views::samplingOf(scene).lamp = 1024;
    // 256 points of the truth and 1024 of ours err by about 1e-3 of a light together; hard edges would miss
    // by 0.03.
    EXPECT_LT(difference(render(scene, scene::Aov::Color), truth(scene, scene::Aov::Color)).rms, 2e-3);
    scene::Scene hard = scene;
    std::get<scene::DistantLight>(hard.lights[0]).angle = 0;
    std::get<scene::PointLight>(hard.lights[1]).radius = 0;
    EXPECT_GT(difference(render(scene, scene::Aov::Color), render(hard, scene::Aov::Color)).rms, 0.02);
}

TEST_F(Relief, ImportanceNeedsFewerDirectionsUnderASmallSun) {
    auto scene = sceneOf(support::noise({48, 48}), 0.2f, 0.03f);
    auto map = std::make_shared<Image>(128, 64, 3);
    std::fill(map->pixels.begin(), map->pixels.end(), 0.2f);
    for (int y = 18; y < 22; ++y)
        for (int x = 60; x < 64; ++x)
            std::fill_n(map->at(x, y), 3, 150.0f);
    scene.environment.emplace();
    scene.environment->map = map;
    scene.environment->rotation = {60, 0, 0};
    views::Sampling& settings = views::samplingOf(scene);
    settings.directions = 2000;
    const Image exact = render(scene, scene::Aov::Color);
    settings.directions = 64;
    const double equal = difference(render(scene, scene::Aov::Color), exact).rms;
    settings.environment = views::EnvironmentSampling::Importance;
    EXPECT_LT(difference(render(scene, scene::Aov::Color), exact).rms, equal / 2);
}

TEST_F(Relief, CountingIsTheThesisWordForWord) {
    // Level field at z = 0, light 1 m straight above, t = 0.25, 100 steps of 0.0125 from z = -0.25: points 0
    // to 19 lie below the surface (point 20 is on it up to rounding, which may count it): d = 1/21 or 1/22.
    auto scene = sceneOf(support::heights({32, 32}, [](int, int) { return 0.0f; }), 0.1f, 0.25f);
    scene.lights.push_back(scene::PointLight{.position = {0.5f / 32, 0.5f / 32, 1}});
    reliefSettings(scene).method = Method::Counting;
    reliefSettings(scene).steps = 100;
    const float d = render(scene).at(16, 15)[0];
    EXPECT_TRUE(std::abs(d - 1.0 / 21) < 1e-6 || std::abs(d - 1.0 / 22) < 1e-6) << d;
}

TEST_F(Relief, MarchConvergesToHierarchy) {
    auto scene = sceneOf(support::noise({64, 64}), 0.2f, 0.04f);
    scene.lights.push_back(distantLight(20, 40));
    const Image exact = render(scene);
    reliefSettings(scene).method = Method::March;
    double last = 1;
    for (int steps : {16, 64, 256, 1024}) {
        reliefSettings(scene).steps = steps;
        const double rms = difference(render(scene), exact).rms;
        EXPECT_LT(rms, 0.5 * last) << steps; // four times the steps: about a quarter of the error
        last = rms;
    }
    EXPECT_LT(last, 1e-3);
}

// --- the exact model in double precision

struct Scenes : Relief, testing::WithParamInterface<int> {
    scene::Scene make() {
        const auto map = GetParam() % 2 ? support::waves({96, 64}) : support::noise({64, 96});
        auto scene = sceneOf(map, GetParam() % 3 ? 0.15f : 0.6f, GetParam() % 5 < 2 ? 0.05f : 0.3f);
        auto& material = scene.objects[0].material;
        material.specularity = 0.4f;
        material.forwardScatter = 0.5f;
        material.specularFalloff = {0.2f, 0.9f};
        material.scatterFalloff = {-1, 0.5f};
        switch (GetParam() % 4) {
        case 0:
            scene.lights.push_back(distantLight(15, 70));
            break;
        case 1:
            scene.lights.push_back(scene::PointLight{.position = {0.3f, 0.1f, 0.4f}});
            break;
        case 2:
            scene.lights.push_back(distantLight(-20, 200)); // from below, through the solid
            scene.lights.push_back(scene::PointLight{.position = {-0.6f, 0.2f, 0.1f}});
            break;
        default:
            scene.lights.push_back(scene::PointLight{.position = {0, 0, -0.5f}}); // behind
        }
        if (GetParam() >= 6) reliefSettings(scene).attenuation = Attenuation::Exponential;
        return scene;
    }
};
INSTANTIATE_TEST_SUITE_P(Relief, Scenes, testing::Range(0, 12));

TEST_P(Scenes, HierarchyAgreesWithTheTruth) {
    const auto scene = make();
    const Image ours = render(scene), exact = truth(scene);
    const auto d = difference(ours, exact);
    EXPECT_LT(d.rms, 3e-6);
    // A ray that touches a crest cuts a stretch whose length goes with the root of its depth: there a
    // rounding of 3e-8 m in height becomes 4e-5 m of way (crests of 5 mm radius). Such rays are few: at most
    // 18 of 6144 here.
    EXPECT_LT(d.max, 5e-4) << d.worst.x << " " << d.worst.y;
    int touching = 0;
    for (std::size_t i = 0; i < ours.pixels.size(); i += 4)
        touching += std::abs(ours.pixels[i] - exact.pixels[i]) > 1e-5;
    EXPECT_LE(touching, int(ours.pixels.size() / 4 / 300));
    const auto color = difference(render(scene, scene::Aov::Color), truth(scene, scene::Aov::Color));
    EXPECT_LT(color.max, 1e-3); // two lights at most
    EXPECT_LT(color.rms, 6e-6);
}

TEST_P(Scenes, HierarchyAgreesWithTheTruthFromAnyCamera) {
    auto scene = make();
    scene.camera.type = GetParam() % 2 ? scene::Camera::Type::Perspective : scene::Camera::Type::Orthographic;
    scene.camera.eye = {0.9f, -1.1f, 1.2f};
    scene.camera.up = {0, 0, 1};
    scene.camera.height = 1.4f;
    scene.objects[0].transform.rotate = {10, 20, 30};
    scene.objects[0].transform.scale = 0.8f;
    scene.size = {80, 64};
    const Image ours = render(scene), exact = truth(scene);
    // Silhouettes and walls move by rounding: those pixels see another point altogether.
    int differing = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 80; ++x)
            differing += std::abs(ours.at(x, y)[0] - exact.at(x, y)[0]) > 2e-4;
    EXPECT_LE(differing, 80 * 64 / 200) << "pixels";
}

} // namespace
} // namespace lucent::relief
