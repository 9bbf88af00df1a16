#include "base/Log.h"
#include "base/Math.h"
#include "base/Text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lucent {
namespace {

TEST(Text, ShortestFormReadsBackToTheSameFloat) {
    EXPECT_EQ(shortest(0.1f), "0.1");
    EXPECT_EQ(shortest(1.0f / 3), "0.33333334");
    EXPECT_EQ(shortest(16777216.0f), "16777216");
    EXPECT_EQ(shortest(-0.0f), "0");
    EXPECT_EQ(shortest(0.1), "0.1");
    EXPECT_EQ(shortest(1.0 / 3), "0.3333333333333333");
    for (float value = 1e-30f; value < 1e30f; value *= 1.7f)
        EXPECT_EQ(std::strtof(shortest(value).c_str(), nullptr), value);
}

TEST(Text, NearestWordNeedsTheFewestEdits) {
    const std::string_view words[] = {"base", "diffuse", "specular", "specularity"};
    EXPECT_EQ(nearest("specularty", words), "specularity");
    EXPECT_EQ(nearest("difuse", words), "diffuse");
    EXPECT_EQ(nearest("x", {}), "");
}

TEST(Text, ANumberIsAllOfItsText) {
    EXPECT_EQ(numberIn("-1.5e2"), -150);
    for (const char* text : {"", " 1", "1 ", "1,5", "0.5m", "inf", "nan"})
        EXPECT_EQ(numberIn(text), std::nullopt) << text;
}

TEST(Text, QuotesEscapeWhatJsonDoesNotAllow) {
    EXPECT_EQ(inQuotes("a\"b\\c\nd\x01 \xc3\xa9"), "\"a\\\"b\\\\c\\nd\\u0001 \xc3\xa9\"");
}

TEST(Log, WarningsAreSaidOnce) {
    testing::internal::CaptureStderr();
    warnOnce("the light is dim");
    warnOnce("the light is dim");
    logInfo("done");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "warning: the light is dim\ndone\n");
}

TEST(Math, RotationTurnsAboutFixedAxesXFirst) {
    // About x by 90: y -> z. Then about y by 90: z -> x. Were y turned first, y would end at z.
    const vec3 turned = rotationFromDegrees({90, 90, 0}) * vec3(0, 1, 0);
    EXPECT_NEAR(glm::distance(turned, vec3(1, 0, 0)), 0, 1e-6);
    // About z by 90: x -> y.
    EXPECT_NEAR(glm::distance(rotationFromDegrees({0, 0, 90}) * vec3(1, 0, 0), vec3(0, 1, 0)), 0, 1e-6);
}

} // namespace
} // namespace lucent
