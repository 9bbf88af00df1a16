#include "scene/Mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace lucent::scene {
namespace {

// Slopes (to the right, upwards) of a surface at texel (x, y), y counted down.
using Slopes = std::function<dvec2(double x, double y)>;

Image normalMap(int width, int height, const Slopes& slopes) {
    Image map(width, height, 3);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const dvec2 s = slopes(x, y);
            const dvec3 n = glm::normalize(dvec3(-s.x, -s.y, 1));
            for (int c = 0; c < 3; ++c)
                map.at(x, y)[c] = float(0.5 + 0.5 * n[c]);
        }
    return map;
}

// Largest difference from an expected field after both means are taken away, over the expected range.
double relativeError(const Image& found, const std::function<double(double, double)>& expected) {
    double mean = 0, low = 1e300, high = -1e300;
    for (int y = 0; y < found.height; ++y)
        for (int x = 0; x < found.width; ++x) {
            mean += (*found.at(x, y) - expected(x, y)) / double(found.pixels.size());
            low = std::min(low, expected(x, y));
            high = std::max(high, expected(x, y));
        }
    double worst = 0;
    for (int y = 0; y < found.height; ++y)
        for (int x = 0; x < found.width; ++x)
            worst = std::max(worst, std::abs(*found.at(x, y) - expected(x, y) - mean));
    return worst / (high - low);
}

TEST(HeightsFromNormals, PlaneIsExact) {
    const Result<Image> heights =
        heightsFromNormals(normalMap(9, 5, [](double, double) { return dvec2(0.5, -0.25); }), "n");
    ASSERT_TRUE(heights) << heights.error().message;
    // Up in the picture is towards smaller y: z = 0.5 x + 0.25 y, lowest at the top left corner.
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 9; ++x)
            EXPECT_NEAR(*heights->at(x, y), 0.5 * x + 0.25 * y, 1e-5);
}

TEST(HeightsFromNormals, ParaboloidIsExact) {
    // z = x^2/100 + x y/50: the mean of two neighbours' slopes is the slope between them, so nothing is lost.
    const Slopes slopes = [](double x, double y) { return dvec2(x / 50 + y / 50, -x / 50); };
    const Result<Image> heights = heightsFromNormals(normalMap(40, 30, slopes), "n");
    ASSERT_TRUE(heights);
    EXPECT_LT(relativeError(*heights, [](double x, double y) { return x * x / 100 + x * y / 50; }), 2e-6);
}

TEST(HeightsFromNormals, WavesComeBackWithAnErrorOfSecondOrder) {
    // z = A sin(kx) cos(ky): the mean of two slopes a texel apart is (1 - k^2/8 + k^2/24) of what it should
    // be, so z is too small by k^2/12 of its amplitude. With 4 waves over N texels k = 8 pi / N.
    double before = 0;
    for (const int n : {64, 128, 256}) {
        const double k = 8 * M_PI / n, amplitude = 0.1 * n;
        const Slopes slopes = [&](double x, double y) {
            return amplitude * k *
                   dvec2(std::cos(k * x) * std::cos(k * y), std::sin(k * x) * std::sin(k * y));
        };
        const Result<Image> heights = heightsFromNormals(normalMap(n, n, slopes), "n");
        ASSERT_TRUE(heights);
        const double error = relativeError(
            *heights, [&](double x, double y) { return amplitude * std::sin(k * x) * std::cos(k * y); });
        EXPECT_LT(error, 1.2 * k * k / 12) << n; // measured 0.0123, 0.0031, 0.00078
        if (before > 0) {
            EXPECT_NEAR(before / error, 4, 0.4) << n;
        }
        before = error;
    }
}

TEST(HeightsFromNormals, ClosedLoopGivesTheSameHeightBothWays) {
    // A bump whose upper half was painted steeper by hand: its slopes are no gradient, sums along two paths
    // from corner to corner differ by more than 3, but the field has one height at each place and is
    // symmetric.
    const Slopes slopes = [](double x, double y) {
        const double dx = (x - 15.5) / 8, dy = (y - 15.5) / 8, g = std::exp(-dx * dx - dy * dy);
        return dvec2(-2 * dx * g, 2 * dy * g) * (y < 16 ? 2.0 : 1.0);
    };
    const Image map = normalMap(32, 32, slopes);
    const auto sumAlong =
        [&](bool rightFirst) { // the thesis's way: texel by texel along a path to the centre
            double z = 0;
            for (int i = 1; i <= 16; ++i)
                z += slopes(i - 0.5, rightFirst ? 0 : 16).x;
            for (int i = 1; i <= 16; ++i)
                z -= slopes(rightFirst ? 16 : 0, i - 0.5).y;
            return z;
        };
    EXPECT_GT(std::abs(sumAlong(true) - sumAlong(false)), 3);
    const Result<Image> heights = heightsFromNormals(map, "n");
    ASSERT_TRUE(heights);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 16; ++x)
            EXPECT_NEAR(*heights->at(x, y), *heights->at(31 - x, y), 1e-4);
}

TEST(HeightsFromNormals, NoNeighbouringHeightsAreABetterFit) {
    // Least squares: moving one height either way makes the sum of squared slope errors larger.
    const Slopes noise = [](double x, double y) {
        return dvec2(std::sin(12.9 * x + 78.2 * y), std::cos(39.3 * x - 11.1 * y));
    };
    const Image map = normalMap(7, 6, noise);
    Image heights = *heightsFromNormals(map, "n");
    const auto misfit = [&] {
        double sum = 0;
        for (int y = 0; y < 6; ++y)
            for (int x = 0; x < 7; ++x) {
                if (x < 6)
                    sum += std::pow(*heights.at(x + 1, y) - *heights.at(x, y) -
                                        (noise(x, y).x + noise(x + 1, y).x) / 2,
                                    2);
                if (y < 5)
                    sum += std::pow(*heights.at(x, y + 1) - *heights.at(x, y) +
                                        (noise(x, y).y + noise(x, y + 1).y) / 2,
                                    2);
            }
        return sum;
    };
    const double best = misfit();
    for (float& height : heights.pixels)
        for (const float step : {0.01f, -0.01f}) {
            height += step;
            EXPECT_GT(misfit(), best);
            height -= step;
        }
}

TEST(HeightsFromNormals, SingleRowsColumnsAndTexelsWork) {
    const auto slope = [](double, double) { return dvec2(1, 1); };
    EXPECT_EQ(heightsFromNormals(normalMap(1, 1, slope), "n")->pixels, std::vector<float>{0});
    const Result<Image> row = heightsFromNormals(normalMap(5, 1, slope), "n");
    const Result<Image> column = heightsFromNormals(normalMap(1, 5, slope), "n");
    for (int i = 0; i < 5; ++i) {
        EXPECT_NEAR(row->pixels[std::size_t(i)], i, 1e-5);
        EXPECT_NEAR(column->pixels[std::size_t(i)], 4 - i, 1e-5); // up is towards row 0
    }
}

TEST(HeightsFromNormals, NormalsThatPointDownAreRefusedWithTheirPlace) {
    Image map = normalMap(3, 2, [](double, double) { return dvec2(0); });
    map.at(2, 1)[2] = 0.25f;
    EXPECT_EQ(heightsFromNormals(map, "n.png").error().message,
              "n.png: texel (2, 1) holds the normal 0 0 -0.5; must be finite with z above 0");
    map.at(1, 0)[0] = NAN;
    EXPECT_EQ(heightsFromNormals(map, "n.png").error().message,
              "n.png: texel (1, 0) holds the normal nan 0 1; must be finite with z above 0");
    EXPECT_EQ(heightsFromNormals(Image(2, 2, 1), "n.png").error().message,
              "n.png: has 1 channels; a normal map must have 3");
}

} // namespace
} // namespace lucent::scene
