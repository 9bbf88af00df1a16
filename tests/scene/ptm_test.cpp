// Polynomial texture maps of surfaces that are known.
#include "scene/Ptm.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lucent::scene {
namespace {

constexpr double kScale[] = {2, 2, 2, 2, 2, 2};
constexpr int kBias = 128;

Bytes bytesOf(std::string_view text) {
    const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
    return {bytes.begin(), bytes.end()};
}

Bytes header(std::string_view kind, ivec2 size) {
    std::string text = "PTM_1.2\nPTM_FORMAT_" + std::string(kind) + "\n" + std::to_string(size.x) + "\n" +
                       std::to_string(size.y) + "\n";
    for (const double scale : kScale)
        text += std::to_string(scale) + " ";
    text += "\n";
    for (int i = 0; i < 6; ++i)
        text += std::to_string(kBias) + (i < 5 ? " " : "\n");
    return bytesOf(text);
}

/// L = 200 - 100 ((u - u0)² + (v - v0)²): brightest, 200 of 255, at (u0, v0).
void addPolynomial(Bytes& out, dvec2 place) {
    const double terms[] = {-100, -100, 0, 200 * place.x, 200 * place.y, 200 - 100 * glm::dot(place, place)};
    for (int i = 0; i < 6; ++i)
        out.push_back(std::byte(std::lround(terms[i] / kScale[i]) + kBias));
}

dvec3 normalAt(const SurfaceMaps& maps, int x, int y) {
    const float* stored = maps.normals.at(x, y);
    return 2.0 * dvec3(stored[0], stored[1], stored[2]) - 1.0;
}

TEST(Ptm, TheNormalIsTheLightThatMakesAPixelBrightestAndRowsBeginAtTheBottom) {
    const dvec2 places[] = {{0.3, 0.1}, {-0.4, 0.2}}; // the lower pixel first
    Bytes file = header("LRGB", {1, 2});
    for (const dvec2 place : places)
        addPolynomial(file, place);
    for (const int value : {255, 102, 51, 255, 255, 255})
        file.push_back(std::byte(value));
    const auto maps = decodePtm(file, "coin.ptm");
    ASSERT_TRUE(maps) << maps.error().message;
    for (int row = 0; row < 2; ++row) { // a step of a coefficient is 2 in 200: 0.01
        EXPECT_NEAR(normalAt(*maps, 0, 1 - row).x, places[row].x, 0.006) << row;
        EXPECT_NEAR(normalAt(*maps, 0, 1 - row).y, places[row].y, 0.006) << row;
        EXPECT_NEAR(glm::length(normalAt(*maps, 0, 1 - row)), 1, 1e-5) << row;
    }
    const double shares[] = {1, 0.4, 0.2};
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(maps->albedo.at(0, 1)[c], linearFromSrgb(float(200.0 / 255 * shares[c])), 0.01) << c;
}

TEST(Ptm, OfThreePolynomialsEachIsAColour) {
    Bytes file = header("RGB", {1, 1});
    for (int c = 0; c < 3; ++c)
        addPolynomial(file, {0.2, -0.3});
    const auto maps = decodePtm(file, "coin.ptm");
    ASSERT_TRUE(maps) << maps.error().message;
    EXPECT_NEAR(normalAt(*maps, 0, 0).x, 0.2, 0.006);
    EXPECT_NEAR(normalAt(*maps, 0, 0).y, -0.3, 0.006);
    EXPECT_NEAR(maps->albedo.at(0, 0)[2], linearFromSrgb(200.0f / 255), 0.01);
}

TEST(Ptm, APixelThatIsBrightestBeyondTheHorizonFacesTheViewerStill) {
    Bytes file = header("RGB", {1, 1});
    for (int c = 0; c < 3; ++c)
        for (const int term : {0, 0, 0, 50, 0, 50}) // grows to the right without end
            file.push_back(std::byte(term + kBias));
    const auto maps = decodePtm(file, "coin.ptm");
    ASSERT_TRUE(maps) << maps.error().message;
    EXPECT_NEAR(normalAt(*maps, 0, 0).z, 0.05, 1e-4);
    EXPECT_GT(normalAt(*maps, 0, 0).x, 0.99);
}

TEST(Ptm, SaysWhatIsWrong) {
    const auto message = [](const Bytes& file) { return decodePtm(file, "a.ptm").error().message; };
    EXPECT_EQ(message(bytesOf("#HSH1.2")),
              "a.ptm: does not begin with PTM_1.2; must be a polynomial texture map");
    EXPECT_EQ(message(bytesOf("PTM_1.2\nPTM_FORMAT_JPEG_LRGB\n")),
              "a.ptm: is of the kind \"PTM_FORMAT_JPEG_LRGB\"; must be PTM_FORMAT_LRGB or PTM_FORMAT_RGB");
    EXPECT_EQ(message(bytesOf("PTM_1.2\nPTM_FORMAT_RGB\n4 4\n1 1 x")),
              "a.ptm: a scale is \"x\"; must be a number");
    EXPECT_EQ(message(header("RGB", {1, 1})), "a.ptm: ends after 1 bytes of pixels; must have 18");
}

} // namespace
} // namespace lucent::scene
