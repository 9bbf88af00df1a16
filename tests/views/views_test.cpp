// Views without GL: the min-max pyramid and the environment as lights.
#include "light/EnvironmentLights.h"
#include "light/Samples.h"
#include "tests/support/Fields.h"
#include "views/Eye.h"
#include "views/FieldTextures.h"

#include <gtest/gtest.h>

#include <random>

namespace lucent::views {
namespace {

struct Sizes : testing::TestWithParam<ivec2> {};
INSTANTIATE_TEST_SUITE_P(Pyramid, Sizes,
                         testing::Values(ivec2(1, 1), ivec2(1, 7), ivec2(2, 2), ivec2(33, 20),
                                         ivec2(257, 100), ivec2(64, 64)));

TEST_P(Sizes, EveryBlockBoundsTheHeightsOfItsCells) {
    const auto map = support::noise(GetParam());
    const HeightRange range = heightRange(*map);
    const double unit = (double(range.highest) - range.lowest) / 65535;
    const auto levels = buildPyramid(*map);
    for (std::size_t k = 0; k < levels.size(); ++k) {
        // Cell (i, j) lies between samples i - 1 and i; a block of level k holds 2^(k+1) cells on a side.
        const int edge = 2 << k;
        for (int y = 0; y <= map->height; ++y) {
            for (int x = 0; x <= map->width; ++x) {
                const std::size_t at = (std::size_t(y / edge) * levels[k].size.x + x / edge) * 2;
                for (int corner = 0; corner < 4; ++corner) {
                    const int i = glm::clamp(x - (corner & 1), 0, map->width - 1);
                    const int j = glm::clamp(y - (corner >> 1), 0, map->height - 1);
                    const double height = *map->at(i, j);
                    ASSERT_LE(range.lowest + levels[k].pairs[at] * unit, height + 1e-12);
                    ASSERT_GE(range.lowest + levels[k].pairs[at + 1] * unit, height - 1e-12);
                }
            }
        }
    }
}

// Memory is reused: the same place, size and border say nothing about what lies between.
TEST(HeightRange, IsThatOfTheMapThatNowHoldsItsMemory) {
    const auto first = std::make_shared<Image>(3, 3, 1);
    *first->at(1, 1) = 1;
    scene::Object object;
    object.shape = scene::HeightField();
    object.field().heightScale = 1;
    object.field().heights = first;
    EXPECT_EQ(boundsOf(object).high.z, 1);
    const auto second = std::make_shared<Image>();
    std::swap(*first, *second);
    *second->at(1, 1) = 5;
    object.field().heights = second;
    EXPECT_EQ(boundsOf(object).high.z, 5);
}

TEST_P(Sizes, LevelsHalveExactlyAsTexturesDo) {
    const auto levels = buildPyramid(*support::noise(GetParam()));
    for (std::size_t k = 1; k < levels.size(); ++k)
        EXPECT_EQ(levels[k].size * 2, levels[k - 1].size);
    EXPECT_GE(levels[0].size.x * 2, GetParam().x + 1);
    EXPECT_GE(levels[0].size.y * 2, GetParam().y + 1);
}

std::shared_ptr<const Image> mapOf(ivec2 size, const std::function<vec3(int, int)>& color) {
    auto image = std::make_shared<Image>(size.x, size.y, 3);
    for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
            const vec3 c = color(x, y);
            std::copy_n(&c[0], 3, image->at(x, y));
        }
    }
    return image;
}

TEST(EnvironmentLights, WeightsCoverTheSphereOnce) {
    scene::Environment environment;
    environment.map = mapOf({64, 32}, [](int, int) { return vec3(1); });
    for (int count : {6, 20, 256, 1000})
        for (const vec2 offset : {vec2(0), vec2(0.4f, 0.2f), vec2(0.8f, 0.4f)}) {
            double sum = 0;
            vec3 balance(0);
            const auto lights = environmentLights(environment, count, offset);
            for (const EnvironmentLight& light : lights) {
                sum += light.weight;
                balance += light.weight * light.direction;
                EXPECT_NEAR(glm::length(light.direction), 1, 1e-6);
                EXPECT_NEAR(light.radiance.g, 1, 1e-6); // a mean of ones
            }
            EXPECT_NEAR(sum, 1, 1e-6);
            const bool isSymmetric = offset == vec2(0); // then it has no favourite direction
            EXPECT_NEAR(glm::length(balance), 0, isSymmetric ? 1e-6 : 0.02) << count;
            EXPECT_NEAR(double(lights.size()), count, 0.3 * count + 6);
        }
}

TEST(EnvironmentLights, TheMeanIsWeightedBySolidAngleNotByPixels) {
    // White where y > 1/2 of the way to the pole: polar angle below 60 degrees, a cap of (1 - cos 60)/2 = 1/4
    // of the sphere, though it fills a third of the map's rows.
    scene::Environment environment;
    environment.map = mapOf({96, 48}, [](int, int y) { return vec3(y < 16 ? 1 : 0); });
    vec3 mean(0);
    for (const EnvironmentLight& light : environmentLights(environment, 256))
        mean += light.weight * light.radiance;
    EXPECT_NEAR(mean.r, 0.25, 1e-6);
}

// A cell stands where its light comes from, not in its own middle: of a window that cuts cells the light's
// mean direction stays, and with it the irradiance of every surface that sees all of it.
TEST(EnvironmentLights, AWindowKeepsTheMeanDirectionOfItsLight) {
    scene::Environment environment;
    environment.map =
        mapOf({64, 32}, [](int x, int y) { return vec3(y >= 3 && y < 10 && x >= 36 && x < 48 ? 8 : 0); });
    const auto centroid = [&](int count) {
        glm::dvec3 sum(0);
        for (const EnvironmentLight& light : environmentLights(environment, count))
            sum += double(light.weight * light.radiance.g) * glm::dvec3(light.direction);
        return sum;
    };
    const glm::dvec3 exact = centroid(20000);
    for (const int count : {64, 256, 1024}) {
        // A unit direction for a cell's mean one, which is shorter by its squared width over 8, or over 4.
        const double cell = std::sqrt(4 * std::numbers::pi / count);
        EXPECT_LT(glm::distance(centroid(count), exact) / glm::length(exact), cell * cell / 4) << count;
        EXPECT_GT(glm::dot(glm::normalize(centroid(count)), glm::normalize(exact)), 0.9999) << count;
    }
}

// Few lights are found in fewer pixels than a map has.
TEST(EnvironmentLights, AMapOfMorePixelsThatShowsTheSameSendsTheSame) {
    const auto shown = [](int x, int y) { return vec3(1 + (7 * x + 13 * y) % 11, x % 5, y % 3); };
    scene::Environment coarse, fine;
    coarse.map = mapOf({64, 32}, shown);
    fine.map = mapOf({1024, 512}, [&](int x, int y) { return shown(x / 16, y / 16); });
    for (const int count : {6, 20, 64, 512}) {
        const auto few = environmentLights(coarse, count, {0.3f, 0.6f});
        const auto many = environmentLights(fine, count, {0.3f, 0.6f});
        ASSERT_EQ(few.size(), many.size());
        for (std::size_t i = 0; i < few.size(); ++i) {
            EXPECT_NEAR(glm::distance(few[i].radiance, many[i].radiance), 0,
                        1e-4f * glm::length(few[i].radiance));
            EXPECT_NEAR(few[i].weight, many[i].weight, 1e-6);
            // Within a large pixel the light lies where the solid angle does, not in the middle.
            EXPECT_LT(glm::distance(few[i].direction, many[i].direction), 0.005f);
        }
    }
}

TEST(EnvironmentLights, DirectionsFollowTheMapConvention) {
    // One bright pixel right of the centre, on the horizon: centre column is -z, to the right +x.
    scene::Environment environment;
    environment.map = mapOf({64, 32}, [](int x, int y) { return vec3(x == 48 && y == 16 ? 1 : 0); });
    vec3 mean(0);
    for (const EnvironmentLight& light : environmentLights(environment, 4000))
        mean += light.weight * light.radiance.r * light.direction;
    EXPECT_GT(glm::dot(glm::normalize(mean), vec3(1, 0, 0)), 0.99);
    // Turned by 90 degrees about +y, +x goes to -z.
    environment.rotation = {0, 90, 0};
    mean = vec3(0);
    for (const EnvironmentLight& light : environmentLights(environment, 4000))
        mean += light.weight * light.radiance.r * light.direction;
    EXPECT_GT(glm::dot(glm::normalize(mean), vec3(0, 0, -1)), 0.99);
}

// Of a place that sees less than half of the sky, as shadows are: what reaches it.
double reaching(const std::vector<EnvironmentLight>& lights, const vec3& normal) {
    double sum = 0;
    for (const EnvironmentLight& light : lights)
        if (glm::dot(light.direction, normal) > 0.3f) sum += double(light.weight * light.radiance.g);
    return sum;
}

// How far one of five sets of directions is from the light that reaches places, and how far their mean is.
struct Apart {
    double alone = 0, together = 0;
};
Apart apart(const scene::Environment& environment,
            const std::function<std::vector<EnvironmentLight>(int sample, int samples)>& lightsOf) {
    Apart apart;
    constexpr int kNormals = 40, kSamples = 5;
    for (int i = 0; i < kNormals; ++i) {
        const float z = 1 - 2 * (float(i) + 0.5f) / kNormals, turn = 2.4f * float(i);
        const vec3 normal(std::sqrt(1 - z * z) * vec2(std::cos(turn), std::sin(turn)), z);
        const double exact = reaching(environmentLights(environment, 40000), normal);
        double mean = 0;
        for (int sample = 0; sample < kSamples; ++sample)
            mean += reaching(lightsOf(sample, kSamples), normal) / kSamples;
        apart.alone += std::abs(reaching(lightsOf(0, 1), normal) - exact);
        apart.together += std::abs(mean - exact);
    }
    return apart;
}

// The light samples of a pixel's samples stand for the same light from other directions.
TEST(EnvironmentLights, SetsAreNearerToTheLightTogether) {
    scene::Environment environment;
    environment.map = mapOf({256, 128}, [](int x, int y) { return vec3(x < 100 && y < 40 ? 5 : 1); });
    const Apart evenly = apart(environment, [&](int sample, int samples) {
        return environmentLights(environment, 256, lightOffset(sample, samples));
    });
    EXPECT_LT(evenly.together, 0.5 * evenly.alone); // of independent ones 1 / sqrt(5)
    const Apart byImportance = apart(environment, [&](int sample, int samples) {
        return importanceLights(environment, 64, sample, samples);
    });
    EXPECT_LT(byImportance.together, 0.5 * byImportance.alone);
}

// What is too small to be cut is the same in all samples, and each carries about all light; together they do
// exactly.
TEST(EnvironmentLights, SetsByImportanceCarryTheLightTogether) {
    constexpr int kSamples = 5;
    scene::Environment environment;
    environment.map = mapOf({64, 32}, [](int x, int y) { return vec3(x == 20 && y == 9 ? 1e4f : float(y)); });
    const auto flux = [](const std::vector<EnvironmentLight>& lights) {
        double sum = 0;
        for (const EnvironmentLight& light : lights)
            sum += double(light.weight) * double(light.radiance.g);
        return sum;
    };
    const double exact = flux(environmentLights(environment, 256));
    double mean = 0;
    for (int sample = 0; sample < kSamples; ++sample) {
        const auto lights = importanceLights(environment, 20, sample, kSamples);
        EXPECT_EQ(lights.size(), 20u);
        EXPECT_NEAR(flux(lights) / exact, 1, 0.5); // no piece has twice its share; had one the sun, 4.5
        mean += flux(lights) / kSamples;
    }
    EXPECT_NEAR(mean / exact, 1, 1e-5);
}

TEST(EnvironmentLights, AFullTurnKeepsEveryLight) {
    scene::Environment environment;
    environment.map = mapOf({64, 32}, [](int x, int y) { return vec3(float(x), float(y), 1); });
    const auto before = environmentLights(environment, 256);
    environment.rotation = {360, -360, 720};
    const auto after = environmentLights(environment, 256);
    ASSERT_EQ(before.size(), after.size());
    for (std::size_t i = 0; i < before.size(); ++i) {
        // 720 degrees in float radians are off by 2e-7 of a turn at most
        EXPECT_NEAR(glm::distance(before[i].direction, after[i].direction), 0, 5e-6);
        EXPECT_EQ(before[i].radiance, after[i].radiance);
    }
}

TEST(Eye, PutsItsPlanesAroundTheObjects) {
    scene::Scene scene = support::sceneOf(support::waves({16, 16}), 0.2f, 0.05f);
    for (float distance : {0.5f, 2.0f, 1e4f}) {
        scene.camera.eye = {0, 0, distance};
        const Eye eye = makeEye(scene, 1);
        for (float z : {0.0f, 0.2f}) {
            const vec4 clip = eye.clipFromWorld * vec4(0.3f, -0.3f, z, 1);
            EXPECT_LT(std::abs(clip.z), clip.w) << distance;
        }
    }
}

} // namespace
} // namespace lucent::views
