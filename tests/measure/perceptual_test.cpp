#include "measure/Flip.h"
#include "measure/Ssim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

namespace lucent::measure {
namespace {

Image made(ivec2 size, int channels, const std::function<float(int, int, int)>& value) {
    Image image(size.x, size.y, channels);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            for (int c = 0; c < channels; ++c)
                image.at(x, y)[c] = value(x, y, c);
    return image;
}
Image even(float value) {
    return made({24, 20}, 1, [=](int, int, int) { return value; });
}
Image noise(unsigned seed, float scale = 1) {
    std::mt19937 random(seed);
    return made({24, 20}, 3, [&](int, int, int) { return scale * float(random() & 0xffff) / 65536.0f; });
}

// --- SSIM

TEST(Ssim, OfEqualPicturesIsOne) { EXPECT_DOUBLE_EQ(ssim(noise(1), noise(1)), 1); }

TEST(Ssim, OfEvenPicturesComparesTheirLuminanceAlone) {
    // Without variance the second factor is C2 / C2. C1 = (0.01 L)^2; L = 1, and 4 for a reference of 4.
    EXPECT_NEAR(ssim(even(0.5f), even(0.25f)), (2 * 0.5 * 0.25 + 1e-4) / (0.25 + 0.0625 + 1e-4), 1e-12);
    EXPECT_NEAR(ssim(even(2), even(4)), (2 * 2 * 4 + 16e-4) / (4 + 16 + 16e-4), 1e-12);
}

TEST(Ssim, OfOneWindowIsThatOfItsDefinition) {
    // 11 x 11 pixels hold one window; here its moments are sums over the two-dimensional Gaussian.
    const auto a = made({11, 11}, 1, [](int x, int y, int) { return float((x * 5 + y * 3) % 7) / 8; });
    const auto b = made({11, 11}, 1, [](int x, int y, int) { return float((x * 2 + y * 9) % 8) / 8; });
    double total = 0, ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
    for (int y = 0; y < 11; ++y) {
        for (int x = 0; x < 11; ++x) {
            const double w = std::exp(-((x - 5) * (x - 5) + (y - 5) * (y - 5)) / (2 * 1.5 * 1.5));
            const double u = *a.at(x, y), v = *b.at(x, y);
            total += w, ma += w * u, mb += w * v, aa += w * u * u, bb += w * v * v, ab += w * u * v;
        }
    }
    ma /= total, mb /= total;
    const double va = aa / total - ma * ma, vb = bb / total - mb * mb, cov = ab / total - ma * mb;
    const double wanted =
        (2 * ma * mb + 1e-4) * (2 * cov + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
    EXPECT_NEAR(ssim(a, b), wanted, 1e-12);
}

TEST(Ssim, OfPicturesSmallerThanItsWindowIsNoNumber) {
    EXPECT_TRUE(std::isnan(ssim(Image(10, 40, 1), Image(10, 40, 1))));
}

// --- FLIP

// The largest distance: green against blue in CIELAB (87.735, -86.183, 83.179) and (32.297, 79.188,
// -107.860), chroma times a hundredth of the lightness, city block for lightness, Euclid for chroma.
double largestDistance() {
    const double a = 0.87735 * -86.183 - 0.32297 * 79.188, b = 0.87735 * 83.179 + 0.32297 * 107.860;
    return 87.735 - 32.297 + std::hypot(a, b);
}
// Distances to the power 0.7; 0.4 of the largest is an error of 0.95, the rest goes on to 1.
double errorOf(double distance) {
    const double share = std::pow(distance / largestDistance(), 0.7);
    return share < 0.4 ? 0.95 * share / 0.4 : 0.95 + 0.05 * (share - 0.4) / 0.6;
}
double lightness(double luminance) { return 116 * std::cbrt(luminance) - 16; } // of CIELAB, above 0.009

TEST(Flip, OfEqualPicturesIsZero) {
    EXPECT_EQ(flip(noise(1), noise(1)).mean, 0);
    EXPECT_EQ(hdrFlip(noise(1, 9), noise(1, 9)).mean, 0);
}

TEST(Flip, OfEvenGreysIsTheirDistanceInLightness) {
    // Without edges nothing but colour counts. Rounding of the primaries above: 1e-5 of the largest distance.
    EXPECT_NEAR(flip(even(0), even(1)).mean, errorOf(100), 1e-4);
    EXPECT_NEAR(errorOf(100), 0.967, 1e-3);
    EXPECT_NEAR(flip(even(0.5f), even(0.25f)).mean, errorOf(lightness(0.5) - lightness(0.25)), 1e-4);
    for (const float error : flip(even(0.5f), even(0.25f)).map.pixels)
        EXPECT_NEAR(error, errorOf(lightness(0.5) - lightness(0.25)), 1e-4);
}

TEST(Flip, OfGreenAndBlueIsOne) {
    const auto green = made({24, 20}, 3, [](int, int, int c) { return c == 1 ? 1.0f : 0.0f; });
    const auto blue = made({24, 20}, 3, [](int, int, int c) { return c == 2 ? 1.0f : 0.0f; });
    EXPECT_NEAR(flip(green, blue).mean, 1, 1e-6);
}

TEST(Flip, AtAnEdgeIsRaisedByTheFeature) {
    // A picture that is white from column 40 on against black. At column 40 the edge filter, whose negative
    // weights sum to -1 and whose middle is 0, sees exactly its negative half: strength 1. (The point filter
    // sees less.) So the exponent is 1 - (1 / sqrt 2)^0.5. The lightness there is that of the blurred edge:
    // half the Gaussian of variance b / (2 pi^2), b = 0.0047, and half of its middle sample.
    const auto edge = made({80, 60}, 1, [](int x, int, int) { return x < 40 ? 0.0f : 1.0f; });
    const double step = 1 / defaultPixelsPerDegree(), pi = std::numbers::pi;
    double sum = 1;
    for (int i = 1; i <= 10; ++i)
        sum += 2 * std::exp(-pi * pi * i * i * step * step / 0.0047);
    const double color = errorOf(lightness(0.5 + 0.5 / sum));
    const Flip found = flip(edge, Image(80, 60, 1));
    EXPECT_NEAR(*found.map.at(40, 30), std::pow(color, 1 - std::sqrt(std::numbers::sqrt2 / 2)), 1e-4);
    EXPECT_EQ(*found.map.at(5, 30), 0);
    EXPECT_NEAR(*found.map.at(75, 30), errorOf(100), 1e-4);
}

TEST(Flip, IsSymmetricAndNeverAboveOne) {
    const Flip ab = flip(noise(1), noise(2)), ba = flip(noise(2), noise(1));
    EXPECT_GT(ab.mean, 0.1);
    for (std::size_t i = 0; i < ab.map.pixels.size(); ++i) {
        EXPECT_EQ(ab.map.pixels[i], ba.map.pixels[i]);
        EXPECT_LE(ab.map.pixels[i], 1);
    }
}

TEST(Flip, HasSixtySevenPixelsPerDegree) {
    EXPECT_NEAR(defaultPixelsPerDegree(), 67.02, 5e-3); // 3840 pixels at their own width's distance
}

TEST(HdrFlip, StartsWhereTheBrightestPixelComesOutAt85Percent) {
    // (0.9036 x^2 + 0.018 x) / (0.8748 x^2 + 0.354 x + 0.14) = 0.85: 0.16002 x^2 - 0.2829 x - 0.119 = 0.
    const double x = (0.2829 + std::sqrt(0.2829 * 0.2829 + 4 * 0.16002 * 0.119)) / (2 * 0.16002);
    const Flip found = hdrFlip(even(8), even(8));
    EXPECT_NEAR(found.start, std::log2(x / 8), 1e-6);
    EXPECT_NEAR(found.stop, std::log2(x / 8), 1e-6);
    EXPECT_EQ(found.exposures, 2);
    // One pixel of 64 among ones of 1/4: eight stops.
    const auto spot = made({24, 20}, 1, [](int i, int j, int) { return i == 7 && j == 7 ? 64.0f : 0.25f; });
    EXPECT_NEAR(hdrFlip(spot, spot).stop - hdrFlip(spot, spot).start, 8, 1e-6);
    EXPECT_EQ(hdrFlip(spot, spot).exposures, 8);
}

TEST(HdrFlip, DoesNotDependOnTheUnitOfLight) {
    const Flip one = hdrFlip(noise(1), noise(2)), thousand = hdrFlip(noise(1, 1024), noise(2, 1024));
    EXPECT_NEAR(one.mean, thousand.mean, 1e-9);
    EXPECT_NEAR(one.start - thousand.start, 10, 1e-9);
}

TEST(HdrFlip, SeesDifferencesThatTheDisplayClips) {
    EXPECT_EQ(flip(even(2), even(4)).mean, 0);
    EXPECT_GT(hdrFlip(even(2), even(4)).mean, 0.1);
}

TEST(HdrFlip, OfABlackReferenceIsThatOfOneExposure) {
    EXPECT_EQ(hdrFlip(even(0), even(0)).mean, 0);
    EXPECT_EQ(hdrFlip(even(1), even(0)).exposures, 1);
    EXPECT_GT(hdrFlip(even(1), even(0)).mean, 0.9);
}

} // namespace
} // namespace lucent::measure
