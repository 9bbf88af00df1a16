// Subsurface scattering in other words: each of them says what the coefficients say, and the way back is the
// same.
#include "scene/MaterialPresets.h"
#include "scene/Translucency.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lucent::scene {
namespace {

const MaterialPreset& presetNamed(std::string_view name) {
    for (const MaterialPreset& preset : materialPresets())
        if (preset.name == name) return preset;
    return materialPresets().front();
}

Material measured(std::string_view name, float anisotropy = 0) {
    Translucent inside{.anisotropy = anisotropy};
    apply(presetNamed(name), inside);
    Material material;
    material.kind = inside;
    return material;
}

double extinction(const Material& material, int color) {
    const Translucent& inside = material.translucent();
    return (1 - double(inside.anisotropy)) * double(inside.scattering[color]) +
           double(inside.absorption[color]);
}

double albedo(const Material& material, int color) {
    const Translucent& inside = material.translucent();
    return (1 - double(inside.anisotropy)) * double(inside.scattering[color]) / extinction(material, color);
}

Material with(Material material, std::string_view id, const Translucency& wanted) {
    const Status stored = store(wanted, id, material);
    EXPECT_TRUE(stored.ok()) << stored.error().message;
    return material;
}

Material withBlur(const Material& material, double blur) {
    return with(material, "blur", {.blur = float(blur)});
}
Material withGlow(const Material& material, double glow) {
    return with(material, "glow", {.glow = float(glow)});
}

TEST(Translucency, NamesTheMeasuredMaterialWhateverItsAnisotropy) {
    for (std::size_t i = 0; i < materialPresets().size(); ++i)
        for (const float g : {0.0f, 0.7f, -0.5f}) {
            Material material = measured(materialPresets()[i].name, g);
            EXPECT_EQ(int(translucencyOf(material).preset), int(i) + 1) << materialPresets()[i].name;
            material.translucent().scattering.y *= 1.001f;
            EXPECT_EQ(translucencyOf(material).preset, Measured::Own);
        }
    Material plastic = measured("marble");
    plastic.translucent().ior = 1.4f;
    EXPECT_EQ(translucencyOf(plastic).preset, Measured::Own);
}

TEST(Translucency, SaysMarbleInMillimetres) {
    const Translucency marble = translucencyOf(measured("marble"));
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(marble.scatteringPerMm[i], presetNamed("marble").scattering[i], 1e-6);
        EXPECT_NEAR(marble.absorptionPerMm[i], presetNamed("marble").absorption[i], 1e-8);
    }
    // 3 / ((2.19 + 0.0021) + (2.62 + 0.0041) + (3 + 0.0071))
    EXPECT_NEAR(marble.blur, 3 / 7.8233, 1e-6);
}

TEST(Translucency, GlowIsVanDeHulstsAlbedoOfAHalfSpace) {
    EXPECT_EQ(halfSpaceAlbedo(0), 0);
    EXPECT_EQ(halfSpaceAlbedo(1), 1);
    // Of Chandrasekhar's H function, solved by iteration on 64 Gauss points: 1 - 2 s times the integral of H
    // mu. The closed form is off by 0.0021 where half of the light is scattered, and by less for paler ones.
    EXPECT_NEAR(halfSpaceAlbedo(0.5), 0.146544, 0.0022);
    EXPECT_NEAR(halfSpaceAlbedo(0.9), 0.478024, 0.001);
    EXPECT_NEAR(halfSpaceAlbedo(0.99), 0.794564, 1e-4);
    EXPECT_NEAR(halfSpaceAlbedo(0.999), 0.929713, 1e-4);
    const Material skin = measured("skin1");
    double mean = 0;
    for (int i = 0; i < 3; ++i)
        mean += halfSpaceAlbedo(albedo(skin, i)) / 3;
    EXPECT_NEAR(translucencyOf(skin).glow, mean, 1e-6);
    EXPECT_EQ(translucencyOf(measured("spectralon")).glow, 1); // which absorbs nothing
}

TEST(Translucency, BlurChangesLengthsAndNoColour) {
    for (const MaterialPreset& preset : materialPresets()) {
        const Material before = measured(preset.name, 0.3f), after = withBlur(before, 5);
        EXPECT_NEAR(translucencyOf(after).blur, 5, 1e-5);
        const double factor = extinction(after, 0) / extinction(before, 0);
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(extinction(after, i), factor * extinction(before, i), 1e-5 * extinction(after, i));
            EXPECT_NEAR(albedo(after, i), albedo(before, i), 1e-6);
        }
        EXPECT_EQ(after.translucent().ior, before.translucent().ior);
    }
}

TEST(Translucency, GlowChangesAlbedosAndNoExtinction) {
    for (const MaterialPreset& preset : materialPresets())
        for (const double glow : {0.05, 0.3, 0.8, 0.97}) {
            const Material before = measured(preset.name, -0.2f), after = withGlow(before, glow);
            EXPECT_NEAR(translucencyOf(after).glow, glow, 1e-5) << preset.name;
            for (int i = 0; i < 3; ++i)
                EXPECT_NEAR(extinction(after, i), extinction(before, i), 1e-6 * extinction(before, i));
        }
}

TEST(Translucency, GlowKeepsTheOrderOfColours) {
    const Material skin = measured("skin1");
    for (const double glow : {0.05, 0.5, 0.95}) {
        const Material other = withGlow(skin, glow);
        EXPECT_GT(albedo(other, 0), albedo(other, 1));
        EXPECT_GT(albedo(other, 1), albedo(other, 2));
    }
}

TEST(Translucency, TheWayBackIsTheSame) {
    // A thousand steps on two sliders, each of which rounds some numbers by 3e-8 on the mean: a random walk
    // of 2000 steps is 1.4e-6 long. The last slider is a float itself, of which scattering follows the
    // tenfold.
    constexpr double kWalk = 1e-5;
    for (const char* name : {"marble", "skin1", "wholemilk", "ketchup"}) {
        const Material start = measured(name);
        const Translucency words = translucencyOf(start);
        Material material = start;
        std::minstd_rand random;
        std::uniform_real_distribution<double> blur(std::log(0.02), std::log(50)), glow(0.02, 0.98);
        for (int i = 0; i < 1000; ++i) {
            material = withBlur(material, std::exp(blur(random)));
            material = withGlow(material, glow(random));
        }
        material = withBlur(withGlow(material, double(words.glow)), double(words.blur));
        for (int i = 0; i < 3; ++i) {
            EXPECT_NEAR(material.translucent().scattering[i], start.translucent().scattering[i],
                        kWalk * double(start.translucent().scattering[i]))
                << name;
            EXPECT_NEAR(material.translucent().absorption[i], start.translucent().absorption[i],
                        kWalk * double(start.translucent().absorption[i]))
                << name;
        }
    }
}

TEST(Translucency, ExtremesStayLegal) {
    Material blood;
    // A colour that meets nothing, one that is absorbed only.
    blood.kind = Translucent{.scattering = {100, 0, 0}, .absorption = {0, 300, 0}};
    EXPECT_NEAR(translucencyOf(blood).glow, 0.5, 1e-6);
    EXPECT_NEAR(translucencyOf(withGlow(blood, 0.2)).glow, 0.2, 1e-5);
    EXPECT_NEAR(translucencyOf(withGlow(blood, 0.9)).glow, 0.9, 1e-5);
    const Material white = withGlow(measured("skin1"), 1);
    EXPECT_EQ(white.translucent().absorption, vec3(0));
    EXPECT_TRUE(withGlow(measured("marble"), 0.001).isScattering());

    Material dense = measured("marble", 0.999f);
    const Status stored = store({.blur = 1e-3f}, "blur", dense);
    ASSERT_FALSE(stored.ok());
    EXPECT_NE(stored.error().message.find("; must be at most 1e+09"), std::string::npos)
        << stored.error().message;
    EXPECT_EQ(dense.translucent().scattering, measured("marble", 0.999f).translucent().scattering);
    EXPECT_EQ(store({}, "preset", dense).error().message, "is own; must be a measured material");
}

// --- by path

Scene sceneWith(const Material& material) {
    Scene scene;
    Object& ball = scene.objects.emplace_back();
    ball.name = "ball";
    ball.shape = Sphere{};
    ball.material = material;
    return scene;
}

TEST(Translucency, IsSetByPath) {
    Scene scene = sceneWith(measured("marble"));
    const Material& material = scene.objects[0].material;
    ASSERT_TRUE(setParam(scene, "objects.ball.material.preset", "skin1").ok());
    EXPECT_EQ(material.translucent().scattering, measured("skin1").translucent().scattering);
    EXPECT_EQ(material.translucent().ior, 1.3f);
    ASSERT_TRUE(setParam(scene, "objects.0.material.blur", "2").ok());
    EXPECT_NEAR(translucencyOf(material).blur, 2, 1e-6);
    ASSERT_TRUE(setParam(scene, "objects.ball.material.scatteringPerMm", "1 2 3").ok());
    EXPECT_EQ(material.translucent().scattering, vec3(1000, 2000, 3000));
    ASSERT_TRUE(setParam(scene, "objects.ball.material.absorptionPerMm", "0.1 0 0.2").ok());
    EXPECT_NEAR(material.translucent().absorption.z, 200, 1e-3);
    EXPECT_EQ(setParam(scene, "objects.ball.material.glow", "2").error().message,
              "objects.ball.material.glow is 2; must be in [0.001, 1]");
}

TEST(Translucency, AMeasuredMaterialMayBeChosenForAnythingOpaque) {
    Material matt;
    matt.kind = Matt{};
    Scene scene = sceneWith(matt);
    ASSERT_TRUE(setParam(scene, "objects.ball.material.preset", "ketchup").ok());
    EXPECT_EQ(scene.objects[0].material.translucent().scattering,
              measured("ketchup").translucent().scattering);
    scene.objects[0].material = matt;
    EXPECT_EQ(setParam(scene, "objects.ball.material.blur", "2").error().message,
              "objects.ball.material.blur is no key of a matt material; must stand in a translucent one");
}

TEST(Translucency, StandsBeforeTheCoefficientsAndInPlaceOfTheirs) {
    Scene scene = sceneWith(measured("marble"));
    std::vector<std::string_view> shown;
    for (const BoundParam& bound : bindParams(scene))
        if (bound.group() == Group::Subsurface) shown.push_back(bound.param->id);
    EXPECT_EQ(shown,
              (std::vector<std::string_view>{"preset", "blur", "glow", "scatteringPerMm", "absorptionPerMm",
                                             "ior", "anisotropy", "thickness", "roughness"}));
}

} // namespace
} // namespace lucent::scene
