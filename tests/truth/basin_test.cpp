// Water between walls against closed forms.
#include "truth/Basin.h"

#include "scene/Water.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lucent::truth {
namespace {

TEST(Basin, WaterIsTheDampedTravellingWaveFarFromTheWalls) {
    // What the walls mirror travels at 0.5 m/s: after 0.4 s the middle 0.6 m of 2 m x 1.5 m know nothing of
    // them. The scheme's waves are slower by (k cell)² (1 - r²) / 24 with r = 0.27: over the 0.4 s 3.1
    // radians times 2.3e-3, 7e-3 of the amplitude.
    const scene::Water water{.size = {2, 1.5f}, .amplitude = 0.01f, .wavelength = 0.4f, .direction = {3, 4}};
    const double k = 2 * std::numbers::pi / double(water.wavelength), damping = double(water.damping);
    const dvec2 wave = k * dvec2(0.6, 0.8);
    const double frequency = std::sqrt(0.25 * k * k - damping * damping / 4);
    for (const double time : {0.0, 0.1, 0.4, 0.404}) {
        const Basin basin(water, time);
        const double height = double(water.amplitude) * std::exp(-damping * time / 2);
        const double allowed =
            (time == 0 ? 6e-5 : 8e-3) * height; // a spline leaves (k cell)^4 / 384 of a sine
        for (double x = -0.3; x < 0.3; x += 0.013)
            for (double z = -0.3; z < 0.3; z += 0.017) {
                const double turn = glm::dot(wave, dvec2(x, z)) - frequency * time;
                const Basin::Surface found = basin.at({x, z});
                ASSERT_NEAR(found.height, height * std::sin(turn), allowed) << time;
                ASSERT_NEAR(glm::distance(found.slope, height * std::cos(turn) * wave), 0, allowed * k);
            }
    }
}

TEST(Basin, WallsMirrorDropsAndTheMeanStays) {
    const scene::Water water{.size = {0.4f, 1}, .cells = 80, .damping = 0, .dropInterval = 1};
    const Basin basin(water, 1.9); // 0.9 s after the drop its waves have met both walls
    const dvec2 half = basin.half();
    double mean = 0, most = 0;
    for (int x = 0; x <= 32; ++x)
        for (int z = 0; z <= 80; ++z) {
            const double height = basin.at(dvec2(x, z) * basin.cell() - half).height;
            mean += (x % 32 ? 1 : 0.5) * (z % 80 ? 1 : 0.5) * height / (32 * 80);
            most = std::max(most, std::abs(height));
        }
    EXPECT_NEAR(mean, 0, 1e-12);
    EXPECT_GT(most, 0.02 * double(scene::fallingDrop(water, 1).depth));
    for (double z = -half.y; z < half.y; z += 0.03)
        for (const double wall : {-half.x, half.x}) {
            EXPECT_NEAR(basin.at({wall, z}).slope.x, 0, 1e-12);
            EXPECT_NEAR(basin.at({wall + 0.03, z}).height, basin.at({wall - 0.03, z}).height, 1e-15);
        }
}

TEST(Basin, AStandingWaveBetweenWallsIsTheirs) {
    // A sine across the basin, of which every half wave fits: its even continuation behind the walls is a sum
    // of cosines cos(j pi x / L), each of which swings on its own: c_j cos(w_j t) + s_j sin(w_j t) / w_j.
    const double length = 1, speed = double(scene::Water{}.speed), time = 2.4;
    const scene::Water water{
        .size = {1, 0.1f}, .cells = 512, .damping = 0, .amplitude = 0.01f, .wavelength = 0.5f};
    const double k = 2 * std::numbers::pi / 0.5, w = speed * k;
    const auto sine = [&](double x) { return 0.01 * std::sin(k * (x - length / 2)); };
    const auto rise = [&](double x) { return -w * 0.01 * std::cos(k * (x - length / 2)); };
    const Basin basin(water, time);
    constexpr int kSamples = 4000, kModes = 400;
    std::vector<double> waves(kModes), rises(kModes);
    for (int j = 0; j < kModes; ++j)
        for (int i = 0; i < kSamples; ++i) {
            const double x = (i + 0.5) / kSamples * length;
            const double share = (j ? 2.0 : 1.0) / kSamples * std::cos(j * std::numbers::pi * x / length);
            waves[std::size_t(j)] += share * sine(x);
            rises[std::size_t(j)] += share * rise(x);
        }
    double worst = 0;
    for (double x = 0.005; x < length; x += 0.01) {
        double height = waves[0] + rises[0] * time;
        for (int j = 1; j < kModes; ++j) {
            const double own = speed * j * std::numbers::pi / length;
            height += std::cos(j * std::numbers::pi * x / length) *
                      (waves[std::size_t(j)] * std::cos(own * time) +
                       rises[std::size_t(j)] * std::sin(own * time) / own);
        }
        worst = std::max(worst, std::abs(basin.at({x - length / 2, 0.013}).height - height));
    }
    // Kinks that the walls make of the sine hold short waves, which the grid's 2 mm slow down.
    EXPECT_LT(worst, 0.02 * 0.01);
}

TEST(Basin, ADropIsAHollowWithARim) {
    const scene::Water water{.cells = 128, .damping = 0, .dropInterval = 0.125f};
    // Behind step 15 of 120 a second, which ends at 0.125 s.
    const Basin basin(water, 0.125);
    const scene::WaterDrop drop = scene::fallingDrop(water, 1);
    const dvec2 middle(drop.place);
    EXPECT_NEAR(basin.at(middle).height, -double(drop.depth), 0.02 * double(drop.depth));
    const double q = 2.0, radius = std::sqrt(q) * double(drop.radius);
    EXPECT_NEAR(basin.at(middle + dvec2(radius, 0)).height, double(drop.depth) * (q - 1) * std::exp(-q),
                0.02 * double(drop.depth));
}

} // namespace
} // namespace lucent::truth
