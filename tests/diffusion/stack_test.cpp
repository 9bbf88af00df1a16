#include "diffusion/Stack.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>

namespace lucent::diffusion {
namespace {

const Medium kMarble{2620, 4.1, 1.3}, kSkin{880, 170, 1.3};
constexpr Shape kShape = Shape::Multipole;

Medium layered(Medium base, std::vector<Slab> above) {
    base.above = std::move(above);
    return base;
}
Slab slabOf(const Medium& medium, double thickness) {
    return {medium.scattering, medium.absorption, medium.ior, thickness};
}

void expectSame(const Medium& one, double oneThick, const Medium& other, double otherThick, double error) {
    const double whole = totalReflectance(other, kShape, otherThick);
    EXPECT_NEAR(totalReflectance(one, kShape, oneThick), whole, error * whole);
    for (const double r : {0.0, 1e-6, 1e-4, 1e-3, 5e-3, 2e-2}) {
        const double known = reflectance(other, kShape, otherThick, r);
        // The poles of a slab leave up to 1e-6 of the largest value; much less, as found.
        const double poles = otherThick > 0 ? 1e-8 * reflectance(other, kShape, otherThick, 0) : 0;
        EXPECT_NEAR(reflectance(one, kShape, oneThick, r), known, error * known + poles) << r;
        EXPECT_NEAR(reflectanceWithin(one, kShape, oneThick, r),
                    reflectanceWithin(other, kShape, otherThick, r), error * whole)
            << r;
    }
}

TEST(Stack, LayersOfOneMediumAreThatMedium) {
    // What is left is the table's cubic interpolation: 1e-5 or less.
    for (const Medium& medium : {kMarble, kSkin, Medium{2000, 0, 1.5}})
        for (const double thickness : {1e-5, 3e-4, 1e-3, 1e-2}) {
            expectSame(layered(medium, {slabOf(medium, thickness)}), 0, medium, 0, 2e-5);
            expectSame(layered(medium, {slabOf(medium, thickness), slabOf(medium, 2e-4)}), 0.002, medium,
                       thickness + 0.0022, 2e-5);
        }
}

TEST(Stack, ThickLayersHideWhatLiesBelowAndThinOnesDoNot) {
    expectSame(layered(kSkin, {slabOf(kMarble, 1)}), 0, kMarble, 0, 2e-5);
    EXPECT_EQ(totalReflectance(layered(kSkin, {slabOf(kMarble, 0)}), kShape, 0),
              totalReflectance(kSkin, kShape, 0));
    // A nanometre of an optical depth of 3e-6.
    expectSame(layered(kSkin, {slabOf(kMarble, 1e-9)}), 0, kSkin, 0, 2e-5);
    // A layer that is clear is crossed straight.
    expectSame(layered(kSkin, {{0, 0, 1.3, 0.01}}), 0, kSkin, 0, 2e-5);
}

TEST(Stack, OrderMattersAndThicknessMovesTheAnswerFromOneMediumToTheOther) {
    const double marbleFirst =
        totalReflectance(layered({1, 1000, 1.3}, {slabOf(kMarble, 2e-3), slabOf(kSkin, 2e-3)}), kShape, 0);
    const double skinFirst =
        totalReflectance(layered({1, 1000, 1.3}, {slabOf(kSkin, 2e-3), slabOf(kMarble, 2e-3)}), kShape, 0);
    EXPECT_GT(marbleFirst, 1.5 * skinFirst);
    double before = totalReflectance(kSkin, kShape, 0);
    for (double thickness = 1e-5; thickness < 0.1; thickness *= 2) {
        const double now = totalReflectance(layered(kSkin, {slabOf(kMarble, thickness)}), kShape, 0);
        EXPECT_GT(now, before);
        before = now;
    }
    EXPECT_NEAR(before, totalReflectance(kMarble, kShape, 0), 1e-4);
}

TEST(Stack, LosesNoLightAndMakesNone) {
    std::mt19937 chance(7);
    const auto even = [&](double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(chance);
    };
    for (int i = 0; i < 100; ++i) {
        const auto slab = [&](double absorbing) {
            const double scattering = 100 * std::pow(100.0, even(0, 1));
            return Slab{scattering, absorbing * scattering * std::pow(10.0, even(-4, 1)), even(1, 1.8),
                        std::pow(10.0, even(-5, -2))};
        };
        const double absorbing = i % 2;
        Medium medium;
        double optical = 0;
        for (int layer = 0; layer < 1 + i % 4; ++layer) {
            medium.above.push_back(slab(absorbing));
            optical += medium.above.back().thickness *
                       (medium.above.back().scattering + medium.above.back().absorption);
        }
        const Slab base = slab(absorbing);
        medium.scattering = base.scattering;
        medium.absorption = base.absorption;
        medium.ior = base.ior;
        const double collides = -std::expm1(-optical - base.thickness * medium.extinction());
        const Stack lit(medium, base.thickness), other(medium, base.thickness, Stack::Side::Other);
        EXPECT_GE(lit.total(), 0);
        EXPECT_GE(other.total(), 0);
        EXPECT_LE(lit.total() + other.total(), collides * (1 + 1e-9));
        if (absorbing == 0) {
            EXPECT_NEAR(lit.total() + other.total(), collides, 1e-6 * collides);
        }
        // The table holds all of it, and grows with the disc.
        double least = 0;
        for (double r = 1e-6; r < 1e3; r *= 3) {
            EXPECT_GE(lit.at(r), 0);
            EXPECT_GE(lit.within(r), least);
            least = lit.within(r);
        }
        EXPECT_EQ(least, lit.total());
    }
}

TEST(Stack, DiscsHoldTheIntegralOfTheProfile) {
    const Medium medium = layered(kSkin, {slabOf(kMarble, 3e-4), {1000, 300, 1.5, 2e-4}});
    const Stack stack(medium, 0);
    double sum = 0;
    constexpr double kRatio = 1.002;
    for (double r = 1e-8; r < 0.05; r *= kRatio) { // the midpoint rule over log r
        const double middle = r * std::sqrt(kRatio);
        sum += 2 * std::numbers::pi * middle * middle * std::log(kRatio) * stack.at(middle);
        if (middle > 1e-5) {
            EXPECT_NEAR(sum, stack.within(r * kRatio), 1e-5) << r;
        }
    }
    EXPECT_NEAR(sum, stack.total(), 1e-5);
}

TEST(Stack, TablesKeepTheirErrorAndTheirIntegral) {
    const Medium medium = layered(kSkin, {slabOf(kMarble, 3e-4)});
    const double extent = Profile(medium, kShape, 0).reach(1e-3, 10);
    EXPECT_NEAR(reflectanceWithin(medium, kShape, 0, extent) / totalReflectance(medium, kShape, 0), 0.999,
                1e-6);
    const Table table = tableOf(profilesOf({medium, kMarble, kSkin}, kShape, 0), extent, 1e-3);
    EXPECT_LE(table.error, 1e-3);
    for (int i = 1; i < 100; ++i) {
        const double r = extent * i / 100; // cut at 1e-3 of the light, which scales the others up
        EXPECT_NEAR(double(valueAt(table, r).x) / reflectance(medium, kShape, 0, r), 1, 4e-3);
    }
}

TEST(Stack, SourceStandsAtAnOpticalDepthOfOne) {
    const Medium medium = layered({1000, 0, 1.3}, {{2000, 0, 1.3, 2e-4}});
    EXPECT_NEAR(Profile(medium, kShape, 0).depth(), 2e-4 + 0.6 / 1000, 1e-12); // 0.4 of it lies in the layer
    EXPECT_NEAR(Profile(medium, Shape::Dipole, 0).depth(), 1e-3, 1e-12);
    EXPECT_EQ(Profile({0, 0, 1.3}, kShape, 0).depth(), 0);
}

/// Where light of a thin ray from above leaves, by walks at random through planes between which Fresnel's
/// equations hold: the physics that the model stands for.
class Walks {
public:
    Walks(const Medium& medium, double thickness, int rays) {
        double bottom = 0;
        const auto add = [&](double scattering, double absorption, double ior, double thick) {
            sheets_.push_back({bottom, bottom + thick, scattering, absorption, ior});
            bottom += thick;
        };
        for (const Slab& slab : medium.above)
            add(slab.scattering, slab.absorption, slab.ior, slab.thickness);
        add(medium.scattering, medium.absorption, medium.ior, thickness > 0 ? thickness : 1e9);
        for (int i = 0; i < rays; ++i)
            follow(1.0 / rays);
    }
    double back = 0, across = 0; ///< shares
    double closer = 0;           ///< of what comes back, within 2 mm

private:
    struct Sheet {
        double top, bottom, scattering, absorption, ior;
    };
    double next() { return std::uniform_real_distribution<double>(0, 1)(chance_); }

    void follow(double share) {
        double x = 0, y = 0, z = 0, dx = 0, dy = 0, dz = 1;
        for (int in = 0; share > 0;) {
            const Sheet& sheet = sheets_[std::size_t(in)];
            const double extinction = sheet.scattering + sheet.absorption;
            const double way = -std::log1p(-next()) / extinction;
            const double edge = dz > 0 ? (sheet.bottom - z) / dz : dz < 0 ? (sheet.top - z) / dz : 1e30;
            const double step = std::min(way, edge);
            x += step * dx, y += step * dy, z += step * dz;
            if (way < edge) {
                if (next() * extinction > sheet.scattering) return;
                const double angle = 2 * std::numbers::pi * next();
                dz = 1 - 2 * next();
                const double level = std::sqrt(1 - dz * dz);
                dx = level * std::cos(angle), dy = level * std::sin(angle);
                continue;
            }
            const int behind = dz > 0 ? in + 1 : in - 1;
            const bool outside = behind < 0 || behind == int(sheets_.size());
            const double relative = (outside ? 1 : sheets_[std::size_t(behind)].ior) / sheet.ior;
            z = dz > 0 ? sheet.bottom : sheet.top;
            if (relative != 1 && next() > transmittedShare(std::abs(dz), relative)) {
                dz = -dz;
                continue;
            }
            dx /= relative, dy /= relative;
            dz = std::copysign(std::sqrt(std::max(0.0, 1 - dx * dx - dy * dy)), dz);
            in = behind;
            if (!outside) continue;
            (behind < 0 ? back : across) += share;
            if (behind < 0 && std::hypot(x, y) < 2e-3) closer += share;
            return;
        }
    }
    std::vector<Sheet> sheets_;
    std::mt19937 chance_{3};
};

TEST(Stack, IsNearRandomWalksThroughLayers) {
    // Diffusion is itself wrong by this much: a half space of albedo 0.77 gives back 11 % too much, one of
    // 0.998 1 % too little. Layers between shall not add to that; nor do they move light much: thin ones take
    // the most, as they leave light no room to become diffuse.
    struct Case {
        const char* name;
        Medium medium;
        double thickness, error;
    };
    const Medium green{1000, 100, 1.3};
    const Case cases[] = {
        {"half space, albedo 0.77", {1000, 300, 1.3}, 0, 0.13},
        {"marble 0.5 mm on skin", layered(kSkin, {slabOf(kMarble, 5e-4)}), 0, 0.1},
        {"skin 0.5 mm on marble", layered(kMarble, {slabOf(kSkin, 5e-4)}), 0, 0.06},
        {"marble of 1.5, 1 mm, on skin", layered(kSkin, {{2620, 4.1, 1.5, 1e-3}}), 0, 0.06},
        {"yellow 0.2 mm on green", layered(green, {{1000, 300, 1.3, 2e-4}}), 0, 0.13},
        {"filter 0.1 mm on marble", layered(kMarble, {{0, 2000, 1.3, 1e-4}}), 0, 0.09},
        {"three layers that absorb nothing",
         layered({500, 0, 1.3}, {{2000, 0, 1.4, 1e-3}, {4000, 0, 1.2, 5e-4}, {1000, 0, 1.5, 1e-3}}), 2e-3,
         0.03},
    };
    for (const Case& one : cases) {
        const Walks walks(one.medium, one.thickness, 20000);
        const double back = totalReflectance(one.medium, kShape, one.thickness);
        const double closer = reflectanceWithin(one.medium, kShape, one.thickness, 2e-3);
        std::printf("%-34s R %.4f, walks %.4f (%+.1f %%); within 2 mm %.4f, walks %.4f\n", one.name, back,
                    walks.back, 100 * (back / walks.back - 1), closer, walks.closer);
        const double chance = 3 * std::sqrt((1 - walks.back) / walks.back / 20000);
        EXPECT_NEAR(back / walks.back, 1, one.error + chance) << one.name;
        EXPECT_NEAR(closer / walks.closer, 1, 0.12 + chance) << one.name;
        EXPECT_NEAR(totalTransmittance(one.medium, one.thickness), walks.across, 0.02) << one.name;
    }
}

} // namespace
} // namespace lucent::diffusion
