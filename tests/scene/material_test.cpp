#include "scene/Keys.h"
#include "scene/Scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lucent::scene {
namespace {

TEST(Material, AbsorptionIsTheLogarithmOfTheColourOverTheDistance) {
    Material glass;
    EXPECT_EQ(glass.absorption(), vec3(0)); // a distance of 0 absorbs nothing
    glass.attenuationColor = {1, 0.5f, 0.25f};
    EXPECT_EQ(glass.absorption(), vec3(0));
    glass.attenuationDistance = 2;
    EXPECT_EQ(glass.absorption().x, 0);
    EXPECT_FLOAT_EQ(glass.absorption().y, 0.34657359f); // ln 2 / 2
    EXPECT_FLOAT_EQ(glass.absorption().z, 0.69314718f); // ln 4 / 2
}

TEST(Material, AbsorptionComesBackToFloatPrecision) {
    // Clear water, ink, dark glass of a millimetre, the ends of the range, and channels a hundredfold apart.
    for (const vec3 sigma : {vec3(0.45f, 0.07f, 0.02f), vec3(5e4f), vec3(800, 3000, 20000),
                             vec3(1e9f, 0, 1e8f), vec3(1e-9f, 2e-9f, 0), vec3(100, 1, 50)}) {
        Material glass;
        glass.setAbsorption(sigma);
        // A colour just below 1 is stored to 2^-25, and its logarithm is at least 13/100 here: 2.3e-7.
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(glass.absorption()[i], sigma[i], 2.4e-7 * sigma[i]) << sigma.x;
        for (const Param& param : mediumParams().params)
            EXPECT_TRUE(checkRange(param, reinterpret_cast<const std::byte*>(&glass) + param.offset))
                << param.id; // a file could say it as well
    }
}

TEST(Material, NoAbsorptionIsNoDistance) {
    Material glass;
    glass.setAbsorption(vec3(3));
    glass.setAbsorption(vec3(0));
    EXPECT_EQ(glass.attenuationDistance, 0);
    EXPECT_EQ(glass.attenuationColor, vec3(1));
}

TEST(Material, IsOpaqueClearTranslucentOrAMirror) {
    Object ball;
    ball.shape = Sphere{};
    const auto tables = [&] { return materialTables(ball); };
    using Tables = std::vector<const ParamTable*>;
    EXPECT_EQ(tables(), (Tables{&colorParams(), &opticsParams()}));
    ball.material.transmission = 0.5f;
    EXPECT_EQ(tables(), (Tables{&opticsParams(), &mediumParams(), &refractionParams()}));
    ball.material.transmission = 0;
    ball.material.scattering = {0, 0, 100};
    EXPECT_EQ(tables(), (Tables{&opticsParams(), &mediumParams(), &scatteringParams()}));
    ball.material.scattering = vec3(0);
    ball.material.reflectance = {0, 0, 0.1f};
    EXPECT_EQ(tables(), (Tables{&opticsParams()}));
    ball.shape = HeightField{};
    EXPECT_EQ(tables(), (Tables{&colorParams(), &reliefParams()}));
}

TEST(Material, GlassHasTheDefaultsOfGltf) {
    const Material glass;
    EXPECT_EQ(glass.ior, 1.5f);
    EXPECT_EQ(glass.transmission, 0);
    EXPECT_EQ(glass.attenuationColor, vec3(1));
    EXPECT_EQ(glass.dispersion, 0);
    EXPECT_TRUE(glass.fresnel);
}

} // namespace
} // namespace lucent::scene
