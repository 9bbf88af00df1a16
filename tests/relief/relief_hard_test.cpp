// The hard cases of the relief model: no NaN, no Inf (render() checks), and the truth's values.
#include "tests/support/Relief.h"

namespace lucent::relief {
namespace {

using support::difference;
using support::distantLight;
using support::sceneOf;
using Hard = support::ReliefTest;

struct Case {
    const char* name;
    ivec2 size;
    std::function<float(int, int)> height;
    float heightScale, depth;
};

const Case kFields[] = {
    {"cliff", {32, 32}, [](int x, int) { return x < 16 ? 1.0f : 0.0f; }, 0.5f, 0.05f},
    {"spikes", {32, 32}, [](int x, int y) { return x % 8 == 3 && y % 8 == 5 ? 1.0f : 0.0f; }, 0.4f, 0.05f},
    {"constant", {32, 32}, [](int, int) { return 0.7f; }, 0.3f, 0.05f},
    {"one texel", {1, 1}, [](int, int) { return 0.5f; }, 0.3f, 0.2f},
    {"one row", {1, 33}, [](int, int y) { return float(y % 5) / 5; }, 3.0f, 0.5f},
    {"one column", {33, 1}, [](int x, int) { return float(x % 5) / 5; }, 0.1f, 0.05f},
    {"odd size", {37, 23}, [](int x, int y) { return float((x * 7 + y * 3) % 11) / 11; }, 0.1f, 0.05f},
    {"no height", {32, 32}, [](int x, int y) { return float((x ^ y) & 1); }, 0, 0.05f},
    {"huge height", {32, 32}, [](int x, int y) { return float((x * y) % 13) / 13; }, 1e4f, 10},
    {"terraces", {64, 64}, [](int x, int y) { return std::floor(float(x + y) / 8) / 16; }, 0.2f, 0.03f},
    {"depth 10", {32, 32}, [](int x, int y) { return float((x * 5 + y) % 9) / 9; }, 0.2f, 10},
    {"depth 1e-6", {32, 32}, [](int x, int y) { return 0.02f * float(x) + 0.01f * float(y); }, 0.5f, 1e-6f},
};

struct Fields : Hard, testing::WithParamInterface<int> {
    scene::Scene make() const {
        const Case& field = kFields[GetParam()];
        auto scene = sceneOf(support::heights(field.size, field.height), field.heightScale, field.depth);
        return scene;
    }
    // d is steep where a ray's way inside is about t and changes fast with the point; and a light that only
    // grazes a border or a step is seen or not by the last digit. Few pixels may differ by that.
    void expectTruth(const scene::Scene& scene, const std::string& what) {
        const Image ours = render(scene), exact = truth(scene);
        int differing = 0;
        double worst = 0;
        for (std::size_t i = 0; i < ours.pixels.size(); i += 4) {
            const double d = std::abs(double(ours.pixels[i]) - exact.pixels[i]);
            differing += d > 1e-4;
            worst = std::max(worst, d);
        }
        const int pixels = scene.size.x * scene.size.y;
        EXPECT_LE(differing, pixels / 100) << kFields[GetParam()].name << ", " << what << ", worst " << worst;
    }
};
INSTANTIATE_TEST_SUITE_P(Relief, Fields, testing::Range(0, int(std::size(kFields))));

TEST_P(Fields, DistantLightsFromTheZenithToBelowTheHorizon) {
    for (double elevation : {90.0, 45.0, 10.0, 0.1, 0.0, -0.1, -30.0, -90.0}) {
        for (double azimuth : {0.0, 33.0}) {
            auto scene = make();
            scene.lights.push_back(distantLight(elevation, azimuth));
            expectTruth(scene, "elevation " + std::to_string(elevation));
        }
    }
}

TEST_P(Fields, PointLightsOverATexelInsideTheSolidUnderTheFieldNearAndFar) {
    const vec3 places[] = {{0.5f / 32, 0.5f / 32, 2}, {0, 0, 0.01f},       {0, 0, -0.3f},
                           {1e-4f, 0, 1e-4f},         {3e5f, -4e5f, 1e6f}, {0.7f, 0.7f, 0.2f}};
    for (const vec3& place : places) {
        auto scene = make();
        scene.lights.push_back(scene::PointLight{.position = place});
        expectTruth(scene, "light at " + std::to_string(place.x) + " " + std::to_string(place.z));
    }
}

TEST_F(Hard, SampleHeightsFarFromZeroKeepTheirDigits) {
    // The same waves on a pedestal of 100: heights relative to the point lose nothing but the map's own
    // rounding (100 in float: 7.6e-6), which is 7.6e-6 * 0.1 m against t = 0.05 m.
    const auto low = support::waves({48, 48});
    auto lifted = support::heights({48, 48}, [&](int x, int y) { return 100 + *low->at(x, y); });
    auto scene = sceneOf(lifted, 0.1f, 0.05f);
    scene.camera.eye.z = 20;
    scene.lights.push_back(distantLight(20, 30));
    EXPECT_LT(difference(render(scene), truth(scene)).max, 2e-4);
}

TEST_F(Hard, ALargeFieldAgreesAtItsFarCorner) {
    // 4096 wide: grid coordinates have 2.4e-4 texels of rounding there; a strip keeps the test small.
    auto scene = sceneOf(support::noise({4096, 32}), 0.02f, 0.004f);
    scene.lights.push_back(distantLight(15, 170));
    const auto d = difference(render(scene), truth(scene));
    EXPECT_LT(d.rms, 1e-4);
    EXPECT_LT(d.max,
              5e-3); // a slope of 1 in a cell: 2.4e-4 texels over t of 16 texels, times the way's change
}

TEST_F(Hard, BilinearCellsHaveNoCracks) {
    // A smooth field of strong curvature looked along the cells' borders: the light's rays run on grid lines.
    for (double azimuth : {0.0, 45.0, 90.0, 135.0}) {
        auto scene = sceneOf(support::waves({64, 64}), 0.4f, 0.05f);
        scene.lights.push_back(distantLight(30, azimuth));
        EXPECT_LT(difference(render(scene), truth(scene)).max, 3e-5) << azimuth;
    }
}

TEST_F(Hard, TerracesOfEightBitsAreReportedAgainstTheOriginal) {
    const auto original = support::waves({128, 128});
    const auto terraces = support::heights(
        {128, 128}, [&](int x, int y) { return std::round(*original->at(x, y) * 255) / 255; });
    for (float depth : {0.02f, 1e-6f}) {
        auto a = sceneOf(original, 0.2f, depth), b = sceneOf(terraces, 0.2f, depth);
        for (auto* scene : {&a, &b})
            scene->lights.push_back(distantLight(30, 20));
        const double rms = difference(render(a), render(b)).rms;
        std::printf("8-bit terraces against the original, t = %g m: RMSE of d %.4f\n", double(depth), rms);
        // A step of 1/255 * 0.2 m over two texels of 1/128 m turns the normal by 0.05 at most.
        EXPECT_LT(rms, 0.05);
        EXPECT_GT(rms, 0);
    }
}

TEST_F(Hard, EqualFalloffBoundsAreAStep) {
    auto scene = sceneOf(support::waves({16, 16}), 0.2f, 0.05f);
    scene.objects[0].material.relief().specularity = 1;
    scene.objects[0].material.relief().specularFalloff = {0.8f, 0.8f};
    scene.lights.push_back(distantLight(60, 0));
    const Image color = render(scene, scene::Aov::Color);
    for (std::size_t i = 0; i < color.pixels.size(); i += 4)
        EXPECT_TRUE(color.pixels[i] == 0 || color.pixels[i] == 1) << color.pixels[i];
}

} // namespace
} // namespace lucent::relief
