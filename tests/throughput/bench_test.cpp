// The benchmark of precomputed throughput: its bodies, its promises and its table of stages.
#include "measure/Solve.h"
#include "techniques/throughput/bench/Bench.h"
#include "tests/support/Bench.h"
#include "tests/support/Gl.h"

#include <cmath>
#include <set>

namespace lucent::throughput {
namespace {

using namespace measure;
using ThroughputBench = support::GlTest;

TEST(Throughput, HasEveryBodyAndPromise) {
    const measure::Plan plan = support::planOf("throughput", false, support::RoundBunny());
    std::set<std::string> names;
    for (const Case& one : plan.cases)
        names.insert(one.name);
    EXPECT_EQ(names, (std::set<std::string>{"baked ball", "baked bunny"}));
    BenchReport report; // in which everything is just missed
    for (const Case& one : plan.cases) {
        for (const Setting& setting : one.settings) {
            Measurement m;
            m.technique = "throughput";
            m.scene = one.name;
            m.method = setting.method;
            m.knobs = setting.knobs;
            m.ms = Spread{1, 1, 1, 1};
            m.error.emplace().flux = FluxErrors{.misplaced = 0.021};
            report.measurements.push_back(m);
        }
        const Result<scene::Scene> scene = one.scene.make();
        ASSERT_TRUE(scene);
        EXPECT_TRUE(bakes(scene->objects.front())) << one.name;
        EXPECT_EQ(one.settings.size(), 4u);
    }
    EXPECT_EQ(support::countMissed(plan, report), 4); // of two methods each
}

TEST_F(ThroughputBench, TellsStagesBytesAndWhenABakeHasPaid) {
    const BenchPart& part = *benchParts("throughput").front();
    const BenchAssets nothing;
    const SolveTruth solve = [](const scene::Scene& scene, int directions, const truth::Tile& part) {
        return solveWhatIsShown(scene, directions, part, 0);
    };
    const Say say = [](const std::string&) {};
    const Result<Proof> proof = part.prove({*context, nothing, solve, say, true});
    ASSERT_TRUE(proof) << proof.error().message;
    bool pays = false, grazed = false;
    for (const Ratio& ratio : proof->ratios) {
        EXPECT_TRUE(std::isfinite(ratio.value) && ratio.value > 0) << ratio.name;
        grazed = grazed || ratio.name.find("80 to 120 degrees") != std::string::npos;
        pays = pays || ratio.name.find("for its bake, which never pays") != std::string::npos ||
               ratio.name.find("pictures after which the bake has paid") != std::string::npos;
    }
    EXPECT_TRUE(pays && grazed);
}

} // namespace
} // namespace lucent::throughput
