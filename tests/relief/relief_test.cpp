// The relief technique on the GPU beside what is known of its methods and beside the exact model in double
// precision. Its closed forms are those of the self-check, techniques/relief/bench/Forms.cpp.
#include "tests/support/Relief.h"

namespace lucent::relief {
namespace {

using support::difference;
using support::distantLight;
using support::reliefSettings;
using support::sceneOf;
using Relief = support::ReliefTest;

// --- lamps and methods

TEST_F(Relief, LampsWithASizeAgreeWithTheTruth) {
    auto scene = sceneOf(support::noise({64, 64}), 0.2f, 0.03f);
    scene::DistantLight sun = distantLight(25, 60);
    sun.angle = 15;
    scene::PointLight bulb;
    bulb.radius = 0.25f;
    bulb.falloff = scene::LightFalloff::InverseSquare;
    scene.objects[0].material.relief().specularity = 0.3f;
    scene.objects[0].material.relief().forwardScatter = 0.5f;
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
    settings.environment = views::EnvironmentSampling::Equal;
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
        material.relief().specularity = 0.4f;
        material.relief().forwardScatter = 0.5f;
        material.relief().specularFalloff = {0.2f, 0.9f};
        material.relief().scatterFalloff = {-1, 0.5f};
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
