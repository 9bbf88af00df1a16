// Kernels against the profiles that they are made of, and lattices of points against integrals.
#include "techniques/subsurface/Kernel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lucent::subsurface {
namespace {

constexpr double kPi = std::numbers::pi;

// Marble, 1/m (Jensen et al. 2001).
std::array<diffusion::Medium, 3> marble() {
    return {diffusion::Medium{2190, 2.1, 1.5}, {2620, 4.1, 1.5}, {3000, 7.1, 1.5}};
}

double at(const Band& band, double r, int channel) {
    if (r >= band.reach) return 0;
    const double u = std::sqrt(r / band.reach) * double(band.table.size() - 1);
    const auto low = std::min(std::size_t(u), band.table.size() - 2);
    return glm::mix(double(band.table[low][channel]), double(band.table[low + 1][channel]), u - double(low));
}

double at(const Kernel& kernel, double r, int channel) {
    double sum = 0;
    for (const Band& band : kernel.bands)
        sum += at(band, r, channel);
    return sum;
}

double integral(const Kernel& kernel, double reach, int channel) {
    constexpr int kSteps = 20000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double u = (i + 0.5) / kSteps, r = reach * u * u;
        sum += 2 * kPi * r * at(kernel, r, channel) * 2 * reach * u / kSteps;
    }
    return sum;
}

// The largest error of the sum over a square lattice, over all places of the lattice, of what each band
// leaves.
double latticeError(const Kernel& kernel, int channel, double total) {
    double worst = 0;
    for (const vec2 place : {vec2(0), vec2(0.5f, 0), vec2(0.5f), vec2(0.25f, 0.1f)}) {
        double sum = 0;
        for (const Band& band : kernel.bands) {
            const int count = int(std::ceil(band.reach / band.spacing)) + 1;
            for (int y = -count; y <= count; ++y)
                for (int x = -count; x <= count; ++x)
                    sum += band.spacing * band.spacing *
                           at(band, band.spacing * std::hypot(x - place.x, y - place.y), channel);
        }
        worst = std::max(worst, std::abs(sum / total - 1));
    }
    return worst;
}

TEST(Kernel, KeepsTheProfilesWholeIntegralWhereItIsCut) {
    for (const bool split : {false, true})
        for (const auto shape : {diffusion::Shape::Dipole, diffusion::Shape::Burley}) {
            const Kernel kernel = kernelOf(marble(), {.shape = shape, .size = 1, .split = split});
            const double reach = kernel.bands.back().reach;
            EXPECT_LT(reach, 1);
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_NEAR(integral(kernel, reach, channel),
                            diffusion::totalReflectance(marble()[std::size_t(channel)], shape, 0), 1e-3)
                    << "split " << split << " shape " << int(shape);
        }
}

TEST(Kernel, ASplitProfileAddsUpToTheProfile) {
    // A split profile reaches to a tenth of its epsilon.
    const Kernel whole = kernelOf(marble(), {.epsilon = 0.001, .size = 0.04}),
                 split = kernelOf(marble(), {.epsilon = 0.01, .size = 0.04, .split = true});
    EXPECT_EQ(whole.bands.size(), 1u);
    EXPECT_GT(split.bands.size(), 2u);
    for (double r = 1e-5; r < 0.019; r *= 1.3)
        for (int channel = 0; channel < 3; ++channel)
            EXPECT_NEAR(at(split, r, channel) / at(whole, r, channel), 1, 0.01) << r;
}

TEST(Kernel, ALatticeSumsItToEpsilon) {
    for (const double epsilon : {0.1, 0.01, 0.001})
        for (const bool split : {false, true}) {
            const Kernel kernel = kernelOf(marble(), {.epsilon = epsilon, .size = 1, .split = split});
            for (int channel = 0; channel < 3; ++channel) {
                const double total =
                    diffusion::totalReflectance(marble()[std::size_t(channel)], diffusion::Shape::Dipole, 0);
                // Tables add up to 1e-3 of their own.
                EXPECT_LT(latticeError(kernel, channel, total), epsilon + 1e-3)
                    << "epsilon " << epsilon << " split " << split;
            }
        }
}

TEST(Kernel, ALatticeSumsLayersToEpsilon) {
    const diffusion::Medium marbleOnSkin{880, 170, 1.3, {{2620, 4.1, 1.3, 1e-4}}},
        denseOnClear{300, 1, 1.3, {{5000, 5, 1.3, 5e-4}}},
        skinOnMarble{2620, 4.1, 1.3, {{880, 170, 1.3, 2e-4}}};
    for (const bool split : {false, true}) {
        const Kernel kernel =
            kernelOf({marbleOnSkin, denseOnClear, skinOnMarble},
                     {.shape = diffusion::Shape::Multipole, .epsilon = 0.01, .size = 1, .split = split});
        EXPECT_EQ(kernel.blur, 0);
        int channel = 0;
        for (const diffusion::Medium& medium : {marbleOnSkin, denseOnClear, skinOnMarble}) {
            const double total = diffusion::totalReflectance(medium, diffusion::Shape::Multipole, 0);
            EXPECT_LT(latticeError(kernel, channel++, total), 0.011) << "split " << split;
        }
    }
}

TEST(Kernel, BlursWhatPointsCannotTellApartAndKeepsItsLight) {
    // A mean free path of a hundredth of the points' distance.
    const Kernel kernel = kernelOf({diffusion::Medium{1e6, 10, 1.5}, {1e6, 20, 1.5}, {1e6, 30, 1.5}},
                                   {.size = 1, .leastSpacing = 1e-4});
    EXPECT_GT(kernel.blur, 0);
    const double total = diffusion::totalReflectance({1e6, 10, 1.5}, diffusion::Shape::Dipole, 0);
    EXPECT_NEAR(integral(kernel, kernel.bands.back().reach, 0), total, 2e-3);
    EXPECT_LT(latticeError(kernel, 0, total), 0.012);
}

} // namespace
} // namespace lucent::subsurface
