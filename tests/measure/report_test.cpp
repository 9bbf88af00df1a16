#include "measure/BenchReport.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace lucent::measure {
namespace {

TEST(Statistics, MedianAndExtremesOfRepeatedTimes) {
    const Spread spread = spreadOf({5, 1, 9, 3, 4});
    EXPECT_EQ(spread.median, 4);
    EXPECT_EQ(spread.low, 1);
    EXPECT_EQ(spread.high, 9);
    EXPECT_EQ(spread.repeats, 5);
    EXPECT_EQ(spreadOf({1, 2}).median, 2);
}

TEST(Statistics, ExponentOfAPowerLawIsFound) {
    std::vector<dvec2> points;
    for (double x : {64.0, 256.0, 1000.0, 4096.0})
        points.push_back({x, 3e-4 * std::pow(x, 1.25)});
    EXPECT_NEAR(fittedExponent(points), 1.25, 1e-12);
}

TEST(Statistics, ExponentIsThatOfLeastSquaresInLogarithms) {
    // Logarithms to base 2: (0, 0), (1, 2), (2, 1): slope sum (x - 1)(y - 1) / sum (x - 1)^2 = 1 / 2.
    const std::vector<dvec2> points{{1, 1}, {2, 4}, {4, 2}};
    EXPECT_NEAR(fittedExponent(points), 0.5, 1e-12);
    EXPECT_TRUE(std::isnan(fittedExponent(std::vector<dvec2>{{2, 3}, {2, 4}})));
}

TEST(Statistics, OnTheParetoFrontAreThoseThatNothingBeats) {
    // (3, 3) loses to (2, 2); (2, 5) loses to (2, 2) by y alone; of two equal points both stay.
    const std::vector<dvec2> points{{1, 4}, {2, 2}, {3, 3}, {2, 5}, {5, 1}, {1, 4}};
    EXPECT_EQ(paretoFront(points), (std::vector<bool>{true, true, false, false, true, true}));
}

Measurement measurement(const std::string& scene, double ms, double rmse) {
    Measurement m;
    m.technique = "relief";
    m.scene = scene;
    m.method = "march";
    m.size = {8, 4};
    m.ms = Spread{ms, ms / 2, ms * 2, 3};
    m.error.emplace().rmse = rmse;
    return m;
}

TEST(BenchReport, ParetoFrontsAreThoseOfOneSceneEach) {
    BenchReport report;
    report.measurements = {measurement("a", 1, 4), measurement("a", 2, 5), measurement("b", 9, 9)};
    report.measurements.push_back({}); // refused: neither time nor error
    report.markParetoFronts();
    EXPECT_TRUE(report.measurements[0].pareto);
    EXPECT_FALSE(report.measurements[1].pareto);
    EXPECT_TRUE(report.measurements[2].pareto);
    EXPECT_FALSE(report.measurements[3].pareto);
}

TEST(BenchReport, JsonHoldsWhatWasFoundAndLeavesOutWhatIsNotKnown) {
    BenchReport report;
    report.commit = "abc\"1";
    report.machine.driver = "llvmpipe";
    report.timing = "finished-frame";
    report.measurements = {measurement("a", 1, 4), {}};
    report.measurements[0].knobs = {{"steps", "256"}, {"sampling", "equal"}};
    report.measurements[0].bytes = std::size_t(5) << 30; // more than an int holds
    report.measurements[1].refused = "relief: cannot";
    report.scaling.push_back({"relief", "march", "texels", {{1, 2}, {4, 8}}});
    report.hardCases = {{"cliff", "march", HardResult::Status::Error, 0.25, ""},
                        {"NaN", "march", HardResult::Status::Refused, 0, "texel (1, 1)"}};
    report.ratios = {{"speed", 9, 10, true}, {"memory", 9, 10, false}, {"free", 1, {}, true}};

    const auto json = nlohmann::json::parse(report.json(), nullptr, false);
    ASSERT_FALSE(json.is_discarded()) << report.json();
    EXPECT_EQ(json["format"], "lucent-bench-1");
    EXPECT_EQ(json["commit"], "abc\"1");
    EXPECT_FALSE(json["machine"].contains("cpu"));
    EXPECT_FALSE(json.contains("memory"));
    const auto& first = json["measurements"][0];
    EXPECT_EQ(first["knobs"]["steps"], 256);
    EXPECT_EQ(first["knobs"]["sampling"], "equal");
    EXPECT_EQ(first["bytes"], 5368709120.0);
    EXPECT_EQ(first["ms"]["median"], 1);
    EXPECT_EQ(first["error"]["rmse"], 4);
    EXPECT_FALSE(first["error"].contains("ssim"));
    EXPECT_FALSE(first.contains("modelError") || first.contains("bakeMs") || first.contains("refused"));
    const auto& refused = json["measurements"][1];
    EXPECT_EQ(refused["refused"], "relief: cannot");
    EXPECT_FALSE(refused.contains("ms") || refused.contains("error") || refused.contains("pareto"));
    EXPECT_NEAR(double(json["scaling"][0]["exponent"]), 1, 1e-12);
    EXPECT_EQ(json["hardCases"][0]["status"], "error");
    EXPECT_EQ(json["hardCases"][1]["message"], "texel (1, 1)");
    EXPECT_EQ(json["ratios"][0]["met"], false); // 9 is not at least 10
    EXPECT_EQ(json["ratios"][1]["met"], true);  // 9 is at most 10
    EXPECT_FALSE(json["ratios"][2].contains("met"));
}

} // namespace
} // namespace lucent::measure
