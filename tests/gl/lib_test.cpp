// shaders/lib compiled as C++: the very lines that the GPU runs, in float, against closed forms.
#include "base/Math.h"

#include <gtest/gtest.h>

#include <cmath>

namespace glsl {
using glm::clamp, glm::max, glm::min, glm::normalize, glm::vec2, glm::vec3;
using std::abs, std::exp, std::pow, std::sqrt;
#include "shaders/lib/fresnel.glsl"
#include "shaders/lib/octahedral.glsl"
#include "shaders/lib/quadratic.glsl"
#include "shaders/lib/shading.glsl"
} // namespace glsl

namespace {

TEST(Quadratic, RootsOfAProductAreItsZeros) {
    // (q - 1)(q - 3) = q^2 - 4 q + 3
    const auto roots = glsl::quadraticRoots(1, -4, 3);
    EXPECT_FLOAT_EQ(roots.x, 1);
    EXPECT_FLOAT_EQ(roots.y, 3);
}

TEST(Quadratic, KeepsTheSmallRootWhereTheSchoolFormulaLosesIt) {
    // q^2 - 1e4 q + 1: small root 1e-4 (1 + 1e-8 ...); the school formula gives 0 or 2.4e-4 in float.
    EXPECT_NEAR(glsl::quadraticRoots(1, -1e4f, 1).x, 1e-4f, 1e-10f);
}

TEST(Quadratic, PositivePartIsTheStretchBetweenOrOutsideTheRoots) {
    // -(q - 1)(q - 3): positive on (1, 3)
    EXPECT_FLOAT_EQ(glsl::positivePart(-1, 4, -3, 10).x, 2);
    EXPECT_FLOAT_EQ(glsl::positivePart(-1, 4, -3, 10).y, 1);
    EXPECT_FLOAT_EQ(glsl::positivePart(-1, 4, -3, 2).x, 1);
    // (q - 1)(q - 3): positive on (0, 1) and (3, 10)
    EXPECT_FLOAT_EQ(glsl::positivePart(1, -4, 3, 10).x, 8);
    EXPECT_FLOAT_EQ(glsl::positivePart(1, -4, 3, 10).y, 0);
}

TEST(Quadratic, LinesAndConstantsAreQuadraticsToo) {
    EXPECT_FLOAT_EQ(glsl::positivePart(0, 2, -1, 3).x, 2.5f); // 2 q - 1
    EXPECT_FLOAT_EQ(glsl::positivePart(0, 2, -1, 3).y, 0.5f);
    EXPECT_FLOAT_EQ(glsl::positivePart(0, -2, 1, 3).x, 0.5f); // 1 - 2 q
    EXPECT_FLOAT_EQ(glsl::positivePart(0, 0, 1, 3).x, 3);     // 1
    EXPECT_FLOAT_EQ(glsl::positivePart(0, 0, -1, 3).x, 0);    // -1
    EXPECT_FLOAT_EQ(glsl::positivePart(0, 0, 0, 3).x, 0);     // touching is not inside
    EXPECT_FLOAT_EQ(glsl::positivePart(2, 0, 0, 3).x, 3);     // 2 q^2 starts at 0
    EXPECT_FLOAT_EQ(glsl::positivePart(1, 0, 1, 3).x, 3);     // no root
    EXPECT_EQ(glsl::positivePart(-1, 0, -1, 3).y, 1e30f);     // never
}

TEST(Quadratic, AgreesWithSamplingOverManyCoefficients) {
    for (int seed = 0; seed < 500; ++seed) {
        const float a = std::sin(seed * 1.7f) * 3, b = std::sin(seed * 2.3f) * 3, c = std::sin(seed * 3.1f);
        int inside = 0;
        constexpr int kSamples = 4000;
        for (int i = 0; i < kSamples; ++i) {
            const double q = 2 * (i + 0.5) / kSamples;
            inside += (a * q + b) * q + c > 0;
        }
        // A sampled length is off by at most one step of 2 / 4000 at each of two roots.
        EXPECT_NEAR(glsl::positivePart(a, b, c, 2).x, 2.0 * inside / kSamples, 1e-3 + 1e-5) << seed;
    }
}

TEST(Octahedral, EveryDirectionComesBack) {
    // Two floats of up to 1 hold a direction to about their rounding, 6e-8, times a slope of at most 3.
    for (int i = 0; i < 2000; ++i) {
        const float y = 1 - (2 * float(i) + 1) / 2000, turn = 2.39996f * float(i);
        const float r = std::sqrt(1 - y * y);
        const lucent::vec3 n(r * std::cos(turn), y, r * std::sin(turn));
        const lucent::vec2 e = glsl::octahedralFrom(n);
        EXPECT_LE(std::max(std::abs(e.x), std::abs(e.y)), 1);
        EXPECT_LT(glm::distance(glsl::fromOctahedral(e), n), 3e-7f) << i;
    }
}

TEST(Octahedral, AxesAreExact) {
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f}) {
            lucent::vec3 n(0);
            n[axis] = side;
            EXPECT_EQ(glsl::fromOctahedral(glsl::octahedralFrom(n)), n);
        }
}

TEST(Fresnel, KnownAngles) {
    // Normal incidence: ((n1 - n2) / (n1 + n2))², the same from both sides; grazing: all.
    EXPECT_NEAR(glsl::fresnelReflectance(1, 1 / 1.5f), 0.04f, 1e-7);
    EXPECT_NEAR(glsl::fresnelReflectance(1, 1.5f), 0.04f, 1e-7);
    EXPECT_NEAR(glsl::fresnelReflectance(0, 1 / 1.5f), 1, 1e-6);
    // Brewster's angle, tan = 1.5: half of what is polarised across, (1.5² - 1)² / (1.5² + 1)² / 2.
    EXPECT_NEAR(glsl::fresnelReflectance(std::cos(std::atan(1.5f)), 1 / 1.5f),
                0.5 * 1.25 * 1.25 / (3.25 * 3.25), 1e-6);
    // Equal media: nothing, for any angle but 0, where the formula is 0 / 0 in the limit.
    for (const float cosine : {0.01f, 0.5f, 1.0f})
        EXPECT_NEAR(glsl::fresnelReflectance(cosine, 1), 0, 1e-6) << cosine;
}

TEST(Fresnel, BeyondTheCriticalAngleAllIsMirrored) {
    // sin = 1 / 1.5: cos = sqrt(1 - 4/9) = 0.74536.
    EXPECT_EQ(glsl::fresnelReflectance(0.7453f, 1.5f), 1);
    EXPECT_LT(glsl::fresnelReflectance(0.7455f, 1.5f), 0.95f);
    EXPECT_EQ(glsl::fresnelReflectance(0, 1.5f), 1);
}

TEST(Shading, EmptyFalloffRangeIsAStep) {
    EXPECT_EQ(glsl::falloff(0.49f, 0.5f, 0.5f), 0);
    EXPECT_EQ(glsl::falloff(0.50f, 0.5f, 0.5f), 1);
    EXPECT_FLOAT_EQ(glsl::falloff(0.5f, 0.25f, 0.75f), 0.5f);
    EXPECT_EQ(glsl::falloff(-1, 0, 1), 0);
    EXPECT_EQ(glsl::falloff(2, 0, 1), 1);
}

TEST(Shading, AttenuationIsOneUpToTheDepthAndMeetsItsSlope) {
    for (bool exponential : {false, true}) {
        EXPECT_EQ(glsl::attenuate(0, exponential), 1);
        EXPECT_EQ(glsl::attenuate(1, exponential), 1);
        // d/dx of 1 / x and of e^(1 - x) at 1 is -1
        EXPECT_NEAR((glsl::attenuate(1.001f, exponential) - 1) / 0.001f, -1, 2e-3);
    }
    EXPECT_FLOAT_EQ(glsl::attenuate(4, false), 0.25f);
    EXPECT_FLOAT_EQ(glsl::attenuate(3, true), std::exp(-2.0f));
}

TEST(Shading, SrgbCurveIsContinuousAndReachesWhite) {
    EXPECT_NEAR(glsl::srgbFromLinear(0.0031308f), 12.92f * 0.0031308f, 1e-6);
    EXPECT_NEAR(glsl::srgbFromLinear(0.00313081f), 12.92f * 0.0031308f, 1e-6);
    EXPECT_NEAR(glsl::srgbFromLinear(1), 1, 1e-6);
    EXPECT_NEAR(glsl::srgbFromLinear(0.214041f), 0.5f, 1e-5); // IEC 61966-2-1: code 0.5 is 0.21404 of white
}

} // namespace
