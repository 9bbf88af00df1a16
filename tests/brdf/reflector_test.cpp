// The models of glossy surfaces: the lines that the GPU runs against double precision, and the laws that
// BRDFs keep.
#include "techniques/brdf/Reflector.h"
#include "truth/Gloss.h"
#include "truth/Random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lucent::brdf {
namespace {

constexpr double kPi = std::numbers::pi;
const vec3 kUp(0, 0, 1);

struct Case {
    const char* name;
    scene::MaterialKinds kind;
    double mostReturned = 1; // of light from anywhere, as a white surface gives it back
    double diffuse = 1;      // of a white surface that conserves energy: what its lobe leaves
};

const Case kCases[] = {
    // What glTF leaves to the matt part is more than the facets leave over where the view grazes.
    {"glossy", scene::Glossy{.roughness = 0.4f}, 1.25},
    {"glossy, rough", scene::Glossy{.roughness = 1}, 1.02},
    {"metal", scene::Glossy{.metallic = 1, .roughness = 0.3f}},
    {"half metal", scene::Glossy{.metallic = 0.5f, .roughness = 0.6f, .ior = 2, .specular = {0.5f, 0.7f, 1}},
     1.04},
    {"phong", scene::Phong{.specular = vec3(0.3f), .exponent = 20}, 1, 0.7},
    {"phong, exponent 0", scene::Phong{.specular = vec3(0.3f), .exponent = 0}, 1, 0.7},
    {"blinn", scene::Blinn{.specular = vec3(0.3f), .exponent = 60}, 1, 0.7},
    // As printed both give more than they get.
    {"phong as printed", scene::Phong{.specular = vec3(0.3f), .exponent = 20, .asPrinted = true}, 3, 0.7},
    {"blinn as printed", scene::Blinn{.specular = vec3(0.3f), .exponent = 60, .asPrinted = true}, 3, 0.7},
    {"cook-torrance", scene::CookTorrance{.roughness = 0.5f}, 1, 0},
    {"cook-torrance, ior 20", scene::CookTorrance{.roughness = 0.7f, .ior = 20}, 1, 0},
    {"oren-nayar", scene::OrenNayar{.roughness = 0.6f}},
    {"oren-nayar, 0", scene::OrenNayar{.roughness = 0}},
};

scene::Material materialOf(const Case& one, double diffuse) {
    scene::Material material;
    material.diffuse = vec3(float(diffuse));
    material.kind = one.kind;
    return material;
}

vec3 direction(double theta, double phi) {
    return vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
}
vec3 anyAbove(truth::Random& random) {
    const dvec2 chance = random.nextPair();
    return direction(std::acos(chance.x), 2 * kPi * chance.y);
}

dvec3 exactShare(const scene::Material& material, const vec3& toLight, const vec3& toEye) {
    return truth::Gloss(material, dvec3(kUp), dvec3(toEye)).share(dvec3(toLight));
}

TEST(Reflector, AgreesWithDoublePrecision) {
    truth::Random random(1, 0, 0);
    for (const Case& one : kCases) {
        const scene::Material material = materialOf(one, 0.6);
        for (int i = 0; i < 2000; ++i) {
            const vec3 toLight = glm::normalize(anyAbove(random)), toEye = glm::normalize(anyAbove(random));
            const dvec3 exact = exactShare(material, toLight, toEye);
            const vec3 found = shareOf(material, kUp, toLight, toEye);
            for (int c = 0; c < 3; ++c) // powers of up to 60 of a rounded cosine
                ASSERT_NEAR(double(found[c]), exact[c], 2e-5 * exact[c] + 1e-6)
                    << one.name << " light " << toLight.x << ' ' << toLight.y << ' ' << toLight.z << " eye "
                    << toEye.x << ' ' << toEye.y << ' ' << toEye.z;
        }
    }
}

TEST(Reflector, LightAndViewMayBeExchanged) {
    truth::Random random(2, 0, 0);
    for (const Case& one : kCases) {
        const scene::Material material = materialOf(one, 0.6);
        for (int i = 0; i < 500; ++i) {
            const dvec3 a = glm::normalize(dvec3(anyAbove(random))),
                        b = glm::normalize(dvec3(anyAbove(random)));
            const dvec3 there = truth::Gloss(material, dvec3(kUp), b).share(a) / a.z;
            const dvec3 back = truth::Gloss(material, dvec3(kUp), a).share(b) / b.z;
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(there[c], back[c], 1e-6 * there[c])
                    << one.name; // angles by arc cosines: half the digits
        }
    }
}

// Of an even sky of radiance 1, by a rule that knows where lobes are: means over the truth's own choice.
double returned(const scene::Material& material, double theta, int samples = 40000) {
    const truth::Gloss gloss(material, dvec3(kUp), dvec3(direction(theta, 0)));
    truth::Random random(3, 0, 0);
    double sum = 0;
    for (int i = 0; i < samples; ++i) {
        const dvec3 toLight = gloss.choose(random.nextPair());
        const double share = gloss.share(toLight).y;
        if (share > 0) sum += share / gloss.density(toLight);
    }
    return sum / samples;
}

TEST(Reflector, GivesBackNoMoreThanItGets) {
    for (const Case& one : kCases)
        for (const double degrees : {0.0, 30.0, 60.0, 80.0, 89.0}) {
            const double back = returned(materialOf(one, one.diffuse), degrees * kPi / 180);
            EXPECT_LT(back, one.mostReturned * 1.005) << one.name << " at " << degrees; // noise: 0.2 %
            EXPECT_GE(back, 0) << one.name;
        }
    // What is said of those that do not: a white Phong surface as printed gives back pi times its diffuse
    // part.
    EXPECT_GT(returned(materialOf(kCases[7], 0.7), 0), 2);
    EXPECT_GT(returned(materialOf(kCases[8], 0.7), 0), 2);
}

TEST(Reflector, TheFurnacesNumberIsThatOfDoublePrecision) {
    for (const Case& one : kCases)
        for (const double degrees : {0.0, 45.0, 75.0}) {
            const scene::Material material = materialOf(one, 0.6);
            const double exact = returned(material, degrees * kPi / 180, 200000);
            EXPECT_NEAR(double(directionalAlbedo(material, float(std::cos(degrees * kPi / 180))).y), exact,
                        0.006 * exact)
                << one.name << " at " << degrees; // noise of the truth 0.2 %
        }
}

TEST(Reflector, ExchangedDirectionsDifferByRoundingAlone) {
    for (const Case& one : kCases)
        EXPECT_LT(reciprocityError(materialOf(one, 0.6)), 5e-5f) << one.name; // powers of rounded cosines
}

// What is linear between texels is halved in size and quartered in error.
TEST(Reflector, TablesOfMoreTexelsAreCloser) {
    const scene::Material rough = materialOf({"", scene::CookTorrance{.roughness = 0.7f}}, 0.5);
    for (const scene::TableForm form : {scene::TableForm::EqualArea, scene::TableForm::Projected}) {
        const float coarse = tableError(rough, form, 8, 8, 512), fine = tableError(rough, form, 32, 32, 512);
        EXPECT_GT(fine, 0);
        EXPECT_LT(fine, 0.4f * coarse) << int(form); // the horizon, where it is steep, holds both up
    }
    const scene::Material matt = materialOf({"", scene::OrenNayar{.roughness = 0}}, 0.5);
    EXPECT_LT(tableError(matt, scene::TableForm::Projected, 4, 4, 512), 1e-6f); // the same in all texels
}

TEST(Reflector, NormalisedLobesGiveBackTheirColour) {
    for (const float exponent : {0.0f, 3.0f, 50.0f, 1000.0f}) {
        scene::Material material;
        material.diffuse = vec3(0);
        material.kind = scene::Phong{.specular = vec3(1), .exponent = exponent};
        // Seen from straight above no part of the lobe lies below the surface: (n + 2) / 2 pi times the
        // integral of cos^(n + 1), 2 pi / (n + 2).
        EXPECT_NEAR(returned(material, 0), 1, 0.01) << exponent;
        material.kind = scene::Blinn{.specular = vec3(1), .exponent = exponent};
        EXPECT_NEAR(returned(material, 0), 1, 0.01) << exponent;
    }
}

TEST(Reflector, ARoughnessOfZeroIsMattForOrenAndNayar) {
    const scene::Material material = materialOf({"", scene::OrenNayar{.roughness = 0}}, 0.6);
    truth::Random random(4, 0, 0);
    for (int i = 0; i < 100; ++i) {
        const vec3 toLight = anyAbove(random), toEye = anyAbove(random);
        EXPECT_FLOAT_EQ(shareOf(material, kUp, toLight, toEye).x, 0.6f * toLight.z / float(kPi));
    }
}

TEST(Reflector, CookAndTorranceAsPrintedAreFourTimesAsBright) {
    scene::Material normalised, printed;
    normalised.diffuse = printed.diffuse = vec3(0);
    normalised.kind = scene::CookTorrance{.roughness = 0.6f};
    printed.kind = scene::CookTorrance{.roughness = 0.6f, .asPrinted = true};
    truth::Random random(5, 0, 0);
    for (int i = 0; i < 100; ++i) {
        const vec3 toLight = anyAbove(random), toEye = anyAbove(random);
        // eq. 2.31 to 2.33 as they stand, with the tangent's minus
        const dvec3 l(toLight), v(toEye), h = glm::normalize(l + v);
        const double m = 0.36, cosine = h.z, tangent = std::sqrt(1 - cosine * cosine) / cosine;
        const double d = std::exp(-std::pow(tangent / m, 2)) / (m * m * std::pow(cosine, 4));
        const double turned = glm::dot(v, h);
        const double g = std::min({1.0, 2 * cosine * l.z / turned, 2 * cosine * v.z / turned});
        const double n = 1.5, gg = std::sqrt(n * n - 1 + turned * turned);
        const double a = (gg - turned) / (gg + turned),
                     b = (turned * (gg + turned) - 1) / (turned * (gg - turned) + 1);
        const double f = 0.5 * a * a * (1 + b * b);
        const double expected = f * d * g / (kPi * l.z * v.z) * l.z;
        EXPECT_NEAR(double(shareOf(printed, kUp, toLight, toEye).x), expected, 2e-5 * expected + 1e-6);
        EXPECT_NEAR(double(shareOf(printed, kUp, toLight, toEye).x),
                    4 * double(shareOf(normalised, kUp, toLight, toEye).x), 1e-5 * expected + 1e-7);
    }
}

TEST(Reflector, StaysFiniteAtGrazingAnglesAndAtTheEndsOfRoughness) {
    const double kAngles[] = {0, 0.5, 1.2, kPi / 2 - 1e-3, kPi / 2 - 1e-6, kPi / 2};
    for (const Case& one : kCases)
        for (const float roughness : {0.0f, 1e-4f, 1e-2f, 1.0f}) {
            scene::Material material = materialOf(one, 0.5);
            if (auto* m = std::get_if<scene::Glossy>(&material.kind)) m->roughness = roughness;
            if (auto* m = std::get_if<scene::CookTorrance>(&material.kind)) m->roughness = roughness;
            if (auto* m = std::get_if<scene::OrenNayar>(&material.kind)) m->roughness = roughness;
            for (const double light : kAngles)
                for (const double eye : kAngles)
                    for (const double around : {0.0, 1.0, kPi}) {
                        const vec3 share =
                            shareOf(material, kUp, direction(light, 0), direction(eye, around));
                        for (int c = 0; c < 3; ++c)
                            ASSERT_TRUE(std::isfinite(share[c]) && share[c] >= 0)
                                << one.name << " roughness " << roughness << " light " << light << " eye "
                                << eye << " around " << around << ": " << share[c];
                    }
        }
}

TEST(Reflector, DirectionsAreChosenAsOftenAsTheTruthSays) {
    // What lies in a quarter of the directions, by counting and by the density.
    for (const Case& one : kCases) {
        const truth::Gloss gloss(materialOf(one, 0.5), dvec3(kUp), dvec3(direction(0.7, 0)));
        truth::Random random(6, 0, 0);
        constexpr int kSamples = 200000;
        int counted = 0;
        double summed = 0;
        for (int i = 0; i < kSamples; ++i) {
            const dvec3 chosen = gloss.choose(random.nextPair());
            counted += chosen.z > 0 && chosen.x < 0 && chosen.y > 0;
            const dvec2 chance = random.nextPair(); // even over that quarter
            summed +=
                gloss.density(dvec3(direction(std::acos(chance.x), kPi * (0.5 + 0.5 * chance.y)))) * kPi / 2;
        }
        EXPECT_NEAR(double(counted) / kSamples, summed / kSamples, 0.012)
            << one.name; // noise of the sum: 0.4 %
    }
}

} // namespace
} // namespace lucent::brdf
