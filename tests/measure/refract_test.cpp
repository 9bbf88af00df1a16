#include "measure/DepthNormals.h"
#include "measure/RefractPlan.h"
#include "measure/Sweep.h"
#include "scene/Mesh.h"
#include "tests/support/Gl.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>
#include <set>

namespace lucent::measure {
namespace {

using RefractPlanTest = support::GlTest;

/// Directions along -z, all of them there.
Image straight(int size) {
    Image image(size, size, 4);
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        image.pixels[i + 2] = -1;
        image.pixels[i + 3] = 1;
    }
    return image;
}

void turn(Image& image, ivec2 at, double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    image.at(at.x, at.y)[0] = 3 * float(std::sin(angle)); // of any length
    image.at(at.x, at.y)[2] = -3 * float(std::cos(angle));
}

TEST(Directions, AreComparedInDegreesWhereThereIsGlass) {
    // 10 x 10 pixels: the left column shows no glass, and one pixel has no exact direction: 89 count.
    // Silhouettes and the picture's border take column 1, the rows at the border and the last column: 7 x 8
    // are inside.
    const Image exact = [] {
        Image image = straight(10);
        image.at(5, 0)[3] = 0;
        return image;
    }();
    Image layers(10, 10, 1), found = straight(10);
    for (int y = 0; y < 10; ++y)
        for (int x = 1; x < 10; ++x)
            *layers.at(x, y) = 2;
    for (int y = 0; y < 10; ++y) {
        turn(found, {0, y}, 90); // no glass
        turn(found, {1, y}, 20); // the silhouette
        for (int x = 2; x < 10; ++x)
            turn(found, {x, y}, 0.01);
    }
    turn(found, {4, 4}, 150);
    found.at(6, 6)[3] = 0;
    const Result<Metrics> metrics = compareDirections(found, "found", exact, layers);
    ASSERT_TRUE(metrics.ok()) << metrics.error().message;
    ASSERT_TRUE(metrics->angles.has_value());
    const auto& [all, inside] = *metrics->angles;
    EXPECT_EQ(all.pixels, 89);
    EXPECT_EQ(inside.pixels, 56);
    EXPECT_NEAR(all.median, 0.01, 1e-5); // rounding of floats, in degrees
    EXPECT_NEAR(all.p95, 20, 1e-5);      // 10 of 88 are that far off, one is farther
    EXPECT_NEAR(all.p99, 150, 1e-5);     // 99 % of 88 are all of them
    EXPECT_NEAR(inside.p95, 0.01, 1e-5);
    EXPECT_NEAR(inside.p99, 150, 1e-5); // one of 55
    EXPECT_NEAR(all.lost, 1 / 89.0, 1e-12);
    EXPECT_NEAR(inside.lost, 1 / 56.0, 1e-12);

    JsonWriter json;
    json.beginObject();
    writeMembers(json, *metrics);
    json.end();
    const auto parsed = nlohmann::json::parse(json.text());
    EXPECT_EQ(parsed["degrees"]["all"]["pixels"], 89);
    EXPECT_NEAR(double(parsed["degrees"]["inside"]["p99"]), 150, 1e-4);

    const Result<Metrics> none = compareDirections(found, "found", exact, Image(10, 10, 1));
    ASSERT_FALSE(none.ok());
    EXPECT_EQ(none.error().message, "found: no pixel is covered; at least one must be");
}

TEST(BenchReport, DirectionsAreWeighedByTheirMedianAngle) {
    BenchReport report;
    for (const double median : {0.1, 0.2}) {
        Measurement m;
        m.ms = Spread{1, 1, 1, 1};
        m.error.emplace().rmse = 1 - median; // the other way round
        m.error->angles.emplace().all.median = median;
        report.measurements.push_back(m);
    }
    report.markParetoFronts();
    EXPECT_TRUE(report.measurements[0].pareto);
    EXPECT_FALSE(report.measurements[1].pareto);
    EXPECT_NE(report.text().find("all: 0.1 degrees"), std::string::npos) << report.text();
}

TEST(RefractPlan, MeshesFillTheSamePlace) {
    scene::Mesh mesh = meshOf(scene::Box{{1, 2, 4}});
    for (vec3& position : mesh.positions)
        position = 3.0f * position + vec3(100, 0, 0);
    const scene::Scene scene = glassScene({"block", std::make_shared<const scene::Mesh>(mesh)}, 8);
    vec3 low(9), high(-9);
    for (const vec3& position : mesh.positions) {
        const vec3 world = vec3(scene.objects[0].transform.worldFromObject() * vec4(position, 1));
        low = glm::min(low, world);
        high = glm::max(high, world);
    }
    EXPECT_NEAR(glm::distance(low, vec3(-0.25f, -0.5f, -1)), 0, 1e-4); // floats near 100 / 6
    EXPECT_NEAR(glm::distance(high, vec3(0.25f, 0.5f, 1)), 0, 1e-4);
}

TEST(RefractPlan, HasEveryShapeAndPromise) {
    const BenchMesh ball{"bunny", std::make_shared<const scene::Mesh>(meshOf(scene::Sphere{1}, 8))};
    const Plan plan = refractPlan({ball}, {}, false);
    std::set<std::string> names;
    for (const Case& one : plan.cases)
        names.insert(one.name);
    EXPECT_EQ(names, (std::set<std::string>{"sphere", "torus", "box", "nested", "bunny"}));
    ASSERT_EQ(plan.series.size(), 2u + 5u); // and the thesis's stages
    for (const Series& series : plan.series) {
        EXPECT_LT(series.points.front().x, 1100);
        EXPECT_NEAR(series.points.back().x, 871e3, 2e3); // the dragon's
    }
    EXPECT_LE(refractPlan({}, {}, true).series[0].points.back().x, 1e5);
    // The promises, from a report in which everything is just missed.
    BenchReport report;
    for (const Case& one : plan.cases) {
        Measurement m;
        m.technique = "refract";
        m.scene = one.name;
        const bool isBunny = one.name == "bunny";
        m.error.emplace().angles = AngleErrors{{isBunny ? 0.31 : 0.11, isBunny ? 3.1 : 2.1, 9, 0.5, 1}, {}};
        report.measurements.push_back(m);
    }
    for (const Series& series : plan.series)
        report.scaling.push_back({"refract", series.setting.name(), "triangles", {{1e3, 1}, {8e5, 1.31}}});
    int missed = 0, promised = 0;
    for (const RatioRule& rule : plan.ratios) {
        const std::optional<Ratio> ratio = rule(report);
        ASSERT_TRUE(ratio.has_value());
        promised += ratio->target ? 1 : 0;
        missed += ratio->met() ? 0 : 1;
    }
    EXPECT_EQ(promised, 2 * 5 + 1); // median and 95 % of each, the trace stage
    EXPECT_EQ(missed, promised);
}

TEST(DepthNormals, AreRightInTheLimitAndOffByASliceOtherwise) {
    // Exact depths: the triangles around a place are off by less the finer they are. The thesis's differences
    // take the places of a row for equally high, which they are not in perspective: 1.4 degrees that no
    // resolution mends.
    for (const DepthNormals method : {DepthNormals::Neighbours, DepthNormals::Delta1, DepthNormals::Delta2}) {
        const NormalErrors coarse = errorsOf(method, 128, 0), fine = errorsOf(method, 256, 0);
        if (method == DepthNormals::Neighbours) {
            EXPECT_LT(fine.median, 0.5 * coarse.median);
        } else {
            EXPECT_NEAR(fine.median, 1.4, 0.1);
            EXPECT_NEAR(coarse.median, 1.4, 0.1);
        }
        // Slices of 0.67 m / 255 under two pixels of 2 * 3 * 0.414 / 256 = 9.7 mm each: slopes are off by
        // 0.13 at most, 7.7 degrees, and half as much with 512.
        const NormalErrors sliced = errorsOf(method, 256, 256), half = errorsOf(method, 256, 512);
        EXPECT_LT(sliced.median, 7.7) << int(method);
        EXPECT_LT(half.median, 0.7 * sliced.median) << int(method);
        EXPECT_GT(sliced.outline, fine.median) << int(method);
    }
    EXPECT_LT(errorsOf(DepthNormals::Delta2, 256, 256).median,
              errorsOf(DepthNormals::Delta1, 256, 256).median);
}

TEST_F(RefractPlanTest, MeasuresAnglesAndBothStagesOfASphere) {
    Plan plan = refractPlan({}, {}, true);
    plan.repeats = {1, 1, 0};
    plan.cases.resize(1);
    plan.cases[0].scene.make = [make = plan.cases[0].scene.make]() {
        Result<scene::Scene> scene = make();
        scene->size = ivec2(32);
        return scene;
    };
    for (Series& series : plan.series)
        series.points.resize(1);
    const auto solve = [](const scene::Scene& scene, int, const truth::Tile& rows) {
        return solveRefraction(scene, rows, 1);
    };
    const BenchReport report = sweep(*context, plan, solve, [](const std::string&) {});
    ASSERT_GE(report.measurements.size(), 1u);
    const Measurement& m = report.measurements[0];
    EXPECT_EQ(m.refused, "");
    ASSERT_TRUE(m.error && m.error->angles);
    // The ball's cone fills sin = 1 / sqrt(9.36) of a picture that ends at tan 22.5 degrees: pi / 4 * (2 * 32
    // * 0.346 / (2 * 0.414))^2 = 561 pixels.
    EXPECT_NEAR(m.error->angles->all.pixels, 561, 30);
    EXPECT_LT(m.error->angles->all.median, 0.1);
    EXPECT_EQ(m.truthNoise, 0);
    EXPECT_GT(m.bytes, 0u);
    EXPECT_TRUE(std::any_of(report.measurements.begin(), report.measurements.end(),
                            [](const Measurement& one) { return one.pareto; }));
    for (const Measurement& one : report.measurements)
        EXPECT_EQ(one.refused, "") << one.method;
    ASSERT_EQ(report.scaling.size(), plan.series.size());
    for (const ScalingSeries& series : report.scaling) {
        ASSERT_EQ(series.points.size(), 1u);
        EXPECT_GT(series.points[0].y, 0);
    }
}

} // namespace
} // namespace lucent::measure
