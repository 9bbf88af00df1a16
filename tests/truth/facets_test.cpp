// Facets of a rough boundary: what is chosen fits what is asked, and they mirror no more than there is.
#include "truth/Facets.h"

#include "truth/Interface.h"
#include "truth/Lights.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lucent::truth {
namespace {

constexpr double kPi = std::numbers::pi;
const dvec3 kUp(0, 0, 1);

dvec3 viewerAt(double degrees) {
    const double angle = degrees * kPi / 180;
    return {std::sin(angle), 0, std::cos(angle)};
}

/// The integral of a function over the upper half of directions, by even cells of a map.
double overSky(const auto& function) {
    constexpr int kAcross = 200, kAround = 200;
    double sum = 0;
    for (int i = 0; i < kAcross; ++i)
        for (int j = 0; j < kAround; ++j) {
            const double cosine = (i + 0.5) / kAcross, sine = std::sqrt(1 - cosine * cosine);
            const double angle = 2 * kPi * (j + 0.5) / kAround;
            sum += function(dvec3(sine * std::cos(angle), sine * std::sin(angle), cosine));
        }
    return sum * 2 * kPi / (kAcross * kAround);
}

/// The same by directions that the facets choose.
double byChoice(const Facets& facets, const auto& function) {
    constexpr int kSide = 150;
    double sum = 0;
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j) {
            const dvec3 direction = facets.choose({(i + 0.5) / kSide, (j + 0.5) / kSide});
            if (const double density = facets.density(direction); density > 0)
                sum += function(direction) / density;
        }
    return sum / (kSide * kSide);
}

TEST(Facets, ChosenDirectionsHaveTheDensityThatTheySay) {
    for (const double roughness : {0.4, 0.8})
        for (const double degrees : {0.0, 40.0, 75.0}) {
            const Facets facets(kUp, viewerAt(degrees), roughness, 1.5);
            const auto share = [&](const dvec3& direction) { return facets.share(direction); };
            const auto tilted = [&](const dvec3& direction) { return direction.x * facets.share(direction); };
            // A map of 200 cells has steps of 0.9 degrees: the lobe is at least 9 wide.
            EXPECT_NEAR(byChoice(facets, share), overSky(share), 2e-3 * overSky(share)) << degrees;
            EXPECT_NEAR(byChoice(facets, tilted), overSky(tilted), 2e-3 * overSky(share)) << degrees;
        }
}

TEST(Facets, SmoothOnesMirrorFresnelsShareOfAnEvenSky) {
    for (const double degrees : {0.0, 30.0, 60.0, 80.0}) {
        const Facets facets(kUp, viewerAt(degrees), 0, 1.33);
        EXPECT_TRUE(facets.isSmooth());
        const double mirrored = byChoice(facets, [&](const dvec3& d) { return facets.share(d); });
        EXPECT_NEAR(mirrored, reflectance(viewerAt(degrees).z, 1 / 1.33), 1e-5);
    }
}

TEST(Facets, MirrorNoMoreThanFresnelAndMoreLightTheSameBothWays) {
    for (const double roughness : {0.2, 0.5, 1.0})
        for (const double degrees : {5.0, 45.0, 85.0}) {
            const dvec3 viewer = viewerAt(degrees), light = glm::normalize(dvec3(-0.5, 0.3, 0.4));
            const Facets facets(kUp, viewer, roughness, 1e6); // a mirror
            const double whole = byChoice(facets, [&](const dvec3& d) { return facets.share(d); });
            EXPECT_LE(whole, 1 + 1e-9);
            EXPECT_GT(whole, 0.3);
            const Facets back(kUp, light, roughness, 1e6); // shares carry the light's cosine
            EXPECT_NEAR(facets.share(light) * viewer.z, back.share(viewer) * light.z,
                        1e-9 * facets.share(light) + 1e-15);
            EXPECT_EQ(facets.share({0.6, 0, -0.8}), 0);
        }
}

} // namespace
} // namespace lucent::truth
