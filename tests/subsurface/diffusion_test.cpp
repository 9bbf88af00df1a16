// Diffusion in cells: against a random walk, closed forms, and itself.
#include "techniques/subsurface/Subsurface.h"

#include "techniques/subsurface/Volume.h"
#include "tests/subsurface/Stage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace lucent::subsurface {
namespace {

using namespace stage;

// Of a random walk with Fresnel's boundary in the marble sphere of 10 mm, green: radiosity over irradiance in
// rings of 10 degrees around the direction of the light, from 25 degrees on, by half a million paths (0.2 to
// 3 % of error).
constexpr std::pair<double, double> kWalked[] = {
    {25, 0.688}, {55, 0.446}, {85, 0.0919}, {115, 0.0128}, {145, 0.0059}};

// Mean of green radiosity within 5 degrees of this one.
double inRing(const Image& image, double degrees) {
    const double pixel = 0.022 / image.width;
    double sum = 0;
    int count = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double along = (x + 0.5 - 0.5 * image.width) * pixel,
                         up = (y + 0.5 - 0.5 * image.height) * pixel;
            if (std::hypot(along, up) > 0.0097) continue;
            if (std::abs(std::acos(along / 0.01) * 180 / kPi64 - degrees) > 5) continue;
            sum += double(image.at(x, y)[1]);
            ++count;
        }
    return sum / count;
}

TEST_F(SubsurfaceTest, DiffusionInCellsIsNearTheRandomWalkBehindABodyToo) {
    // The page's bound is 20 % behind the body, where the dipole has 0.4 to 0.7 of the walk. In front 5 %:
    // two cells are as wide as the depth at which light first scatters.
    const Image image = draw(sphereFromTheSide(0.01, marble()), {96, 96}, with(Method::Diffusion));
    for (const auto& [degrees, walked] : kWalked)
        EXPECT_NEAR(inRing(image, degrees) / walked, 1, degrees < 90 ? 0.05 : 0.2) << degrees;
    const Image dipole = draw(sphereFromTheSide(0.01, marble()), {96, 96});
    EXPECT_LT(inRing(dipole, 145) / kWalked[4].second, 0.6);
}

// Green radiosity less its smooth fit by the angle from the light, over that fit, rms between two angles:
// around a sphere light depends on nothing else, so what is left is cells. The fit is quadratic in the
// logarithm, over 16 degrees.
double rippleOf(const Image& image, double from, double to) {
    std::vector<dvec2> places; // degrees, logarithm
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const dvec2 at = (dvec2(x, y) + 0.5 - 0.5 * image.width) * 0.022 / double(image.width);
            if (glm::length(at) < 0.0097)
                places.emplace_back(std::acos(at.x / 0.01) * 180 / kPi64,
                                    std::log(std::max(1e-30, double(image.at(x, y)[1]))));
        }
    double squares = 0;
    int count = 0;
    for (double middle = from + 2; middle < to; middle += 4) {
        glm::dmat3 moments(0);
        dvec3 sums(0);
        for (const dvec2& place : places) {
            const double u = (place.x - middle) / 8;
            if (std::abs(u) >= 1) continue;
            const dvec3 terms(1, u, u * u);
            moments += (1 - u * u) * glm::outerProduct(terms, terms);
            sums += (1 - u * u) * place.y * terms;
        }
        const dvec3 fit = glm::inverse(moments) * sums;
        for (const dvec2& place : places) {
            const double u = (place.x - middle) / 8;
            if (std::abs(u) >= 0.25) continue;
            const double left = std::expm1(place.y - glm::dot(fit, dvec3(1, u, u * u)));
            squares += left * left;
            ++count;
        }
    }
    return std::sqrt(squares / count);
}

TEST_F(SubsurfaceTest, DiffusionShowsNoCells) {
    // Cells wholly inside or outside, without a fit between them, show as rings of 2 to 5 %; measured:
    // 0.7, 1.1 and 0.9 %.
    const Image image = draw(sphereFromTheSide(0.01, marble()), {96, 96}, with(Method::Diffusion));
    for (const double from : {20.0, 60.0, 100.0})
        EXPECT_LT(rippleOf(image, from, from + 40), 0.015) << from;
}

TEST_F(SubsurfaceTest, DiffusionLosesNoLightInABodyThatAbsorbsNone) {
    // What enters leaves. Around the sphere B depends on the angle alone: its sum over rings of the picture.
    scene::Material material = marble();
    material.translucent().absorption = vec3(0);
    const Image image = draw(sphereFromTheSide(0.01, material), {96, 96}, with(Method::Diffusion));
    double left = 0, entered = 0;
    for (double degrees = 5; degrees < 180; degrees += 10) {
        const double radians = degrees * kPi64 / 180;
        // The picture stops before the poles of the light: there as at 15 and 165 degrees.
        left += inRing(image, std::clamp(degrees, 15.0, 165.0)) * std::sin(radians);
        entered += entering(std::cos(radians)) * std::max(std::cos(radians), 0.0) * std::sin(radians);
    }
    EXPECT_NEAR(left / entered, 1,
                0.04); // rings as wide as 10 degrees tell 1 %; a cell is a 46th of the sphere
}

TEST_F(SubsurfaceTest, DiffusionShinesThroughSheetsThinnerThanACell) {
    // 46 cells in 40 mm, and a sheet of a quarter or more than half of one: much thinner than the mean free
    // path of 2 mm, it leaves on either side half of what entered, whichever side is lit and however it lies
    // among the cells.
    scene::Material material = marble();
    material.translucent().absorption = vec3(0);
    material.translucent().scattering = vec3(500);
    for (const float thickness : {0.0002f, 0.0005f})
        for (const float turned : {0.0f, 25.0f})
            for (const float side : {-1.0f, 1.0f}) {
                scene::Scene scene = seen({bodyOf(scene::Box{{0.04f, 0.04f, thickness}}, material)}, 0.004f);
                scene.objects[0].transform.rotate = {0, turned, 0};
                scene.lights = {scene::DistantLight{
                    .direction = side * (rotationFromDegrees({0, turned, 0}) * vec3(0, 0, 1))}};
                const Image image = draw(scene, {8, 8}, with(Method::Diffusion));
                double sum = 0, worst = 0;
                for (int i = 0; i < 64; ++i) {
                    const double share = double(image.at(i % 8, i / 8)[1]) / entering(1);
                    sum += share / 64;
                    worst = std::max(worst, std::abs(share - 0.5));
                }
                EXPECT_NEAR(sum, 0.5, 0.02) << thickness << " m, " << turned << " degrees, from " << side;
                EXPECT_LT(worst, 0.04) << thickness << " m, " << turned << " degrees, from " << side;
            }
}

TEST(Volumes, RoundsAreBoundWhateverTheMedium) {
    const views::Bounds ball{vec3(-0.01f), vec3(0.01f)};
    for (const double scattering : {1e-6, 1.0, 2620.0, 1e5, 1e9})
        for (const double absorption : {0.0, 1e-6, 4.1, 1e6}) {
            const diffusion::Medium medium{.scattering = scattering, .absorption = absorption};
            const Rounds rounds = roundsOf({medium, medium, medium}, cellsOf(ball, 128));
            EXPECT_LE(rounds.count, kMostRounds) << scattering << " " << absorption;
            EXPECT_GE(rounds.count, 1) << scattering << " " << absorption;
        }
    const auto marbles = diffusion::mediaOf(marble());
    EXPECT_LT(roundsOf(marbles, cellsOf(ball, 48)).count, 200); // none of it is cut off
}

TEST_F(SubsurfaceTest, DiffusionKeepsTouchingObjectsApart) {
    scene::Scene scene = seen({bodyOf(scene::Box{vec3(0.01f)}, marble(), {-0.005f, 0, 0}),
                               bodyOf(scene::Box{vec3(0.01f)}, marble(), {0.005f, 0, 0})},
                              0.012f);
    scene.lights = {scene::DistantLight{.direction = {1, 0, 0}}};
    const Image image = draw(scene, {64, 32}, with(Method::Diffusion));
    EXPECT_EQ(image.at(40, 16)[1], 0);
    EXPECT_GT(image.at(24, 16)[1], 0);
}

TEST_F(SubsurfaceTest, DiffusionUnderAnEvenEnvironmentIsEvenOnASphere) {
    scene::Scene scene = seen({bodyOf(scene::Sphere{0.01f}, dense())}, 0.022f);
    scene.environment.emplace();
    scene.environment->source = "white";
    auto map = std::make_shared<Image>(8, 4, 3);
    std::fill(map->pixels.begin(), map->pixels.end(), 1.0f);
    scene.environment->map = map;
    Settings settings = with(Method::Diffusion);
    settings.cells = 96; // half a mean free path wide; cells as wide as one show as steps of 10 %
    const Image image = draw(scene, {48, 48}, settings);
    const float middle = atMiddle(image);
    EXPECT_GT(middle, 0);
    for (int x = 6; x < 42; ++x)
        EXPECT_NEAR(image.at(x, 24)[1] / middle, 1, 0.05) << x;
}

} // namespace
} // namespace lucent::subsurface
