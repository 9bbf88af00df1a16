#include "scene/Keys.h"
#include "scene/Scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lucent::scene {
namespace {

TEST(Material, AbsorptionIsTheLogarithmOfTheColourOverTheDistance) {
    EXPECT_EQ(absorptionOf({}), vec3(0)); // a distance of 0 absorbs nothing
    EXPECT_EQ(absorptionOf({0, {1, 0.5f, 0.25f}}), vec3(0));
    const vec3 absorption = absorptionOf({2, {1, 0.5f, 0.25f}});
    EXPECT_EQ(absorption.x, 0);
    EXPECT_FALSE(std::signbit(absorption.x));
    EXPECT_FLOAT_EQ(absorption.y, 0.34657359f); // ln 2 / 2
    EXPECT_FLOAT_EQ(absorption.z, 0.69314718f); // ln 4 / 2
}

TEST(Material, AnyAbsorptionHasAColourAndADistance) {
    // Clear water, ink, dark glass of a millimetre, the ends of the range, and channels a hundredfold apart.
    for (const vec3 sigma : {vec3(0), vec3(0.45f, 0.07f, 0.02f), vec3(5e4f), vec3(800, 3000, 20000),
                             vec3(1e9f, 0, 1e8f), vec3(1e-9f, 2e-9f, 0), vec3(100, 1, 50)}) {
        const Attenuation words = attenuationOf(sigma, 0);
        for (int i = 0; i < 3; ++i)
            // A colour just below 1 is stored to 2^-25, of which its logarithm, ln 2 / 100 here, tells 4e-6.
            EXPECT_NEAR(absorptionOf(words)[i], sigma[i], 5e-6 * sigma[i]) << sigma.x;
        for (const Param& param : attenuationParams().params)
            EXPECT_TRUE(checkRange(param, reinterpret_cast<const std::byte*>(&words) + param.offset))
                << param.id; // a file could say it as well
    }
}

TEST(Material, EachKindHasItsKeys) {
    Object ball;
    ball.shape = Sphere{};
    const auto isKey = [&](const MaterialKinds& kind, std::string_view key) {
        ball.material.kind = kind;
        return whyIdle(ball, key).empty();
    };
    const MaterialKinds kinds[] = {Relief{}, Matt{}, Mirror{}, Clear{}, Translucent{}};
    const std::pair<std::string_view, std::string_view> keys[] = {
        {"diffuse", "11000"},    {"depth", "10000"},      {"diffuseMap", "10000"}, {"ior", "00011"},
        {"absorption", "00011"}, {"dispersion", "00010"}, {"anisotropy", "00001"}, {"layers", "00001"},
        {"kind", "11111"},       {"reflectance", "11111"}}; // the last two choose one
    for (const auto& [key, has] : keys)
        for (std::size_t i = 0; i < std::size(kinds); ++i)
            EXPECT_EQ(isKey(kinds[i], key), has[i] == '1') << key << i;
}

TEST(Material, ANumberOfAnotherKindMakesItThat) {
    Scene scene;
    scene.objects.resize(1);
    Object& ball = scene.objects[0];
    ball.name = "ball";
    ball.shape = Sphere{};
    ball.material.kind = Matt{};
    const auto set = [&](std::string_view key, std::string_view value) {
        const Status done = setParam(scene, "objects.ball.material." + std::string(key), value);
        EXPECT_TRUE(done) << done.error().message;
    };
    set("transmission", "0.5");
    EXPECT_EQ(ball.material.clear(), (Clear{.transmission = 0.5f}));
    set("ior", "1.3");
    set("transmission", "0"); // black glass: a slider that passes 0 finds all else as it was
    EXPECT_EQ(ball.material.clear(), (Clear{.transmission = 0, .ior = 1.3f}));
    set("reflectance", "0 0 0.5");
    EXPECT_EQ(ball.material.mirror().reflectance, vec3(0, 0, 0.5f));
    set("scattering", "1 2 3");
    EXPECT_EQ(ball.material.translucent().scattering, vec3(1, 2, 3));
    EXPECT_EQ(
        setParam(scene, "objects.ball.material.scattering", "0 0 0").error().message,
        "objects.ball.material.scattering is 0 0 0; must be above 0 in a colour of a translucent material");
    set("kind", "matt");
    set("transmission", "0"); // of what is not clear: nothing
    EXPECT_TRUE(std::holds_alternative<Matt>(ball.material.kind));
    EXPECT_EQ(setParam(scene, "objects.ball.material.ior", "1.3").error().message,
              "objects.ball.material.ior is no key of a matt material; must stand in a clear, translucent, "
              "glossy or "
              "cook-torrance one");
}

TEST(Material, AbsorptionMayBeSetAsAColourAtADistance) {
    Scene scene;
    scene.objects.resize(1);
    scene.objects[0].name = "ball";
    scene.objects[0].shape = Sphere{};
    scene.objects[0].material.kind = Clear{};
    const auto set = [&](std::string_view key, std::string_view value) {
        EXPECT_TRUE(setParam(scene, "objects.ball.material." + std::string(key), value));
        for (const BoundParam& bound : bindParams(scene)) {
            if (bound.param->id != key) continue;
            EXPECT_EQ(getText(*bound.param, bound.data), value);
        }
    };
    set("attenuationDistance", "2");
    set("attenuationColor", "1 0.5 0.25");
    const vec3 before = scene.objects[0].material.clear().absorption;
    EXPECT_FLOAT_EQ(before.z, 0.69314718f);
    set("attenuationDistance", "4"); // the same colour after twice the way
    EXPECT_FLOAT_EQ(scene.objects[0].material.clear().absorption.z, before.z / 2);
}

TEST(Material, GlassHasTheDefaultsOfGltf) {
    const Clear glass;
    EXPECT_EQ(glass.ior, 1.5f);
    EXPECT_EQ(glass.transmission, 1);
    EXPECT_EQ(glass.absorption, vec3(0));
    EXPECT_EQ(glass.dispersion, 0);
    EXPECT_TRUE(glass.fresnel);
}

} // namespace
} // namespace lucent::scene
