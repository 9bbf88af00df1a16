#include "measure/Metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lucent::measure {
namespace {

Image imageOf(int width, int height, int channels, std::vector<float> pixels) {
    Image image(width, height, channels);
    image.pixels = std::move(pixels);
    return image;
}

TEST(Metrics, AreThoseOfTheirDefinitions) {
    // Differences 0.5, 0, -1, 0.25 against 0.5, 1, 2, 0: all are exact in float.
    const Image reference = imageOf(2, 2, 1, {0.5f, 1, 2, 0});
    const Image image = imageOf(2, 2, 1, {1, 1, 1, 0.25f});
    const auto metrics = compare(image, "a", reference, "b");
    ASSERT_TRUE(metrics.ok());
    const double mse = (0.25 + 0 + 1 + 0.0625) / 4;
    EXPECT_DOUBLE_EQ(metrics->rmse, std::sqrt(mse));
    EXPECT_DOUBLE_EQ(metrics->relRmse, std::sqrt(mse) / 0.875); // the reference's mean is 3.5 / 4
    EXPECT_DOUBLE_EQ(metrics->relMse, (0.25 / 0.26 + 0 + 1 / 4.01 + 0.0625 / 0.01) / 4);
    EXPECT_DOUBLE_EQ(metrics->mae, 1.75 / 4);
    EXPECT_DOUBLE_EQ(metrics->p50, 0.25); // of 0, 0.25, 0.5, 1 the second: half is two
    EXPECT_DOUBLE_EQ(metrics->p90, 1);    // 90 % is more than three
    EXPECT_DOUBLE_EQ(metrics->p99, 1);    // of four values the fourth: 99 % is more than three
    EXPECT_DOUBLE_EQ(metrics->maximum, 1);
    EXPECT_EQ(metrics->maximumAt, ivec2(0, 1));
    EXPECT_NEAR(metrics->psnr, 10 * std::log10(1 / mse), 1e-12);
    EXPECT_DOUBLE_EQ(metrics->bias, -0.25 / 4);
    EXPECT_DOUBLE_EQ(metrics->fluxRatio, 3.25 / 3.5);
}

TEST(Metrics, OfDirectionsThatPointBelowZeroAreNoShares) {
    const auto metrics =
        compare(imageOf(2, 1, 1, {-1, 0.5f}), "a", imageOf(2, 1, 1, {-1, 0.25f}), "b"); // mean -0.375
    ASSERT_TRUE(metrics.ok());
    EXPECT_DOUBLE_EQ(metrics->rmse, 0.25 / std::sqrt(2.0));
    EXPECT_TRUE(std::isnan(metrics->relRmse));
    EXPECT_TRUE(std::isnan(metrics->fluxRatio));
}

TEST(Metrics, LookAtRedGreenBlueAndNotAtAlpha) {
    const auto metrics = compare(imageOf(1, 1, 4, {0, 3, 0, 9}), "a", imageOf(1, 1, 3, {0, 0, 0}), "b");
    ASSERT_TRUE(metrics.ok());
    EXPECT_DOUBLE_EQ(metrics->rmse, std::sqrt(3.0)); // 9 over three channels
    EXPECT_TRUE(std::isnan(metrics->fluxRatio));     // nothing to be a share of
}

TEST(Metrics, EqualPicturesHaveNoErrorAndInfinitePsnr) {
    const Image image = imageOf(1, 2, 1, {0.25f, 4});
    const auto metrics = compare(image, "a", image, "a");
    ASSERT_TRUE(metrics.ok());
    EXPECT_EQ(metrics->rmse, 0);
    EXPECT_EQ(metrics->maximum, 0);
    EXPECT_EQ(metrics->fluxRatio, 1);
    EXPECT_EQ(metrics->psnr, std::numeric_limits<double>::infinity());
}

TEST(Metrics, NinetyNinePercentAreNotAboveP99) {
    // 200 values, two of them wrong by 5 and one by 3: 198 of 200 are 99 %, so the 198th in order counts: 3.
    Image image(200, 1, 1);
    image.pixels[7] = image.pixels[90] = 5;
    image.pixels[3] = 3;
    const auto metrics = compare(image, "a", Image(200, 1, 1), "b");
    ASSERT_TRUE(metrics.ok());
    EXPECT_EQ(metrics->p99, 3);
    EXPECT_EQ(metrics->maximumAt, ivec2(7, 0));
}

TEST(Metrics, APercentileIsTheSmallestValueThatItsShareIsNotAbove) {
    std::vector<double> values;
    for (int i = 1; i <= 10; ++i)
        values.push_back((i * 7) % 11); // 1 to 10 in another order
    EXPECT_EQ(percentile(values, 0.5), 5);
    EXPECT_EQ(percentile(values, 0.9), 9);
    EXPECT_EQ(percentile(values, 0.91), 10);
    EXPECT_EQ(percentile(values, 1), 10);
    EXPECT_EQ(percentile(values, 1e-9), 1);
}

TEST(Metrics, OnlyCoveredPixelsCount) {
    // Alpha 0 hides a difference of 9; what is left is 3 against 1 and 1 against 1.
    const Image image = imageOf(3, 1, 4, {3, 3, 3, 1, 1, 1, 1, 0.5f, 9, 9, 9, 0});
    const Image reference = imageOf(3, 1, 3, {1, 1, 1, 1, 1, 1, 0, 0, 0});
    const auto metrics = compare(image, "a", reference, "b", &image);
    ASSERT_TRUE(metrics.ok());
    EXPECT_DOUBLE_EQ(metrics->rmse, std::sqrt(4.0 / 2));
    EXPECT_DOUBLE_EQ(metrics->relRmse, std::sqrt(4.0 / 2)); // the mean of what counts is 1
    EXPECT_EQ(metrics->maximum, 2);
    const Image none(3, 1, 1);
    const auto nothing = compare(image, "a.exr", reference, "b", &none);
    ASSERT_FALSE(nothing.ok());
    EXPECT_EQ(nothing.error().message, "a.exr: no pixel is covered; at least one must be");
}

TEST(Metrics, SsimAndFlipAreThereOnlyWhenAskedFor) {
    Image image(12, 12, 1);
    auto metrics = compare(image, "a", image, "b");
    ASSERT_TRUE(metrics.ok());
    EXPECT_FALSE(metrics->ssim || metrics->flip);
    addPerceptual(*metrics, image, image);
    EXPECT_EQ(metrics->ssim, 1);
    EXPECT_EQ(metrics->flip, 0);
}

TEST(Metrics, DifferentSizesAndChannelsAreRefused) {
    const auto sizes = compare(Image(2, 3, 1), "a.png", Image(3, 2, 1), "b.pfm");
    ASSERT_FALSE(sizes.ok());
    EXPECT_EQ(sizes.error().message,
              "a.png: has 2x3 pixels with 1 colour channel; must have 3x2 pixels with 1 "
              "colour channel like b.pfm");
    const auto channels = compare(Image(2, 3, 4), "a.png", Image(2, 3, 1), "b.pfm");
    ASSERT_FALSE(channels.ok());
    EXPECT_EQ(channels.error().message,
              "a.png: has 2x3 pixels with 3 colour channels; must have 2x3 pixels with 1 "
              "colour channel like b.pfm");
}

TEST(Metrics, ValuesThatAreNotFiniteAreCountedAndRefused) {
    Image image(3, 2, 1);
    *image.at(1, 1) = std::numeric_limits<float>::quiet_NaN();
    *image.at(2, 1) = std::numeric_limits<float>::infinity();
    const auto metrics = compare(Image(3, 2, 1), "a.pfm", image, "b.pfm");
    ASSERT_FALSE(metrics.ok());
    EXPECT_EQ(metrics.error().message,
              "b.pfm: 2 values are NaN or infinite, the first at pixel (1, 1); must be finite");
}

TEST(HeatMap, IsBlackForNoErrorAndEachStepIsLighter) {
    EXPECT_EQ(heatColor(0), dvec3(0));
    double last = 0;
    for (int i = 1; i <= 256; ++i) {
        const double luminance = glm::dot(heatColor(i / 256.0), dvec3(0.2126, 0.7152, 0.0722));
        EXPECT_GT(luminance, last) << "step " << i;
        last = luminance;
    }
    EXPECT_GT(last, 0.8);
    EXPECT_EQ(heatColor(7), heatColor(1));
}

TEST(HeatMap, ShowsTheLargestChannelOfEachPixel) {
    const Image map = heatMap(imageOf(2, 1, 3, {0, 0, 0, 0.1f, -0.5f, 0}), Image(2, 1, 3), 1);
    const dvec3 half = heatColor(0.5);
    for (int channel = 0; channel < 3; ++channel) {
        EXPECT_EQ(map.at(0, 0)[channel], 0);
        EXPECT_EQ(map.at(1, 0)[channel], srgbFromLinear(float(half[channel])));
    }
}

TEST(Flux, InAnotherCellIsMisplacedOnceAndOutsideOfEveryCircle) {
    Image reference(10, 5, 4), image(10, 5, 4), errors(10, 5, 3);
    for (int channel = 0; channel < 3; ++channel) {
        reference.at(2, 2)[channel] = 1;
        image.at(7, 2)[channel] = 1;
        errors.at(2, 2)[channel] = 0.1f;
    }
    const FluxErrors apart = compareFlux(image, reference, errors);
    EXPECT_DOUBLE_EQ(apart.misplaced, 1);
    EXPECT_DOUBLE_EQ(apart.encircled, 1);
    // Half the mean of |x|, with x Gaussian and its deviation 0.3 of a flux of 3.
    EXPECT_NEAR(apart.byNoise, 0.5 * 0.1 * std::sqrt(2 / 3.14159265), 1e-6);
    Image beside(10, 5, 4); // within the same cell of 5 x 5 pixels
    for (int channel = 0; channel < 3; ++channel)
        beside.at(4, 4)[channel] = 1;
    EXPECT_DOUBLE_EQ(compareFlux(beside, reference, errors).misplaced, 0);
    EXPECT_DOUBLE_EQ(compareFlux(beside, reference, errors, 1).misplaced, 1);
}

} // namespace
} // namespace lucent::measure
