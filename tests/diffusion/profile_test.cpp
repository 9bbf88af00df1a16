#include "diffusion/Profile.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

namespace lucent::diffusion {
namespace {

constexpr double kPi = std::numbers::pi;

/// Red, green and blue of the measured marble (Jensen et al. 2001), 1/m.
const Medium kMarble[] = {{2190, 2.1, 1.5}, {2620, 4.1, 1.5}, {3000, 7.1, 1.5}};

/// Integral of f over r, 2 pi r dr, in steps that grow with r: the trapezium rule over the logarithm of r,
/// whose error falls exponentially for what is smooth over the whole axis.
double overPlane(const std::function<double(double)>& f, double from, double to, int steps = 20000) {
    const double step = std::log(to / from) / steps;
    double sum = 0;
    for (int i = 0; i <= steps; ++i) {
        const double r = from * std::exp(i * step);
        sum += (i == 0 || i == steps ? 0.5 : 1) * f(r) * 2 * kPi * r * r;
    }
    return sum * step;
}

TEST(Profile, InternalReflectionIsNearTheIntegralOfFresnelsEquations) {
    // 2 integral of F(c) c dc inside: what does not leave, by the reversed way, of meanTransmittance().
    for (const double ior : {1.3, 1.5})
        EXPECT_NEAR(diffuseReflectance(ior), 1 - meanTransmittance(ior) / (ior * ior), 5e-3) << ior;
    EXPECT_NEAR(diffuseReflectance(1.5), -0.64 + 0.71 / 1.5 + 0.668 + 0.0954, 1e-12);
    EXPECT_NEAR(diffuseReflectance(1), 0, 2e-3); // nothing is reflected; the fit leaves 0.0016
    EXPECT_NEAR(diffuseReflectance(0.999999), 0, 2e-3);
    for (const double ior : {0.3, 0.5, 0.8, 1.0, 1.3, 2.0, 3.0}) {
        EXPECT_GT(diffuseReflectance(ior), 0) << ior;
        EXPECT_LT(diffuseReflectance(ior), 1) << ior;
    }
}

TEST(Profile, MeanTransmittanceKeepsEtendue) {
    EXPECT_NEAR(meanTransmittance(1), 1, 1e-12);
    EXPECT_NEAR(meanTransmittance(1.5), 0.9082, 5e-5);
    // What enters evenly from all around fills 1 / ior² of the directions inside: T(n) = n² T(1/n).
    for (const double ior : {1.1, 1.5, 2.4})
        EXPECT_NEAR(meanTransmittance(ior), ior * ior * meanTransmittance(1 / ior), 2e-6) << ior;
}

TEST(Profile, HalfSpaceGivesBackTheKnownShare) {
    // (a'/2)(1 + e^(-(4/3) A sqrt(3(1-a')))) e^(-sqrt(3(1-a'))) with A = (1 + 0.5968) / (1 - 0.5968).
    const double known[] = {0.8302, 0.7910, 0.7526};
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(totalReflectance(kMarble[i], Shape::Dipole, 0), known[i], 5e-5);
}

TEST(Profile, IntegratesToItsClosedForms) {
    for (const Medium& medium : kMarble)
        for (const Shape shape : {Shape::Dipole, Shape::Multipole, Shape::Burley}) {
            const auto value = [&](double r) { return reflectance(medium, shape, 0.002, r); };
            EXPECT_NEAR(overPlane(value, 1e-9, 1), totalReflectance(medium, shape, 0.002), 2e-6);
            for (const double r : {1e-4, 1e-3, 1e-2})
                EXPECT_NEAR(overPlane(value, 1e-9, r), reflectanceWithin(medium, shape, 0.002, r), 2e-6);
        }
}

TEST(Profile, SlabOfGreatThicknessIsAHalfSpace) {
    for (const Medium& medium : kMarble) {
        for (const double thickness : {1.0, std::numeric_limits<double>::infinity(), 0.0})
            for (const double r : {0.0, 1e-4, 1e-3, 1e-2}) // 1 m is 117 or more diffusion lengths
                EXPECT_NEAR(reflectance(medium, Shape::Multipole, thickness, r),
                            reflectance(medium, Shape::Dipole, 0, r),
                            1e-9 * reflectance(medium, Shape::Dipole, 0, 0));
        EXPECT_NEAR(totalReflectance(medium, Shape::Multipole, 1), totalReflectance(medium, Shape::Dipole, 0),
                    1e-12);
        EXPECT_NEAR(totalTransmittance(medium, 1), 0, 1e-12);
    }
}

TEST(Profile, SlabLosesNoLightAndMakesNone) {
    for (const double optical : {1e-6, 1e-2, 0.5, 1.0, 3.0, 30.0, 1e4})
        for (const double absorption : {0.0, 1e-6, 0.1, 1.0, 10.0})
            for (const double ior : {0.5, 1.0, 1.3, 2.5}) {
                const Medium medium{1000, 1000 * absorption, ior};
                const double thickness = optical / medium.extinction();
                const double back = totalReflectance(medium, Shape::Multipole, thickness);
                const double through = totalTransmittance(medium, thickness);
                const double collides = -std::expm1(-optical);
                EXPECT_GE(back, 0) << optical;
                EXPECT_GE(through, 0) << optical;
                EXPECT_LE(back + through, collides * (1 + 1e-12)) << optical << " " << absorption;
                if (absorption == 0) {
                    EXPECT_NEAR(back + through, collides, 1e-9 * collides) << optical;
                }
            }
}

TEST(Profile, ThinSlabLetsHalfThrough) {
    // The source of a thin slab stands in its middle, as far from both sides.
    const Medium medium{1000, 1, 1.3};
    EXPECT_NEAR(totalReflectance(medium, Shape::Multipole, 1e-9) / totalTransmittance(medium, 1e-9), 1, 1e-6);
    for (const double r : {1e-6, 1e-4, 1e-3})
        EXPECT_NEAR(reflectance(medium, Shape::Multipole, 1e-9, r) / transmittance(medium, 1e-9, r), 1, 1e-4);
}

TEST(Profile, WithoutAbsorptionASlabIsTheLinearSolution) {
    // Light falls linearly between the extrapolated boundaries z_b outside: R = 1 - (l + z_b) / (d + 2 z_b)
    // for a source at l. Thick enough that all light collides and the source stands at one mean free path.
    const Medium medium{1000, 0, 1.3};
    const double internal = diffuseReflectance(1.3), l = 1e-3, d = 0.03;
    const double boundary = 2 * (1 + internal) / (1 - internal) * l / 3;
    const double through = (l + boundary) / (d + 2 * boundary);
    EXPECT_NEAR(totalTransmittance(medium, d), through, 1e-12);
    EXPECT_NEAR(totalReflectance(medium, Shape::Multipole, d), 1 - through, 1e-12);
}

TEST(Profile, FewPolesStandForAllOfThem) {
    // Against very many, over the largest value, as the series promises; both sides of the slab.
    for (const double absorption : {0.0, 10.0, 1000.0})
        for (const double optical : {0.3, 2.0, 10.0}) {
            const Medium medium{1000, absorption, 1.4};
            const double thickness = optical / medium.extinction();
            const auto sum = [&](double epsilon, double r, bool across) {
                double value = 0;
                for (const Pole& pole : polesOf(medium, thickness, epsilon)) {
                    const double away = across ? thickness - pole.depth : pole.depth;
                    value += pole.weight / pole.depth * away * kernel(medium, std::hypot(r, away));
                }
                return value;
            };
            for (const double epsilon : {1e-1, 1e-2, 1e-4})
                for (const double r : {0.0, 1e-4, 1e-3, 1e-2}) {
                    EXPECT_NEAR(sum(epsilon, r, false), sum(1e-10, r, false), epsilon * sum(1e-10, 0, false));
                    EXPECT_NEAR(sum(epsilon, r, true), sum(1e-10, r, true), epsilon * sum(1e-10, 0, false));
                }
        }
}

TEST(Profile, AnisotropyCountsOnlyInTheReducedCoefficient) {
    scene::Material plain, forward;
    plain.kind = scene::Translucent{.scattering = {1000, 2000, 3000}, .absorption = {1, 2, 3}};
    forward = plain;
    forward.translucent().anisotropy = 0.99f;
    forward.translucent().scattering /= 1 - forward.translucent().anisotropy;
    for (std::size_t i = 0; i < 3; ++i)
        for (const double r : {0.0, 1e-3})
            // The factor 1 / (1 - 0.99) is stored in floats: relative 6e-8 a hundred times over.
            EXPECT_NEAR(reflectance(mediaOf(forward)[i], Shape::Dipole, 0, r) /
                            reflectance(mediaOf(plain)[i], Shape::Dipole, 0, r),
                        1, 2e-5);
}

TEST(Profile, ReachHoldsAllButEpsilon) {
    for (const Medium& medium : kMarble)
        for (const Shape shape : {Shape::Dipole, Shape::Multipole, Shape::Burley})
            for (const double epsilon : {0.1, 0.01, 1e-4}) {
                const double r = Profile(medium, shape, 0.002).reach(epsilon, 10);
                EXPECT_NEAR(reflectanceWithin(medium, shape, 0.002, r) /
                                totalReflectance(medium, shape, 0.002),
                            1 - epsilon, 1e-7);
            }
}

TEST(Profile, ReachIsFiniteWithoutAbsorptionAndWithoutScattering) {
    const Medium milk{2550, 0, 1.3};
    // What lies beyond r falls as 1/r: the mean depth of both poles over r.
    const double internal = diffuseReflectance(1.3);
    const double depth = (1 + 2.0 / 3 * (1 + internal) / (1 - internal)) / 2550;
    EXPECT_NEAR(Profile(milk, Shape::Dipole, 0).reach(1e-4, 100), depth / 1e-4, 1e-3 * depth / 1e-4);
    EXPECT_EQ(Profile(milk, Shape::Dipole, 0).reach(1e-4, 0.02), 0.02);
    EXPECT_EQ(Profile({0, 5, 1.3}, Shape::Dipole, 0).reach(0.01, 1), 0);
    EXPECT_EQ(Profile({0, 0, 1.3}, Shape::Multipole, 0.1).reach(0.01, 1), 0);
    EXPECT_EQ(totalReflectance({0, 0, 1.3}, Shape::Burley, 0), 0);
    EXPECT_EQ(reflectance({0, 7, 1.3}, Shape::Burley, 0, 0), 0);
    EXPECT_EQ(transmittance({0, 7, 1.3}, 1, 0), 0);
}

TEST(Profile, BurleyHasTheLightOfTheDipole) {
    for (const Medium& medium : kMarble)
        EXPECT_EQ(totalReflectance(medium, Shape::Burley, 0), totalReflectance(medium, Shape::Dipole, 0));
    EXPECT_EQ(reflectance(kMarble[0], Shape::Burley, 0, 0), std::numeric_limits<double>::infinity());
}

/// What a table holds, by its own interpolation: cells by Simpson's rule over sqrt(r), exact for its cubics.
double integralOf(const Table& table, int channel) {
    const auto n = double(table.values.size() - 1);
    const auto at = [&](double i) {
        const double u = i / n, r = table.reach * u * u;
        return double(valueAt(table, std::min(r, table.reach * (1 - 1e-12)))[channel]) * 4 * kPi *
               table.reach * table.reach * u * u * u / n;
    };
    double sum = 0;
    for (int i = 0; i < int(n); ++i)
        for (int k = 0; k < 8; ++k) // an eighth of a cell at a time
            sum += (at(i + k / 8.0) + 4 * at(i + (k + 0.5) / 8) + at(i + (k + 1) / 8.0)) / 48;
    return sum;
}

TEST(Table, IntegratesToTheClosedForm) {
    const std::array<Medium, 3> media = {kMarble[0], kMarble[1], kMarble[2]};
    for (const Shape shape : {Shape::Dipole, Shape::Multipole, Shape::Burley})
        for (const double epsilon : {0.1, 0.01, 0.001}) {
            const double extent = Profile(media[0], shape, 0.003).reach(epsilon, 10);
            const Table table = tableOf(profilesOf(media, shape, 0.003), extent, 1e-3);
            for (int i = 0; i < 3; ++i) // values are floats: 6e-8 each
                EXPECT_NEAR(integralOf(table, i), totalReflectance(media[std::size_t(i)], shape, 0.003),
                            1e-6);
        }
}

TEST(Table, KeepsItsErrorBetweenEntries) {
    const std::array<Medium, 3> media = {kMarble[0], kMarble[1], kMarble[2]};
    for (const double error : {1e-1, 1e-2, 1e-3}) {
        const double extent = Profile(media[0], Shape::Dipole, 0).reach(1e-3, 10);
        const Table table = tableOf(profilesOf(media, Shape::Dipole, 0), extent, error);
        EXPECT_LE(table.error, error);
        EXPECT_LT(table.values.size(), std::size_t(kMostEntries));
        // Rescaling for what is cut moves all values by epsilon, and for the interpolation by its error.
        for (int k = 1; k < 1000; ++k) {
            const double r = extent * k / 1000;
            const double exact = reflectance(media[0], Shape::Dipole, 0, r);
            EXPECT_NEAR(double(valueAt(table, r).x) / exact, 1, 2 * error + 2e-3) << r;
        }
    }
}

TEST(Table, IsNotScaledUpWhereNothingIsCut) {
    // A mean free path a hundred times the object: nearly all light leaves elsewhere, and must not come back.
    const Medium thin{1, 0.01, 1.3};
    const double extent = Profile(thin, Shape::Dipole, 0).reach(0.01, 0.01);
    EXPECT_EQ(extent, 0.01);
    const Table table = tableOf(profilesOf({thin, thin, thin}, Shape::Dipole, 0), extent, 1e-3, false);
    EXPECT_NEAR(integralOf(table, 0), reflectanceWithin(thin, Shape::Dipole, 0, extent), 1e-9);
    EXPECT_NEAR(double(table.values.back().x) / reflectance(thin, Shape::Dipole, 0, extent), 1, 1e-4);
}

TEST(Table, OfWhatDoesNotScatterIsBlack) {
    const Table table =
        tableOf(profilesOf({Medium{0, 1, 1.3}, Medium{0, 0, 1.3}, kMarble[2]}, Shape::Dipole, 0), 0.01, 1e-3);
    for (const vec3& value : table.values) {
        EXPECT_EQ(value.x, 0);
        EXPECT_EQ(value.y, 0);
        EXPECT_GT(value.z, 0);
    }
    EXPECT_EQ(valueAt(tableOf(profilesOf({}, Shape::Burley, 0), 0, 1e-3), 0.5), vec3(0));
}

TEST(Table, HardCasesStayFinite) {
    const Medium cases[] = {{1e-9, 0, 1.3},   {1e-9, 1e6, 1.3}, {1e9, 0, 1.0},  {2550, 0, 1.3},
                            {2550, 1e9, 3.0}, {1e9, 1e9, 0.3},  {2550, 1, 0.5}, {20400, 0, 1.0}};
    for (const Medium& medium : cases)
        for (const Shape shape : {Shape::Dipole, Shape::Multipole, Shape::Burley}) {
            const double extent = Profile(medium, shape, 0.01).reach(0.01, 0.1);
            EXPECT_GT(extent, 0);
            EXPECT_LE(extent, 0.1);
            const Table table =
                tableOf(profilesOf({medium, medium, medium}, shape, 0.01), extent, 1e-2, extent < 0.1);
            for (const vec3& value : table.values) {
                EXPECT_TRUE(std::isfinite(value.x));
                EXPECT_GE(value.x, 0);
            }
        }
}

} // namespace
} // namespace lucent::diffusion
