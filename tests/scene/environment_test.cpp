#include "scene/Environment.h"
#include "scene/Load.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lucent::scene {
namespace {

// Texel that holds a direction, by the convention: row 0 = +y, centre column = -z, to the right = +x.
vec3 lookUp(const Image& map, vec3 direction) {
    const vec3 d = glm::normalize(direction);
    const double u = 0.5 + std::atan2(d.x, -d.z) / (2 * M_PI), v = std::acos(d.y) / M_PI;
    const float* texel =
        map.at(std::min(int(u * map.width), map.width - 1), std::min(int(v * map.height), map.height - 1));
    return {texel[0], texel[1], texel[2]};
}

TEST(Environment, DirectionMapHoldsTheDirectionItself) {
    const Image map = proceduralEnvironment("direction");
    // A texel spans 360/256 degrees: its centre is at most 0.5 * sqrt(2) * 2 pi / 256 = 0.0174 away.
    for (const vec3 d : {vec3(1, 0, 0), vec3(-1, 0, 0), vec3(0, 1, 0), vec3(0, -1, 0), vec3(0, 0, 1),
                         vec3(0, 0, -1), vec3(0.3f, -0.5f, 0.8f), vec3(-0.7f, 0.1f, -0.2f)})
        EXPECT_LT(glm::distance(lookUp(map, d), 0.5f + 0.5f * glm::normalize(d)), 0.5 * 0.0175)
            << d.x << " " << d.y;
}

TEST(Environment, RowZeroIsUpCentreIsMinusZAndRightIsPlusX) {
    const Image map = proceduralEnvironment("direction");
    EXPECT_GT(map.at(0, 0)[1], 0.99f);                              // +y
    EXPECT_LT(map.at(0, map.height - 1)[1], 0.01f);                 // -y
    EXPECT_LT(map.at(map.width / 2, map.height / 2)[2], 0.01f);     // -z
    EXPECT_GT(map.at(map.width * 3 / 4, map.height / 2)[0], 0.99f); // +x
    EXPECT_LT(map.at(map.width / 4, map.height / 2)[0], 0.01f);     // -x
}

TEST(Environment, RainbowHueIsTheAzimuthAtFullSaturationAndValueOne) {
    const Image map = proceduralEnvironment("rainbow");
    // Azimuth from -z over +x: red at 0, yellow at 60, green at 120, cyan at 180, blue at 240 degrees.
    const auto at = [&](double degrees, float y) {
        const double a = degrees * M_PI / 180;
        return lookUp(map, {float(std::sin(a)), y, float(-std::cos(a))});
    };
    const vec3 hues[] = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1}, {1, 0, 1}};
    for (int i = 0; i < 6; ++i)
        for (const float y :
             {-1.0f, 0.0f, 2.0f}) // half a texel of azimuth changes a channel by 0.7/60 at most
            EXPECT_LT(glm::distance(at(60 * i, y), hues[i]), 0.02) << 60 * i;
    for (std::size_t i = 0; i < map.pixels.size(); i += 3) {
        EXPECT_EQ(std::max({map.pixels[i], map.pixels[i + 1], map.pixels[i + 2]}), 1.0f);
        EXPECT_EQ(std::min({map.pixels[i], map.pixels[i + 1], map.pixels[i + 2]}), 0.0f);
    }
}

TEST(Environment, UniformIsWhiteAndSkyIsBlueAboveAndDarkBelow) {
    for (const float value : proceduralEnvironment("uniform").pixels)
        EXPECT_EQ(value, 1.0f);
    const Image sky = proceduralEnvironment("sky");
    EXPECT_LT(glm::distance(lookUp(sky, {0, 1, 0}), vec3(0.15f, 0.35f, 0.8f)), 1e-3);
    EXPECT_LT(glm::distance(lookUp(sky, {0, -1, 0}), vec3(0.2f, 0.17f, 0.14f)), 1e-6);
    // Just above the horizon d.y = sin(0.5 * 180/128 degrees) = 0.0123, whose root is 0.111: 11 % of the way
    // up.
    EXPECT_NEAR(lookUp(sky, {1, 0.012f, 0}).x, 0.9 - 0.111 * 0.75, 1e-3);
}

TEST(Environment, FilesOfEightBitsAreDecodedFromSrgb) {
    Image image(2, 1, 1);
    image.pixels = {0, 188 / 255.0f};
    const auto map = loadEnvironmentMap("probe.png", *encodeImage(image, "a.png"));
    ASSERT_TRUE(map);
    EXPECT_EQ((*map)->channels, 3);
    EXPECT_NEAR((*map)->at(1, 0)[2], 0.502886, 1e-6); // ((188/255 + 0.055) / 1.055)^2.4
    image.pixels = {0.5f, INFINITY};
    EXPECT_EQ(loadEnvironmentMap("probe.pfm", *encodeImage(image, "a.pfm")).error().message,
              "probe.pfm: texel (1, 0) is inf; colours must be finite");
    EXPECT_TRUE(loadEnvironmentMap("sky", {}));
}

} // namespace
} // namespace lucent::scene
