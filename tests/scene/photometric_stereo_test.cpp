// Photographs that are made of a surface that is known.
#include "scene/PhotometricStereo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lucent::scene {
namespace {

constexpr int kSide = 48;

Result<std::vector<LitPhoto>> parsed(std::string_view text) {
    return parseLightFile(std::as_bytes(std::span(text.data(), text.size())), "dome.lp");
}

/// A dome of lamps: two rings, 30 and 60 degrees above the surface.
std::vector<dvec3> dome(int count = 24) {
    std::vector<dvec3> lights;
    for (int k = 0; k < count; ++k) {
        const double turn = 2 * std::numbers::pi * k / count, up = std::numbers::pi / (k % 2 ? 6 : 3);
        lights.push_back({std::cos(turn) * std::cos(up), std::sin(turn) * std::cos(up), std::sin(up)});
    }
    return lights;
}

/// Outward normal of a ball that fills the picture; beside it the plane behind.
dvec3 ballNormal(int x, int y) {
    const dvec2 p = (dvec2(x + 0.5, kSide - y - 0.5) * 2.0 - double(kSide)) / double(kSide);
    const double rest = 1 - glm::dot(p, p);
    return rest > 0.1 ? dvec3(p, std::sqrt(rest)) : dvec3(0, 0, 1);
}

const dvec3 kColor(0.8, 0.4, 0.2);

/// A matt ball with its own shadow and, where wanted, a highlight that is brighter than white paper.
Image photo(dvec3 light, double gloss) {
    Image image(kSide, kSide, 3);
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const dvec3 n = ballNormal(x, y), half = glm::normalize(light + dvec3(0, 0, 1));
            const double shine = gloss * std::pow(std::max(glm::dot(n, half), 0.0), 200.0);
            for (int c = 0; c < 3; ++c)
                image.at(x, y)[c] = float(kColor[c] * std::max(glm::dot(n, light), 0.0) + shine);
        }
    return image;
}

SurfaceMaps solved(const std::vector<dvec3>& lights, double gloss, std::size_t mostBytes = 1 << 30) {
    PhotometricStereo stereo(lights, mostBytes);
    for (const dvec3 light : lights)
        EXPECT_TRUE(stereo.add(photo(light, gloss), "photo").ok());
    for (int i = 0; stereo.step(0.1) < 1; ++i)
        if (i > 10000) ADD_FAILURE() << "is never done";
    return stereo.maps();
}

dvec3 normalIn(const Image& normals, int x, int y) {
    const float* stored = normals.at(x, y);
    return glm::normalize(2.0 * dvec3(stored[0], stored[1], stored[2]) - 1.0);
}

double degreesApart(dvec3 a, dvec3 b) {
    return glm::degrees(std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)));
}

struct Errors {
    double mean = 0, largest = 0;
};
Errors errorsOf(const Image& normals) {
    Errors errors;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const double apart = degreesApart(normalIn(normals, x, y), ballNormal(x, y));
            errors.mean += apart / (kSide * kSide);
            errors.largest = std::max(errors.largest, apart);
        }
    return errors;
}

TEST(PhotometricStereo, FindsTheNormalsOfAMattBallThroughItsShadows) {
    // 16 bits of the stored values: 1e-3 of a value is 0.05 degrees.
    const SurfaceMaps maps = solved(dome(), 0);
    const Errors errors = errorsOf(maps.normals);
    EXPECT_LT(errors.mean, 0.05);
    EXPECT_LT(errors.largest, 0.3);
    EXPECT_LT(maps.rms, 1e-3);
    EXPECT_GT(maps.leftOut, 0.01); // the shadows
    EXPECT_LT(maps.leftOut, 0.3);
}

TEST(PhotometricStereo, LeavesHighlightsOut) {
    const SurfaceMaps maps = solved(dome(), 1.5);
    const Errors errors = errorsOf(maps.normals);
    EXPECT_LT(errors.mean, 0.5);
    EXPECT_LT(errors.largest, 5);
    // Plain least squares over all values is wrong by degrees where a highlight is: the residual would say
    // so.
    EXPECT_LT(maps.rms, 0.02);
}

TEST(PhotometricStereo, ColoursAreThoseOfThePaintRelativeToItsBrightest) {
    const SurfaceMaps maps = solved(dome(), 0);
    for (const ivec2 at : {ivec2(10, 24), ivec2(24, 24), ivec2(38, 20)})
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(maps.albedo.at(at.x, at.y)[c], kColor[c] / kColor.x, 0.003) << at.x << " " << c;
}

TEST(PhotometricStereo, TheResidualIsWhatTheModelLeavesOver) {
    // Every second photograph is 4 % brighter, the others darker, in no pattern that a normal could follow.
    std::vector<dvec3> lights;
    for (const dvec3 light : dome(12))
        lights.insert(lights.end(), 2, light);
    PhotometricStereo stereo(lights, 1 << 30);
    for (std::size_t k = 0; k < lights.size(); ++k) {
        Image image(2, 2, 3);
        std::fill(image.pixels.begin(), image.pixels.end(),
                  float(lights[k].z * 0.5 + (k % 2 ? 0.02 : -0.02)));
        ASSERT_TRUE(stereo.add(image, "photo").ok());
    }
    while (stereo.step(0.1) < 1) {
    }
    EXPECT_NEAR(stereo.maps().rms, 0.02 / 0.5, 0.001); // per albedo
    EXPECT_LT(degreesApart(normalIn(stereo.maps().normals, 1, 1), {0, 0, 1}), 0.1);
}

TEST(PhotometricStereo, PhotographsThatAreTooLargeBecomeSmallerByAWholeFactor) {
    const auto lights = dome(4);
    const std::size_t all = std::size_t(kSide) * kSide * 4 * 6;
    PhotometricStereo stereo(lights, all / 4);
    for (const dvec3 light : lights)
        ASSERT_TRUE(stereo.add(photo(light, 0), "photo").ok());
    EXPECT_EQ(stereo.reduction(), 2);
    while (stereo.step(0.1) < 1) {
    }
    EXPECT_EQ(stereo.maps().normals.size(), ivec2(kSide / 2));
}

TEST(PhotometricStereo, PhotographsOfAnotherSizeAreRefusedByName) {
    PhotometricStereo stereo(dome(4), 1 << 30);
    ASSERT_TRUE(stereo.add(Image(4, 4, 3), "a.jpg").ok());
    EXPECT_EQ(stereo.add(Image(4, 5, 3), "b.jpg").error().message,
              "b.jpg: is 4 x 5 pixels; must be 4 x 4, as a.jpg");
}

TEST(LightFile, GivesFilesAndUnitDirections) {
    const auto photos = parsed("3\r\nfirst one.jpg 0 0 2\r\n\r\nsub\\b.jpg 1 0 0\nc.jpg\t0 -1e1 0\n");
    ASSERT_TRUE(photos) << photos.error().message;
    ASSERT_EQ(photos->size(), 3u);
    EXPECT_EQ((*photos)[0].file, "first one.jpg");
    EXPECT_EQ((*photos)[0].light, dvec3(0, 0, 1));
    EXPECT_EQ((*photos)[1].file, "sub/b.jpg");
    EXPECT_EQ((*photos)[2].light, dvec3(0, -1, 0));
}

TEST(LightFile, SaysWhatIsWrongAndWhere) {
    const std::pair<const char*, const char*> cases[] = {
        {"", "dome.lp:1: is \"\"; must be the number of photographs, 3 to 512"},
        {"2\na 0 0 1\nb 1 0 0\n", "dome.lp:1: is \"2\"; must be the number of photographs, 3 to 512"},
        {"3\na 0 0 1\nb 1 0\n",
         "dome.lp:3: is \"b 1 0\"; must be a file and three numbers, where its light comes from"},
        {"3\na 0 0 0\n",
         "dome.lp:2: is \"a 0 0 0\"; must be a file and three numbers, where its light comes from"},
        {"4\na 0 0 1\nb 1 0 0\n", "dome.lp: lists 2 photographs; must list 4, as its first line says"},
        {"3\na 0 0 1\nb 1 0 0\nc 1 0 1\n",
         "dome.lp: all lights lie in one plane; must come from around the surface"}};
    for (const auto& [text, message] : cases) {
        const auto photos = parsed(text);
        ASSERT_FALSE(photos) << text;
        EXPECT_EQ(photos.error().message, message);
    }
}

} // namespace
} // namespace lucent::scene
