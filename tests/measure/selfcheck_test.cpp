// The tables of the self-check: they pass here, they fail where something is wrong, and they survive a poor
// device.
#include "frame/Renderer.h"
#include "measure/SelfCheck.h"
#include "technique/Technique.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <set>

namespace lucent::measure {
namespace {

// A context for each test: those without some extension must not stand beside another.
struct Checks : testing::Test {
    std::unique_ptr<gl::Context> context;

    void SetUp() override { open({}); }
    void TearDown() override {
        if (!context) return;
        EXPECT_EQ(context->takeError(), "");
    }
    void open(std::span<const std::string_view> without) {
        auto made = gl::Context::create(without);
        if (made) {
            context = std::move(*made);
            return;
        }
        if (std::getenv("LUCENT_REQUIRE_GL")) FAIL() << made.error().message;
        GTEST_SKIP() << made.error().message;
    }
    std::map<std::string_view, Capability> capabilities() {
        Capabilities all(*context);
        while (all.step()) {
        }
        std::map<std::string_view, Capability> rows;
        for (const Capability& row : all.rows())
            rows.emplace(row.name, row);
        return rows;
    }
};

TEST_F(Checks, EveryClosedFormHoldsHereAndNoneAcceptsAValueTwiceItsToleranceAway) {
    SelfCheck check(*context);
    while (check.step()) {
    }
    ASSERT_EQ(check.results().size(), closedForms().size());
    EXPECT_TRUE(check.passed());
    EXPECT_EQ(check.progress(), 1);
    for (CheckResult one : check.results()) {
        EXPECT_TRUE(one.passed()) << one.check.name << ": expected " << one.expected << ", found "
                                  << one.found << " " << one.message;
        // The smallest number stands for "away" where nothing may be.
        const double away = std::max(2 * one.check.tolerance.value, 1e-9);
        for (const double found :
             {one.expected + away, one.expected - away, std::numeric_limits<double>::quiet_NaN(),
              std::numeric_limits<double>::infinity()}) {
            one.found = found;
            EXPECT_FALSE(one.passed()) << one.check.name << " with " << found;
        }
    }
}

TEST_F(Checks, AWrongFormulaFailsAndSoDoesTheWholeTable) {
    // The thesis prints d = r / t, which is 2 where the elevation is 30 degrees; d is 1 / 2.
    Check printed = closedForms()[2];
    ASSERT_EQ(printed.name, "Level field, light at 30 degrees");
    printed.measure = [](Studio& studio) {
        Finding finding;
        finding.take(2, closedForms()[2].measure(studio).found());
        return finding;
    };
    const Check table[] = {closedForms()[2], printed};
    SelfCheck check(*context, table);
    while (check.step()) {
    }
    ASSERT_EQ(check.results().size(), 2u);
    EXPECT_TRUE(check.results()[0].passed());
    EXPECT_FALSE(check.results()[1].passed());
    EXPECT_NEAR(check.results()[1].found, 0.5, 1e-5);
    EXPECT_FALSE(check.passed());
    EXPECT_NE(check.json().find("\"passed\": false"), std::string::npos);
}

TEST_F(Checks, AnUnfinishedTableHasNotPassed) {
    SelfCheck check(*context);
    EXPECT_FALSE(check.passed());
    EXPECT_EQ(check.progress(), 0);
    ASSERT_TRUE(check.step());
    EXPECT_FALSE(check.passed());
    EXPECT_GT(check.progress(), 0);
}

TEST_F(Checks, APictureThatCannotBeDrawnFailsWithTheMessage) {
    const Check table[] = {{"too large", "", {1, ""}, [](Studio& studio) {
                                scene::Scene scene;
                                scene.size = {4, 4};
                                scene::Object object;
                                object.field().heights = std::make_shared<Image>(1 << 20, 1, 1);
                                scene.objects.push_back(std::move(object));
                                technique::addSettings(scene);
                                Finding finding;
                                finding.take(0, studio.draw(scene).pixels[0]);
                                return finding;
                            }}};
    SelfCheck check(*context, table);
    check.step();
    ASSERT_EQ(check.results().size(), 1u);
    EXPECT_FALSE(check.results()[0].passed());
    EXPECT_NE(check.results()[0].message.find("too large for this GPU"), std::string::npos)
        << check.results()[0].message;
}

TEST(Finding, KeepsTheValueFarthestFromItsOwn) {
    Finding finding;
    finding.take(1, 1.5);
    finding.take(2, 1);
    finding.take(3, 3.25);
    EXPECT_EQ(finding.expected(), 2);
    EXPECT_EQ(finding.found(), 1);
    finding.take(5, std::numeric_limits<double>::quiet_NaN());
    finding.take(0, 100);
    EXPECT_EQ(finding.expected(), 5);
    EXPECT_TRUE(std::isnan(finding.found()));
}

TEST(ClosedForms, EachLineHasANameOfItsOwnAndAReason) {
    std::set<std::string_view> names;
    for (const Check& one : closedForms()) {
        EXPECT_TRUE(names.insert(one.name).second) << one.name;
        EXPECT_FALSE(one.meaning.empty()) << one.name;
        EXPECT_FALSE(one.tolerance.reason.empty()) << one.name;
        EXPECT_GE(one.tolerance.value, 0) << one.name;
    }
}

// --- capabilities

TEST_F(Checks, StoresLoseWhatTheirFormatsMustLose) {
    const auto rows = capabilities();
    EXPECT_EQ(rows.at("Draw into 32-bit floats").measured, 0); // 17 digits go into 24
    // 11 digits of 17: rounded 2^-11 at most, cut off 2^-10; less than a quarter of that would be no half.
    EXPECT_LE(rows.at("Draw into 16-bit floats").measured, 0x1p-10);
    EXPECT_GE(rows.at("Draw into 16-bit floats").measured, 0x1p-12);
    EXPECT_EQ(rows.at("High precision in shaders").measured, 0x1p-23);
    EXPECT_EQ(rows.at("High precision in shaders").amount, "23 bits");
}

TEST_F(Checks, FilteringAndBlendingAreCloseToWhatShadersDo) {
    const auto rows = capabilities();
    // GPUs have 8 binary digits between two texels: half of the last is 1/512.
    EXPECT_LE(rows.at("Filter 16-bit floats").measured, 1.0 / 512 + 1e-3);
    if (context->caps().floatLinear) {
        EXPECT_LE(rows.at("Filter 32-bit floats").measured, 1.0 / 512 + 1e-6);
    }
    // 64 additions, each rounded to 2^-24 of the sum.
    if (context->caps().floatBlend) {
        EXPECT_LE(rows.at("Blend 32-bit floats").measured, 64 * 0x1p-24);
    }
}

TEST_F(Checks, ATimerQueryTellsAShareOfTheRealTime) {
    if (!context->caps().timerQuery) return; // the masked test covers this
    const double share = capabilities().at("Timer queries").measured;
    EXPECT_GE(share, 0);
    EXPECT_LE(share, 1.05); // the query lies inside; clocks tick apart
}

struct Without : Checks, testing::WithParamInterface<std::pair<std::string_view, std::string_view>> {
    void SetUp() override { open({&GetParam().first, 1}); }
};
INSTANTIATE_TEST_SUITE_P(SelfCheck, Without,
                         testing::Values(std::pair{"EXT_float_blend", "Blend 32-bit floats"},
                                         std::pair{"OES_texture_float_linear", "Filter 32-bit floats"},
                                         std::pair{"EXT_disjoint_timer_query", "Timer queries"}));

TEST_P(Without, AnExtensionAllFormsHoldAndItsLineSaysNo) {
    SelfCheck check(*context);
    while (check.step()) {
    }
    EXPECT_TRUE(check.passed());
    for (const Capability& row : check.capabilities()) {
        if (row.name != GetParam().second) continue;
        EXPECT_FALSE(row.present);
        EXPECT_TRUE(std::isnan(row.measured));
    }
}

TEST_F(Checks, BlendingTellsOfEachTechniqueThatAddsLightUp) {
    const Capability row = capabilities().at("Blend 32-bit floats");
    // caustics/LightPasses.h, views/Voxels.cpp, subsurface/Splatting.cpp: all that ask for floatBlend.
    for (const char* word : {"caustic maps", "voxels", "subsurface"}) {
        EXPECT_NE(row.use.find(word), std::string_view::npos) << word;
        EXPECT_NE(row.fallback.find(word), std::string_view::npos) << word;
    }
}

TEST(WithoutFloatTargets, ThereIsAMessageAndNoContext) {
    const std::string_view without[] = {"EXT_color_buffer_float"};
    const auto poor = gl::Context::create(without);
    ASSERT_FALSE(poor.ok());
    EXPECT_EQ(poor.error().fault, Fault::Machine);
    // Without any GL the message is another one; whether that may be is for the other tests here to say.
    if (poor.error().message.starts_with("gl:")) GTEST_SKIP() << poor.error().message;
    EXPECT_NE(poor.error().message.find("EXT_color_buffer_float missing"), std::string::npos);
    EXPECT_NE(poor.error().message.find("layers of glass"), std::string::npos);
}

} // namespace
} // namespace lucent::measure
