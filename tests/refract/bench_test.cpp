// The benchmark of refraction: its cases and promises, and normals from depths.
#include "techniques/refract/bench/DepthNormals.h"
#include "tests/support/Bench.h"
#include "tests/support/Gl.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace lucent::refract {
namespace {

using namespace measure;
using RefractBench = support::GlTest;

TEST(Refraction, HasEveryShapeAndPromise) {
    const Plan plan = support::planOf("refraction", false, support::RoundBunny());
    std::set<std::string> names;
    for (const Case& one : plan.cases)
        names.insert(one.name);
    EXPECT_EQ(names, (std::set<std::string>{"sphere", "torus", "box", "nested", "bunny"}));
    ASSERT_EQ(plan.series.size(), 2u + 5u); // and the thesis's stages
    for (const Series& series : plan.series) {
        EXPECT_LT(series.points.front().x, 1100);
        EXPECT_NEAR(series.points.back().x, 871e3, 2e3); // the dragon's
    }
    EXPECT_LE(support::planOf("refraction", true).series[0].points.back().x, 1e5);
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
    EXPECT_EQ(support::countMissed(plan, report), 2 * 5 + 1); // median and 95 % of each, the trace stage
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

TEST_F(RefractBench, MeasuresAnglesAndBothStagesOfASphere) {
    Plan plan = support::planOf("refraction", true);
    plan.repeats = {1, 1, 0};
    plan.cases.resize(1);
    plan.cases[0].scene.make = [make = plan.cases[0].scene.make]() {
        Result<scene::Scene> scene = make();
        scene->size = ivec2(32);
        return scene;
    };
    for (Series& series : plan.series)
        series.points.resize(1);
    const BenchReport report = sweep(*context, plan, support::solveHere, [](const std::string&) {});
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
} // namespace lucent::refract
