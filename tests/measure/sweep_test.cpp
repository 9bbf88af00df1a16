#include "tests/support/Bench.h"
#include "tests/support/Gl.h"

#include <set>

namespace lucent::measure {
namespace {

using StopwatchTest = support::GlTest;
using SweepTest = support::GlTest;

TEST_F(StopwatchTest, RunsBothKindsOfWorkInTurnAndLeavesTheFirstPairOut) {
    std::string order;
    const auto note = [&](char kind) {
        return [&order, kind] {
            order += kind;
            return Status(Done{});
        };
    };
    Stopwatch stopwatch(*context, note('w'), note('o'), {.least = 2, .most = 3, .enoughMs = 1e9});
    for (;;) {
        const auto done = stopwatch.step();
        ASSERT_TRUE(done.ok());
        if (*done) break;
    }
    EXPECT_EQ(order, "wowowowo");
    EXPECT_EQ(stopwatch.spread().repeats, 3);
    EXPECT_GE(stopwatch.spread().low, 1e-3);
}

TEST_F(StopwatchTest, HandsAnErrorOfTheWorkOn) {
    Stopwatch stopwatch(
        *context, [] { return Status(Error{"no memory"}); }, [] { return Status(Done{}); }, {});
    const auto done = stopwatch.step();
    ASSERT_FALSE(done.ok());
    EXPECT_EQ(done.error().message, "no memory");
}

Case smallCase(const std::string& name, std::vector<Setting> settings) {
    const auto make = []() -> Result<scene::Scene> {
        scene::Scene scene = fieldScene(benchNoise(16), 0.05f);
        scene.lights.push_back(scene::PointLight{});
        return scene;
    };
    return {"relief", name, {make, 256}, std::move(settings), {}};
}

TEST_F(SweepTest, MeasuresEverySettingAgainstTheExactSolution) {
    Plan plan;
    plan.repeats = {1, 1, 0};
    plan.cases = {smallCase("field", {{"hierarchy"},
                                      {"march", {{"steps", "4"}}},
                                      {"counting", {{"steps", "4"}}, true},
                                      {"magic"},
                                      {"march", {{"steps", "0"}}}})};
    plan.series = {
        {"relief", "pixels", {"hierarchy"}, {{256, plan.cases[0].scene}, {256, plan.cases[0].scene}}}};
    plan.ratios = {[](const BenchReport& report) -> std::optional<Ratio> {
                       return Ratio{"measurements", double(report.measurements.size()), 5, true};
                   },
                   [](const BenchReport&) { return std::optional<Ratio>(); }};
    std::set<std::string> said;
    Sweep sweep(*context, plan, support::solveHere, [&](const std::string& line) { said.insert(line); });
    double last = 0;
    while (sweep.step()) {
        EXPECT_GE(sweep.share(), last);
        last = sweep.share();
    }
    EXPECT_NEAR(sweep.share(), 1, 1e-12);
    EXPECT_EQ(said.count("field: march steps=4"), 1u);
    EXPECT_EQ(sweep.report().measurements[0].truthNoise, 0); // a lamp without size is solved exactly

    const BenchReport& report = sweep.report();
    ASSERT_EQ(report.measurements.size(), 5u);
    const auto& exact = report.measurements[0];
    const auto& march = report.measurements[1];
    const auto& counting = report.measurements[2];
    EXPECT_LT(exact.error->rmse, 1e-5); // rounding
    EXPECT_GT(march.error->rmse, 1e-3); // four steps over a field of 16 texels
    EXPECT_TRUE(exact.error->flip && exact.error->ssim);
    EXPECT_TRUE(exact.pareto);
    EXPECT_EQ(exact.lights, 1);
    EXPECT_EQ(exact.size, ivec2(16));
    EXPECT_GT(exact.bytes, 0u);
    EXPECT_TRUE(!counting.error && counting.modelError && !counting.pareto);
    EXPECT_EQ(report.measurements[3].refused.rfind("technique.relief.method is \"magic\"", 0), 0u)
        << report.measurements[3].refused;
    EXPECT_EQ(report.measurements[4].refused.rfind("technique.relief.steps is 0", 0), 0u)
        << report.measurements[4].refused;
    ASSERT_EQ(report.scaling.size(), 1u);
    EXPECT_EQ(report.scaling[0].points.size(), 2u);
    ASSERT_EQ(report.ratios.size(), 1u);
    EXPECT_TRUE(report.ratios[0].met());
}

TEST_F(SweepTest, ASceneThatCannotBeMadeIsWrittenDownForEachSetting) {
    Plan plan;
    plan.cases = {smallCase("field", {{"hierarchy"}, {"march"}})};
    plan.cases[0].scene.make = []() -> Result<scene::Scene> { return Error{"field.pfm: is gone"}; };
    const BenchReport report = sweep(*context, plan, support::solveHere, [](const std::string&) {});
    ASSERT_EQ(report.measurements.size(), 2u);
    for (const Measurement& m : report.measurements)
        EXPECT_EQ(m.refused, "field.pfm: is gone");
}

TEST_F(SweepTest, AnEnvironmentsExactSolutionTellsItsOwnNoise) {
    Plan plan;
    plan.repeats = {1, 1, 0};
    plan.cases = {smallCase("sky", {{"hierarchy", {{"sampling.directions", "16"}}}})};
    plan.cases[0].scene.make = []() -> Result<scene::Scene> {
        scene::Scene scene = fieldScene(benchNoise(8), 0.05f);
        scene.view.show = scene::Aov::Color;
        scene.environment.emplace();
        scene.environment->map = std::make_shared<const Image>([] {
            Image map(2, 1, 3);
            map.pixels = {1, 1, 1, 0, 0, 0};
            return map;
        }());
        return scene;
    };
    const auto measured = [&](int directions) {
        plan.directions = directions;
        return sweep(*context, plan, support::solveHere, [](const std::string&) {}).measurements.at(0);
    };
    const Measurement few = measured(64), many = measured(1024);
    EXPECT_LE(few.lights, 20); // about 16
    // Sixteen times as many independent directions have a quarter of the noise; cells of the sky do better.
    EXPECT_GT(many.truthNoise, 0);
    EXPECT_LT(many.truthNoise, few.truthNoise / 3);
}

TEST(Benches, EachPartHasANameOfItsOwnAndMeasuresSomethingWithoutFiles) {
    std::set<std::string_view> names{"all", "compose"};
    for (const BenchPart* part : benchParts()) {
        EXPECT_TRUE(names.insert(part->name).second) << part->name;
        EXPECT_FALSE(part->help.empty()) << part->name;
        const Plan plan = support::planOf(part->name, true);
        EXPECT_EQ(plan.cases.empty() && plan.series.empty() && plan.hard.empty(), !part->plan) << part->name;
        EXPECT_TRUE(part->plan || part->prove) << part->name;
        EXPECT_EQ(benchParts(part->name), std::vector{part});
    }
    EXPECT_TRUE(benchParts("speed").empty());
    for (const BenchPart* part : benchParts("all"))
        EXPECT_TRUE(part->isUsual) << part->name;
}

TEST_F(SweepTest, HardCasesPassOrTellTheirErrorOrTheirRefusal) {
    Plan plan = support::planOf("hard", true);
    plan.hard[0].settings = {{"hierarchy"}};
    std::erase_if(plan.hard[0].cases, [](const HardCase& hard) {
        return hard.name != "cliff" && hard.name != "a texel that is NaN";
    });
    const BenchReport report = sweep(*context, plan, support::solveHere, [](const std::string&) {});
    ASSERT_EQ(report.hardCases.size(), 2u);
    EXPECT_EQ(report.hardCases[0].status, HardResult::Status::Pass);
    EXPECT_EQ(report.hardCases[1].status, HardResult::Status::Refused);
    EXPECT_NE(report.hardCases[1].message.find("texel (5, 2) is nan"), std::string::npos);
}

} // namespace
} // namespace lucent::measure
