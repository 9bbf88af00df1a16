// The benchmark of subsurface scattering: its exact solutions, cases and promises.
#include "measure/SubsurfaceTruth.h"
#include "techniques/subsurface/bench/Bench.h"
#include "tests/support/Bench.h"
#include "tests/support/Gl.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace lucent::subsurface {
namespace {

using namespace measure;
using SubsurfaceBench = support::GlTest;

TEST(SubsurfaceTruth, AHalfSpaceOfMarbleIsAsBrightAsTheClosedFormSays) {
    scene::Material stone = marble();
    const dvec3 leaving = radiosityOfHalfSpace(stone);
    // Jensen et al. 2001 with Egan and Hilgeman's factor, of light that has entered; 4 % are mirrored.
    EXPECT_NEAR(leaving.r / 0.96, 0.8302, 5e-5); // four digits
    EXPECT_NEAR(leaving.g / 0.96, 0.7910, 5e-5);
    EXPECT_NEAR(leaving.b / 0.96, 0.7526, 5e-5);
    stone.translucent().anisotropy = 0.5f; // what counts is (1 - g) sigma_s
    stone.translucent().scattering *= 2.0f;
    EXPECT_NEAR(radiosityOfHalfSpace(stone).g, leaving.g, 1e-6);
}

TEST(SubsurfaceTruth, ABallIsSolvedByAngleAsItIsPixelByPixel) {
    const scene::Scene scene = marbleBall(8);
    ASSERT_TRUE(litBallOf(scene).has_value());
    const auto byAngle = solveSubsurface(scene, {}, 1);
    ASSERT_TRUE(byAngle.ok()) << byAngle.error().message;
    const auto model = truth::DipoleEstimator::create(scene, scene.size, dipoleOptionsOf(scene));
    ASSERT_TRUE(model.ok());
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x) {
            const truth::Pixel pixel = model->solve({x, y});
            EXPECT_EQ(byAngle->values.at(x, y)[3], float(pixel.coverage));
            for (int c = 0; c < 3; ++c) // five standard errors, and 1e-3 for what is linear between angles
                EXPECT_NEAR(double(byAngle->values.at(x, y)[c]), pixel.value[c],
                            5 * std::sqrt(pixel.variance[c]) + 1e-3 * pixel.value[c]);
        }
    scene::Scene two = scene;
    two.lights.push_back(two.lights.front());
    EXPECT_FALSE(litBallOf(two).has_value());
}

TEST(Subsurface, HasEveryBodyAndPromise) {
    const measure::Plan plan = support::planOf("subsurface", false, support::RoundBunny());
    std::set<std::string> names;
    for (const Case& one : plan.cases)
        names.insert(one.name);
    EXPECT_EQ(names, (std::set<std::string>{"ball", "ball, offset", "ball, burley", "half space",
                                            "painted ball", "bunny"}));
    // From a report in which everything is just missed.
    BenchReport report;
    for (const Case& one : plan.cases)
        for (const Setting& setting : one.settings) {
            Measurement m;
            m.technique = "subsurface";
            m.scene = one.name;
            m.method = setting.method;
            m.knobs = setting.knobs;
            m.ms = Spread{setting.method == "splat" ? 7.9 : 1, 1, 1, 1};
            m.error.emplace().flux = FluxErrors{.misplaced = 0.021};
            report.measurements.push_back(m);
        }
    for (const Series& series : plan.series)
        report.scaling.push_back(
            {series.technique, series.name(), series.over, {{1, 1}, {2, 1.2}, {3, 1.3}}});
    EXPECT_EQ(support::countMissed(plan, report),
              5 + 3 + 1); // misplaced light on each body, speed on each ball, the growth of the splats' stage
}

TEST_F(SubsurfaceBench, MeasuresABallAndTheStagesOfAMesh) {
    measure::Plan plan = support::planOf("subsurface", true);
    plan.repeats = {1, 1, 0};
    plan.cases.resize(1);
    plan.truthParts = 1;
    ASSERT_EQ(plan.hard.size(), 1u);
    HardTable& hardTable = plan.hard.front(); // all of it takes half a minute
    std::erase_if(hardTable.cases, [](const HardCase& hard) { return hard.name != "index 1"; });
    hardTable.settings.resize(1);
    plan.cases[0].toPhysics = {}; // walks take seconds
    std::erase_if(plan.cases[0].settings, [](const Setting& setting) {
        return setting.isPhysics ||
               setting.knobs.front() != std::pair<std::string, std::string>("epsilon", "0.01");
    });
    ASSERT_EQ(plan.cases[0].settings.size(), 2u);
    plan.cases[0].scene.make = [scene = marbleBall(32)]() -> Result<scene::Scene> { return scene; };
    std::erase_if(plan.series, [](const Series& series) { return series.over != "triangles"; });
    for (Series& series : plan.series)
        series.points.resize(1);
    const BenchReport report = sweep(*context, plan, support::solveHere, [](const std::string&) {});
    ASSERT_EQ(report.measurements.size(), 2u);
    for (const Measurement& m : report.measurements) {
        EXPECT_EQ(m.refused, "");
        ASSERT_TRUE(m.error && m.error->flux);
        EXPECT_LT(m.error->flux->misplaced, 0.02);
        EXPECT_NEAR(m.error->fluxRatio, 1, 0.02);
    }
    ASSERT_EQ(report.hardCases.size(), 1u);
    for (const HardResult& hard : report.hardCases)
        EXPECT_EQ(hard.status, HardResult::Status::Pass)
            << hard.name << " by " << hard.method << ": " << hard.error << " " << hard.message;
    ASSERT_EQ(report.scaling.size(), 2u);
    for (const ScalingSeries& series : report.scaling)
        EXPECT_EQ(series.points.size(), 1u) << series.method;
    EXPECT_TRUE(std::any_of(report.ratios.begin(), report.ratios.end(),
                            [](const Ratio& ratio) { return ratio.target == 8; }));
}

} // namespace
} // namespace lucent::subsurface
