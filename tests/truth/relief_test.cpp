#include "truth/Relief.h"

#include "tests/truth/fields.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace lucent::truth {
namespace {
using test::fieldOf;
using test::noise;
using test::Random;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kDegree = std::numbers::pi / 180;

LightSource distant(const dvec3& toLight) {
    LightSource light;
    light.place = glm::normalize(toLight);
    light.distant = true;
    return light;
}
LightSource at(const dvec3& position) {
    LightSource light;
    light.place = position;
    return light;
}
dvec3 elevated(double degrees, double azimuth = 0) {
    const double e = degrees * kDegree;
    return {std::cos(e) * std::cos(azimuth), std::cos(e) * std::sin(azimuth), std::sin(e)};
}

TEST(Relief, FlatFieldGivesTheSineOfTheElevationAtEveryDepth) {
    for (const double depth : {1e-6, 1e-3, 0.05, 1.0, 10.0})
        for (const double elevation : {0.5, 1.0, 5.0, 17.0, 30.0, 45.0, 60.0, 89.0, 90.0}) {
            // Wide enough that the way to the surface, depth / tan(elevation) aside, does not meet the
            // border.
            const double width = 4 * depth + 3 * depth / std::tan(elevation * kDegree) + 1e-6;
            const Field field = fieldOf(1024, 1, float(width), 0.1f, [](int, int) { return 0.7f; });
            const SurfacePoint point = field.pointAbove({0, 0});
            EXPECT_NEAR(illumination(field, point, depth, distant(elevated(elevation)), Attenuation::Ratio),
                        std::sin(elevation * kDegree), 1e-12)
                << "depth " << depth << ", elevation " << elevation;
        }
}

TEST(Relief, BelowHalfATexelTheFlatFieldKeepsItsSine) {
    const Field field = fieldOf(16, 16, 1, 0.1f, [](int, int) { return 0.7f; });
    for (const double elevation : {1.0, 30.0, 90.0})
        EXPECT_NEAR(illumination(field, field.pointAbove({0.1, 0.2}), 1e-6, distant(elevated(elevation, 1)),
                                 Attenuation::Ratio),
                    std::sin(elevation * kDegree), 1e-12);
}

TEST(Relief, TheLimitHoldsBelowHalfATexelOnly) {
    // Light along the surface: the limit gives the cosine, 0; the length ends at the border, 0.4 m aside.
    const Field field = fieldOf(8, 8, 1, 0.1f, [](int, int) { return 0.5f; });
    const SurfacePoint point = field.pointAbove({0.1, 0});
    EXPECT_EQ(illumination(field, point, 0.0624, distant({1, 0, 0}), Attenuation::Ratio), 0);
    EXPECT_NEAR(illumination(field, point, 0.0625, distant({1, 0, 0}), Attenuation::Ratio), 0.0625 / 0.4,
                1e-12);
}

TEST(Relief, ExponentialAttenuationOfAFlatFieldIsThatOfOneOverTheSine) {
    const Field field = fieldOf(64, 64, 1, 0.1f, [](int, int) { return 0.7f; });
    // r = t / sin(30 degrees) = 2 t, so d = exp(1 - 2), as measured length and as the limit for small depths.
    for (const double depth : {0.05, 1e-5})
        EXPECT_NEAR(illumination(field, field.pointAbove({0, 0}), depth, distant(elevated(30)),
                                 Attenuation::Exponential),
                    std::exp(-1.0), 1e-12);
}

TEST(Relief, TiltedPlaneGivesTheCosineForEverySlope) {
    // Heights i/64 and scales that are powers of two are exact in float, so the plane is one.
    for (const float scale : {0.25f, 1.0f, 4.0f})
        for (const int across : {0, 1, -2}) {
            const Field field =
                fieldOf(64, 64, 1, scale, [&](int x, int y) { return float(x + across * y) / 64; });
            const SurfacePoint point = field.pointAbove({0.01, -0.02});
            for (const double elevation : {20.0, 45.0, 80.0})
                for (double azimuth = 0; azimuth < 6; azimuth += 0.7) {
                    const dvec3 light = elevated(elevation, azimuth);
                    const double cosine = glm::dot(point.normal, light);
                    if (cosine < 0.2) continue; // the way through the plane would meet the border
                    EXPECT_NEAR(illumination(field, point, 0.02, distant(light), Attenuation::Ratio), cosine,
                                1e-12)
                        << "scale " << scale << ", elevation " << elevation << ", azimuth " << azimuth;
                }
        }
}

TEST(Relief, ShadowOfABlockIsAsLongAsItsTrapezoidSays) {
    // Texels of 1 m, a block 8 m high on the texels 8 to 10 of a floor at 0, ramps of one texel beside it.
    // From 1 m below texel 2 at 45 degrees, in texel indices: z = X - 3. The way is in the ground for X in
    // [2, 3], meets the ramp 8 (X - 7) at X = 53/7 and leaves by the ramp 8 (11 - X) at X = 91/9.
    const Field field = fieldOf(16, 1, 16, 8, [](int x, int) { return x >= 8 && x <= 10 ? 1.f : 0.f; });
    const SurfacePoint point = field.pointAbove({2.5 - 8, 0});
    const double root2 = std::sqrt(2.0);
    const double r = root2 * (1 + 91.0 / 9 - 53.0 / 7);
    EXPECT_NEAR(illumination(field, point, 1, distant({1, 0, 1}), Attenuation::Ratio), 1 / r, 1e-13);
    EXPECT_NEAR(illumination(field, point, 1, distant({1, 0, 1}), Attenuation::Exponential), std::exp(1 - r),
                1e-13);

    // A lamp inside the block, at X = 9, ends the way there.
    const double untilLamp = root2 * (1 + 9 - 53.0 / 7);
    EXPECT_NEAR(illumination(field, point, 1, at({9.5 - 8, 0, 6}), Attenuation::Ratio), 1 / untilLamp, 1e-13);
}

TEST(Relief, DiagonalThroughASpikeIsAParabola) {
    // Beside a spike of height 1 the surface is (1 - |u|)(1 - |v|). On the diagonal u = v the level z is left
    // at |u| = 1 - sqrt(z).
    const Field field = fieldOf(9, 9, 9, 1, [](int x, int y) { return x == 4 && y == 4 ? 1.f : 0.f; });
    for (const double z : {0.01, 0.25, 0.81}) {
        const Ray ray{{-4, -4, z}, {0, 0, 0}, glm::normalize(dvec3(1, 1, 0))};
        EXPECT_NEAR(insideLength(field, ray, {0, kInfinity}), 2 * std::sqrt(2.0) * (1 - std::sqrt(z)), 1e-13);
    }
}

TEST(Relief, LengthAgreesWithAMillionSamplesOfTheSegment) {
    constexpr int kSamples = 1'000'000;
    Random random(5);
    for (int trial = 0; trial < 24; ++trial) {
        const Field field = fieldOf(23, 14, 1, 0.4f, noise(unsigned(trial)));
        const dvec2 half = field.half();
        const SurfacePoint point =
            field.pointAbove({random.between(-half.x, half.x), random.between(-half.y, half.y)});
        const LightPath path =
            lightPath(point, 0.05,
                      at({random.between(-0.8, 0.8), random.between(-0.6, 0.6), random.between(-0.1, 0.9)}));
        const Ray ray{point.position, -0.05 * point.normal, path.direction};

        int inside = 0;
        const double step = path.distance / kSamples;
        for (int i = 0; i < kSamples; ++i) {
            const dvec3 place = ray.anchor + ray.offset + (i + 0.5) * step * ray.direction;
            if (std::abs(place.x) < half.x && std::abs(place.y) < half.y &&
                place.z < field.height(dvec2(place)))
                ++inside;
        }
        // Every crossing of the surface misplaces at most half a step, and a way of 37 pieces has at most 75.
        EXPECT_NEAR(insideLength(field, ray, {0, path.distance}), inside * step, 75 * 0.5 * step)
            << "trial " << trial;
    }
}

TEST(Relief, ElevationZeroRunsThroughTheGroundToTheBorder) {
    const Field field = fieldOf(8, 8, 1, 0.1f, [](int, int) { return 0.5f; });
    // From x = 0.1 it is 0.4 m to the border.
    EXPECT_NEAR(illumination(field, field.pointAbove({0.1, 0}), 0.1, distant({1, 0, 0}), Attenuation::Ratio),
                0.25, 1e-12);
}

TEST(Relief, ElevationOfATenthOfADegreeReachesTheBorderBeforeTheSurface) {
    const Field field = fieldOf(8, 8, 1, 0.1f, [](int, int) { return 0.5f; });
    // 0.1 / tan(0.1 degrees) = 57 m: the way inside ends at the border, 0.4 m aside.
    EXPECT_NEAR(
        illumination(field, field.pointAbove({0.1, 0}), 0.1, distant(elevated(0.1)), Attenuation::Ratio),
        0.1 / (0.4 / std::cos(0.1 * kDegree)), 1e-12);
}

TEST(Relief, LightExactlyAboveATexelSeesItFully) {
    const Field field = fieldOf(8, 8, 1, 0.1f, [](int, int) { return 0.5f; });
    const SurfacePoint point = field.pointAbove({0.0625, 0.0625});
    EXPECT_DOUBLE_EQ(illumination(field, point, 0.1, at({0.0625, 0.0625, 2}), Attenuation::Ratio), 1);
    EXPECT_DOUBLE_EQ(illumination(field, point, 1e-6, at({0.0625, 0.0625, 2}), Attenuation::Ratio), 1);
}

TEST(Relief, LightInsideTheSolidCountsTheWayUpToIt) {
    const Field field = fieldOf(8, 8, 1, 0.1f, [](int, int) { return 0.5f; });
    const SurfacePoint point = field.pointAbove({0, 0}); // z = 0.05, so p' is at z = -0.05
    EXPECT_NEAR(illumination(field, point, 0.1, at({0.3, 0, -0.05}), Attenuation::Ratio), 0.1 / 0.3, 1e-8);
    EXPECT_EQ(illumination(field, point, 0.1, at({0.05, 0, -0.05}), Attenuation::Ratio), 1); // r <= t
    EXPECT_EQ(illumination(field, point, 1e-6, at({0.3, 0, 0.04}), Attenuation::Ratio),
              0); // below the horizon
}

TEST(Relief, LightUnderTheFieldShinesThroughAllThatIsAboveIt) {
    const Field field = fieldOf(8, 8, 1, 0.0f, [](int, int) { return 0.5f; });
    // The field is at z = 0, p' at -0.1, the lamp 2 m under p': no floor, so r = 2.
    EXPECT_NEAR(illumination(field, field.pointAbove({0, 0}), 0.1, at({0, 0, -2.1}), Attenuation::Ratio),
                0.05, 1e-12);
    EXPECT_EQ(illumination(field, field.pointAbove({0, 0}), 0.1, distant({0, 0, -1}), Attenuation::Ratio), 0);
    EXPECT_EQ(
        illumination(field, field.pointAbove({0, 0}), 0.1, distant({0, 0, -1}), Attenuation::Exponential), 0);
}

TEST(Relief, LightAtAMillionMetresIsAsGoodAsDistant) {
    const Field field = fieldOf(32, 32, 1, 0.3f, noise(3));
    const SurfacePoint point = field.pointAbove({0.11, -0.2});
    const dvec3 direction = elevated(35, 2);
    // The directions differ by the field's size over the distance.
    EXPECT_NEAR(illumination(field, point, 0.05, at(1e6 * direction), Attenuation::Ratio),
                illumination(field, point, 0.05, distant(direction), Attenuation::Ratio), 1e-5);
}

TEST(Relief, NearLightAboveAFlatFieldSeesTheCosineOfItsOwnDirection) {
    const Field field = fieldOf(8, 8, 1, 0.1f, [](int, int) { return 0.5f; });
    const SurfacePoint point = field.pointAbove({0, 0});
    // p' is 0.1 m under the surface, the lamp 1e-4 over it and 1e-4 aside: r is the part of the way below.
    const dvec3 lamp = point.position + dvec3(1e-4, 0, 1e-4);
    const double length = std::hypot(1e-4, 0.1 + 1e-4) * 0.1 / (0.1 + 1e-4);
    EXPECT_NEAR(illumination(field, point, 0.1, at(lamp), Attenuation::Ratio), 0.1 / length, 1e-9);
    // In the limit form the same lamp stands at 45 degrees, less the depth of 1e-6.
    EXPECT_NEAR(illumination(field, point, 1e-6, at(lamp), Attenuation::Ratio),
                (1e-4 + 1e-6) / std::hypot(1e-4, 1e-4 + 1e-6), 1e-9);
}

TEST(Relief, HardFieldsAndLightsNeverLeaveTheUnitInterval) {
    const auto cliffs = [](int x, int y) { return float((x / 3 + y / 2) % 2); };
    const auto spike = [](int x, int y) { return x == 1 && y == 1 ? 1.f : 0.f; };
    Random random(11);
    for (const ivec2 size : {ivec2(1, 1), ivec2(1, 7), ivec2(7, 1), ivec2(13, 10)})
        for (const float scale : {0.f, 0.1f, 1e4f})
            for (const auto& heights : {std::function<float(int, int)>(noise(1)), {cliffs}, {spike}}) {
                const Field field = fieldOf(size.x, size.y, 1, scale, heights);
                const SurfacePoint point = field.pointAbove(field.half() * dvec2(random.between(-1, 1), 0.3));
                const dvec3 under = point.position - dvec3(0, 0, 0.02);
                for (const double depth : {1e-6, 0.05, 10.0})
                    for (const LightSource& light :
                         {distant({1, 0, 0}), distant(elevated(0.1, 1)), distant({0, 0, 1}),
                          distant({0, 0, -1}), at(point.position + dvec3(0, 0, 1)), at(point.position),
                          at(under), at(point.position - depth * point.normal),
                          at(point.position + dvec3(1e-4, 0, 0)), at({1e6, 2e6, 3e5}), at({0, 0, -5})})
                        for (const Attenuation attenuation : {Attenuation::Ratio, Attenuation::Exponential}) {
                            const double d = illumination(field, point, depth, light, attenuation);
                            EXPECT_TRUE(d >= 0 && d <= 1) << d << " at " << size.x << "x" << size.y
                                                          << ", scale " << scale << ", depth " << depth;
                        }
            }
}

TEST(Relief, ATurnOfFieldAndLightByNinetyDegreesChangesNothing) {
    constexpr int kSize = 12;
    const auto heights = noise(21);
    const Field field = fieldOf(kSize, kSize, 1, 0.3f, heights);
    // A turn by +90 degrees moves (x, y) to (-y, x): the texel at column c, row r comes from column
    // kSize-1-r, row c.
    const Field turned =
        fieldOf(kSize, kSize, 1, 0.3f, [&](int x, int y) { return heights(kSize - 1 - y, x); });
    Random random(4);
    for (int trial = 0; trial < 200; ++trial) {
        const dvec2 place{random.between(-0.5, 0.5), random.between(-0.5, 0.5)};
        const dvec3 lamp{random.between(-1, 1), random.between(-1, 1), random.between(0, 1)};
        const double depth = trial % 2 ? 0.06 : 1e-3;
        EXPECT_NEAR(illumination(field, field.pointAbove(place), depth, at(lamp), Attenuation::Ratio),
                    illumination(turned, turned.pointAbove({-place.y, place.x}), depth,
                                 at({-lamp.y, lamp.x, lamp.z}), Attenuation::Ratio),
                    1e-12);
    }
}

TEST(Relief, IlluminationNeverRisesWhenABlockerIsAddedOutsideTheNeighbours) {
    constexpr int kSize = 16;
    Random random(9);
    for (int trial = 0; trial < 300; ++trial) {
        const auto heights = noise(unsigned(trial));
        const ivec2 centre{int(random.between(0, kSize)), int(random.between(0, kSize))};
        const ivec2 blocker{int(random.between(0, kSize)), int(random.between(0, kSize))};
        if (std::max(std::abs(blocker.x - centre.x), std::abs(blocker.y - centre.y)) <= 1) continue;
        const Field before = fieldOf(kSize, kSize, 1, 0.2f, heights);
        const Field after = fieldOf(kSize, kSize, 1, 0.2f, [&](int x, int y) {
            return heights(x, y) + (ivec2(x, y) == blocker ? 2.f : 0.f);
        });
        const dvec2 place = dvec2(centre.x + 0.5, kSize - centre.y - 0.5) / double(kSize) - 0.5;
        const LightSource light = distant(elevated(random.between(0, 60), random.between(0, 6.28)));
        for (const double depth : {1e-3, 0.05})
            EXPECT_LE(illumination(after, after.pointAbove(place), depth, light, Attenuation::Ratio),
                      illumination(before, before.pointAbove(place), depth, light, Attenuation::Ratio) +
                          1e-12);
    }
}

TEST(Relief, VisibilityLooksPastOneTexelOnly) {
    // A wall on texel 8 of 16; its ramp begins at the centre of texel 7.
    const Field field = fieldOf(16, 1, 16, 5, [](int x, int) { return x == 8 ? 1.f : 0.f; });
    const auto centre = [](double texel) { return dvec2(texel + 0.5 - 8, 0); };
    const LightSource grazing = distant({1, 0, 0.01});
    EXPECT_FALSE(visible(field, field.pointAbove(centre(4)), grazing));
    EXPECT_TRUE(visible(field, field.pointAbove(centre(10)), grazing));
    EXPECT_TRUE(visible(field, field.pointAbove(centre(4)), distant({0, 0, 1})));
    // A lamp nearer than one texel is never hidden, and one in front of the wall is not hidden by it.
    EXPECT_TRUE(visible(field, field.pointAbove(centre(6.5)), at(dvec3(centre(7.25), 0.1))));
    EXPECT_TRUE(visible(field, field.pointAbove(centre(4)), at(dvec3(centre(6.5), 1))));
    // A lamp inside the wall is.
    EXPECT_FALSE(visible(field, field.pointAbove(centre(4)), at(dvec3(centre(8), 1))));
}

TEST(Relief, NormalsUseWorldUnitsAndOneSidedDifferencesAtTheBorder) {
    // Texels of 0.5 m; heights 0, 1, 4 times 0.25: slopes 0.25/0.5, 1/1, 0.75/0.5 at the three centres.
    const Field field = fieldOf(3, 1, 1.5f, 0.25f, [](int x, int) { return float(x * x); });
    const double slopes[] = {0.5, 1, 1.5};
    for (int i = 0; i < 3; ++i) {
        const dvec3 normal = field.normal({-0.5 + 0.5 * i, 0.1});
        EXPECT_NEAR(-normal.x / normal.z, slopes[i], 1e-14);
        EXPECT_EQ(normal.y, 0);
    }
    // Row 0 is at +y: a field that falls from the first row to the second rises with y.
    const Field column = fieldOf(1, 2, 1, 1, [](int, int y) { return y == 0 ? 1.f : 0.f; });
    EXPECT_NEAR(-column.normal({0, 0}).y / column.normal({0, 0}).z, 1, 1e-14);
}

// A flat field lit and seen from above, with numbers that can be followed by hand.
scene::Object flatObject() {
    scene::Object object;
    object.shape = test::shapeOf(4, 4, 1, 0.1f, [](int, int) { return 0.5f; });
    object.material.base = {0.1f, 0.2f, 0.3f};
    object.material.diffuse = {0.5f, 0.25f, 1};
    object.material.relief().specular = {1, 0.5f, 0.25f};
    object.material.relief().depth = 0.25f;
    return object;
}
constexpr dvec3 kDown{0, 0, -1};

TEST(ReliefShading, AddsBaseDiffuseAndSpecularWithTheirWeights) {
    scene::Object object = flatObject();
    object.material.relief().specularity = 0.25f;
    const Field field(object.field());
    LightSource light = distant({0, 0, 1});
    light.color = {2, 2, 2};
    // From above d = 1, f = clamp(-1) = 0, s = 1: c = 0.75 (cB + cD 2) + 0.25 cS 2.
    const Shading shading =
        shade(field, object, field.pointAbove({0, 0}), kDown, {{light}, {}}, Attenuation::Ratio);
    const dvec3 expected =
        0.75 * (dvec3(0.1f, 0.2f, 0.3f) + 2.0 * dvec3(0.5, 0.25, 1)) + 0.5 * dvec3(1, 0.5, 0.25);
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(shading.color[channel], expected[channel], 1e-12);
    EXPECT_NEAR(shading.illumination, 1, 1e-12);
}

TEST(ReliefShading, SpecularIsOneWhereTheNormalIsHalfway) {
    scene::Object object = flatObject();
    object.material.relief().specularity = 1;
    // The plane z = x / 2 under a light in the mirror direction of the eye: s = 1 and nothing else is left.
    object.shape = test::shapeOf(64, 64, 1, 0.5f, [](int x, int) { return float(x) / 64; });
    const Field field(object.field());
    const SurfacePoint point = field.pointAbove({0, 0});
    const dvec3 mirrored = 2 * point.normal.z * point.normal - dvec3(0, 0, 1);
    const LightSource light = distant(mirrored);
    const Shading shading = shade(field, object, point, kDown, {{light}, {}}, Attenuation::Ratio);
    EXPECT_NEAR(shading.color.r, 1, 1e-12);
    EXPECT_NEAR(shading.color.g, 0.5, 1e-12);
}

TEST(ReliefShading, ForwardScatterFollowsTheAngleBetweenEyeAndLight) {
    scene::Object object = flatObject();
    object.material.base = vec3(0);
    object.material.relief().forwardScatter = 0.5f;
    const Field field(object.field());
    // A lamp straight below: f = v . l = 1, so the factor (1 - kf) + kf f is 1; at 30 degrees under the
    // horizon f = 1/2 and the factor 3/4. Both are half a metre of ground away from a point 0.25 m deep: d =
    // 1/2.
    for (const auto& [elevation, factor] : {std::pair{-90.0, 1.0}, std::pair{-30.0, 0.75}}) {
        const LightSource light =
            at(field.pointAbove({0, 0}).position + dvec3(0, 0, -0.25) + 0.5 * elevated(elevation));
        const Shading shading =
            shade(field, object, field.pointAbove({0, 0}), kDown, {{light}, {}}, Attenuation::Ratio);
        EXPECT_NEAR(shading.illumination, 0.5, 1e-12);
        EXPECT_NEAR(shading.color.b, factor * 0.5, 1e-12);
    }
}

TEST(ReliefShading, FalloffsRemapAndAStepNeedsNoDivision) {
    scene::Object object = flatObject();
    object.material.relief().specularity = 1;
    const Field field(object.field());
    const LightSource light = distant(elevated(30)); // s = sin(30 degrees) = 1/2
    const auto specular = [&](vec2 falloff) {
        object.material.relief().specularFalloff = falloff;
        return shade(field, object, field.pointAbove({0, 0}), kDown, {{light}, {}}, Attenuation::Ratio)
            .color.r;
    };
    EXPECT_NEAR(specular({0, 1}), 0.5, 1e-12);
    EXPECT_NEAR(specular({0.25f, 0.75f}), 0.5, 1e-12);
    EXPECT_NEAR(specular({0, 0.25f}), 1, 1e-12);
    EXPECT_EQ(specular({0.75f, 1}), 0);
    EXPECT_EQ(specular({0.4f, 0.4f}), 1);
    EXPECT_EQ(specular({0.6f, 0.6f}), 0);
}

TEST(ReliefShading, InverseSquareFalloffUsesWorldMetres) {
    scene::Object object = flatObject();
    object.material.base = vec3(0);
    object.transform.scale = 2;
    const Field field(object.field());
    LightSource light = at(field.pointAbove({0, 0}).position + dvec3(0, 0, 1));
    light.inverseSquare = true;
    // A depth of 0.25 m is 0.125 m of the object: from there to the lamp it is 1.125, in the world 2.25 m.
    const Shading shading =
        shade(field, object, field.pointAbove({0, 0}), kDown, {{light}, {}}, Attenuation::Ratio);
    EXPECT_NEAR(shading.color.b, 1 / (2.25 * 2.25), 1e-12);
}

TEST(ReliefShading, ColourMapsMultiplyBilinearlyAndAreClampedAtTheBorder) {
    scene::Object object = flatObject();
    auto map = std::make_shared<Image>(2, 1, 3);
    map->pixels = {0, 0, 0, 1, 1, 1};
    object.material.base = vec3(1);
    object.material.baseMap = map;
    const Field field(object.field());
    const auto red = [&](double x) {
        return shade(field, object, field.pointAbove({x, 0}), kDown, {}, Attenuation::Ratio).color.r;
    };
    EXPECT_NEAR(red(-0.45), 0, 1e-12);
    EXPECT_NEAR(red(0), 0.5, 1e-12);
    EXPECT_NEAR(red(0.125), 0.75, 1e-12);
    EXPECT_NEAR(red(0.45), 1, 1e-12);
}

} // namespace
} // namespace lucent::truth
