// Radiosity on simple bodies: closed forms first, then the same dipole summed by brute force.
#include "techniques/subsurface/Subsurface.h"

#include "tests/subsurface/Stage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <utility>

namespace lucent::subsurface {
namespace {

using namespace stage;

TEST_F(SubsurfaceTest, AHalfSpaceLeavesTheClosedFormsShare) {
    // B/E without the entry's Fresnel factor, (a'/2)(1 + e^(-4/3 A s)) e^-s with s = sqrt(3 (1 - a')): for
    // marble 0.8302, 0.7910, 0.7526. The plane is 13 times as wide as red light reaches (8.5 mm).
    scene::Object plane = bodyOf(scene::Plane{{0.11f, 0.11f}}, marble());
    plane.transform.rotate = {90, 0, 0};
    scene::Scene scene = seen({plane}, 0.002f);
    scene.lights = {scene::DistantLight{.direction = {0, 0, -1}}};
    const double expected[] = {0.8302, 0.7910, 0.7526};
    for (const Method method : {Method::Splat, Method::Multires}) {
        const Image image = draw(scene, {16, 16}, with(method));
        for (int channel = 0; channel < 3; ++channel) {
            double least = 1e30, most = 0;
            for (int i = 0; i < 256; ++i) {
                const double value = double(image.at(i % 16, i / 16)[channel]) / entering(1);
                least = std::min(least, value);
                most = std::max(most, value);
            }
            EXPECT_NEAR(least / expected[channel], 1, 0.005);
            EXPECT_NEAR(most / expected[channel], 1, 0.005);
        }
    }
}

// Radiosity of a sphere at an angle from where parallel light meets it, by the sum over all it lights: of
// dipoles at the distance through space, or with poles along the normal.
std::vector<dvec3> sphereTruth(double radius, const scene::Material& material,
                               DipoleGeometry geometry = DipoleGeometry::Planar) {
    const auto media = diffusion::mediaOf(material);
    std::vector<double> angles;
    for (int i = 0; i <= 120; ++i) // light falls by e in 7 degrees: between 1.5 it is linear to 0.6 %
        angles.push_back(kPi64 * i / 120);
    std::vector<dvec3> list(angles.size(), dvec3(0));
    constexpr int kPolar = 240, kAzimuth = 200;
    for (std::size_t a = 0; a < angles.size(); ++a) {
        const dvec3 xo = radius * dvec3(std::sin(angles[a]), 0, std::cos(angles[a]));
        for (int i = 0; i < kPolar; ++i) {
            const double polar = 0.5 * kPi64 * (i + 0.5) / kPolar;
            const double area =
                radius * radius * std::sin(polar) * 0.5 * kPi64 / kPolar * kPi64 / kAzimuth * 2;
            const double flux = area * std::cos(polar) * entering(std::cos(polar));
            for (int j = 0; j < kAzimuth; ++j) {
                const double azimuth = kPi64 * (j + 0.5) / kAzimuth; // half of them: mirrored
                const dvec3 n(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                              std::cos(polar));
                const dvec3 away = xo - radius * n;
                for (int c = 0; c < 3; ++c) {
                    const diffusion::Medium& m = media[std::size_t(c)];
                    const double zr = 1 / (m.scattering + m.absorption);
                    const double fdr = -1.440 / 2.25 + 0.710 / 1.5 + 0.668 + 0.0636 * 1.5;
                    const double zv = zr * (1 + 4.0 / 3 * (1 + fdr) / (1 - fdr));
                    const double tr = std::sqrt(3 * m.absorption * (m.scattering + m.absorption));
                    const auto pole = [&](double depth, double weight) {
                        double d = std::sqrt(glm::dot(away, away) + depth * depth);
                        if (geometry == DipoleGeometry::Offset)
                            d = std::max(std::abs(depth), glm::length(away + depth * n));
                        return weight * (1 + tr * d) * std::exp(-tr * d) / (d * d * d);
                    };
                    list[a][c] += flux * m.scattering * zr / (4 * kPi64) * (pole(zr, zr) + pole(-zv, zv));
                }
            }
        }
    }
    return list;
}

struct Misplaced {
    double share = 0; // of the light
    double side = 0;  // largest error from 80 to 120 degrees from the light
};

Misplaced misplaced(const Image& image, double radius, double height, const std::vector<dvec3>& truth) {
    Misplaced found;
    double sum = 0;
    const int n = image.width;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            const dvec2 place = (dvec2(x, y) + 0.5 - 0.5 * n) * height / double(n);
            const double square = 1 - glm::dot(place, place) / radius / radius;
            if (square < 1e-3 || image.at(x, y)[3] < 0) continue;
            const double angle = std::acos(std::clamp(place.x / radius, -1.0, 1.0));
            const double at = angle / kPi64 * double(truth.size() - 1);
            const auto low = std::min(std::size_t(at), truth.size() - 2);
            const dvec3 wanted = glm::mix(truth[low], truth[low + 1], at - double(low));
            for (int c = 0; c < 3; ++c) {
                const double error = double(image.at(x, y)[c]) - wanted[c];
                found.share += std::abs(error) / std::sqrt(square); // of the surface behind the pixel
                sum += wanted[c] / std::sqrt(square);
                if (angle > 80 * kPi64 / 180 && angle < 120 * kPi64 / 180)
                    found.side = std::max(found.side, std::abs(error) / wanted[c]);
            }
        }
    found.share /= sum;
    return found;
}

TEST_F(SubsurfaceTest, AMarbleSphereIsTheSumOverAllItsPoints) {
    // Measured on llvmpipe: 0.13 to 0.52 % misplaced, 3.6 to 4.4 % to the side, where points are fewest.
    const scene::Scene scene = sphereFromTheSide(0.01, marble());
    for (const auto geometry : {DipoleGeometry::Planar, DipoleGeometry::Offset}) {
        const std::vector<dvec3> truth = sphereTruth(0.01, marble(), geometry);
        for (const Method method : {Method::Multires, Method::Splat}) {
            const Image image = draw(scene, {64, 64}, with(method, geometry));
            const Misplaced found = misplaced(image, 0.01, 0.022, truth);
            EXPECT_LT(found.share, 0.02);
            EXPECT_LT(found.side, 0.05);
        }
    }
}

TEST_F(SubsurfaceTest, AHalfLitHalfSpaceIsHalfAsBrightAtTheEdgeAndItsSidesAddUp) {
    // Something hidden from the camera stands in the way on one side.
    scene::Scene scene = sheet(dense(), 0.04f, 0.008f);
    const float whole = atMiddle(draw(scene, {33, 33}));
    scene::Object blind = bodyOf(scene::Plane{{0.03f, 0.06f}}, {}, {-0.015f, 0, 0.001f});
    blind.material.diffuse = vec3(0);
    blind.transform.rotate = {90, 0, 0};
    blind.visible = false;
    scene.objects.push_back(blind);
    const Image image = draw(scene, {33, 33});
    // The edge lies in the middle of a pixel, but for half a texel of the lamp's view, 0.03 mm, in which
    // light changes by 3 %: the dipole's line integral is about 1 / mm.
    EXPECT_NEAR(image.at(16, 16)[1] / whole, 0.5, 0.035);
    for (int x = 0; x < 14; ++x)
        EXPECT_NEAR((image.at(x, 16)[1] + image.at(32 - x, 16)[1]) / whole, 1, 0.02) << x;
    EXPECT_LT(image.at(0, 16)[1] / whole, 0.1);
}

TEST_F(SubsurfaceTest, TouchingObjectsGetNothingOfEachOther) {
    // Light along +x ends on the left block: the right one, which touches it, is dark, exactly.
    scene::Scene scene = seen({bodyOf(scene::Box{vec3(0.01f)}, marble(), {-0.005f, 0, 0}),
                               bodyOf(scene::Box{vec3(0.01f)}, marble(), {0.005f, 0, 0})},
                              0.012f);
    scene.lights = {scene::DistantLight{.direction = {1, 0, 0}}};
    for (const Method method : {Method::Splat, Method::Multires}) {
        const Image image = draw(scene, {64, 32}, with(method));
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 64; ++x) {
                const float value = image.at(x, y)[1];
                if (value < 0) continue; // the background's -1
                if (x > 31) {
                    EXPECT_EQ(value, 0);
                } else if (x < 31) {
                    EXPECT_GT(value, 0);
                }
            }
    }
}

TEST_F(SubsurfaceTest, WhereNothingIsAbsorbedLightEndsWithTheObject) {
    scene::Material material = marble();
    material.translucent().absorption = vec3(0);
    const Image image = draw(sphereFromTheSide(0.01, material), {48, 48});
    EXPECT_LT(misplaced(image, 0.01, 0.022, sphereTruth(0.01, material)).share, 0.02);
}

TEST_F(SubsurfaceTest, AMeanFreePathOfAHundredObjectsLightsThemEvenly) {
    scene::Material material = marble();
    material.translucent().scattering = vec3(1);
    material.translucent().absorption = vec3(0.1f);
    const Image image = draw(sphereFromTheSide(0.01, material), {48, 48});
    EXPECT_LT(misplaced(image, 0.01, 0.022, sphereTruth(0.01, material)).share, 0.02);
}

TEST_F(SubsurfaceTest, AMeanFreePathOfAHundredthOfAPixelLeavesLightWhereItEntered) {
    scene::Material material = marble();
    material.translucent().scattering = vec3(1e7f);
    material.translucent().absorption = vec3(1e4f);
    const Image image = draw(sheet(material, 0.1f, 0.02f), {8, 8});
    const double expected = entering(1) * diffusion::totalReflectance(diffusion::mediaOf(material)[1],
                                                                      diffusion::Shape::Dipole, 0);
    for (int i = 0; i < 64; ++i)
        EXPECT_NEAR(double(image.at(i % 8, i / 8)[1]) / expected, 1, 0.01);
}

TEST_F(SubsurfaceTest, WhatScattersNothingIsBlack) {
    // And ever darker on the way there: of a ball R_d is sigma_s' / (4 pi) times what does not depend on it.
    float before = 0;
    for (const float scattering : {1e-2f, 1e-5f, 1e-30f}) {
        scene::Material material = marble();
        material.translucent().scattering = vec3(scattering);
        const Image image = draw(sphereFromTheSide(0.01, material), {16, 16});
        const float value = image.at(12, 8)[1];
        EXPECT_TRUE(std::isfinite(value)) << scattering;
        EXPECT_GE(value, 0) << scattering;
        if (before > 0) {
            EXPECT_NEAR(value / before, scattering > 1e-10f ? 1e-3f : 0, 1e-5f) << scattering;
        }
        before = value;
    }
}

TEST_F(SubsurfaceTest, AnisotropyEntersByTheReducedCoefficientOnly) {
    scene::Material forward = marble();
    forward.translucent().anisotropy = 0.99f;
    forward.translucent().scattering /= 1 - forward.translucent().anisotropy;
    const Image even = draw(sphereFromTheSide(0.01, marble()), {32, 32}),
                ahead = draw(sphereFromTheSide(0.01, forward), {32, 32});
    for (std::size_t i = 0; i < even.pixels.size(); ++i)
        EXPECT_NEAR(ahead.pixels[i], even.pixels[i], 1e-5f * std::abs(even.pixels[i]));
}

TEST_F(SubsurfaceTest, ASurfaceOfIndexOneMirrorsNothing) {
    // A is that of F_dr = -1.440 + 0.710 + 0.668 + 0.0636, and everything enters.
    scene::Material material = dense();
    material.translucent().ior = 1;
    const Image image = draw(sheet(material, 0.04f, 0.002f), {8, 8});
    const double albedo = 2620.0 / 2820, s = std::sqrt(3 * (1 - albedo)), a = (1 + 0.0016) / (1 - 0.0016);
    const double expected = 0.5 * albedo * (1 + std::exp(-4.0 / 3 * a * s)) * std::exp(-s);
    EXPECT_NEAR(double(atMiddle(image)) / expected, 1, 0.01);
}

TEST_F(SubsurfaceTest, PointsThatCoincideWithWhatIsSeenHaveAFiniteShare) {
    // Eye and lamp see the same lattice, and Burley's profile is infinite at 0: each texel's mean counts.
    Settings settings;
    settings.profile = diffusion::Shape::Burley;
    const double expected = entering(1) * diffusion::totalReflectance(diffusion::mediaOf(dense())[1],
                                                                      diffusion::Shape::Burley, 0);
    for (const Method method : {Method::Splat, Method::Multires}) {
        settings.method = method;
        const Image image = draw(sheet(dense(), 0.04f, 0.04f), {64, 64}, settings);
        EXPECT_NEAR(double(atMiddle(image)) / expected, 1, 0.02) << int(method);
    }
    // Two bodies in one place are each as it is alone.
    scene::Scene one = sphereFromTheSide(0.01, dense());
    const Image alone = draw(one, {24, 24});
    one.objects.push_back(one.objects.front());
    const Image both = draw(one, {24, 24});
    for (std::size_t i = 0; i < alone.pixels.size(); ++i)
        EXPECT_NEAR(both.pixels[i], alone.pixels[i], 1e-6f);
}

TEST_F(SubsurfaceTest, GrazingLightLeavesWhatEntersOfIt) {
    const double whole =
        diffusion::totalReflectance(diffusion::mediaOf(dense())[1], diffusion::Shape::Dipole, 0);
    for (const double degrees : {80.0, 89.0, 89.9}) {
        const double radians = degrees * kPi64 / 180, cosine = std::cos(radians);
        scene::Scene scene = sheet(dense(), 0.04f, 0.002f);
        scene.lights = {scene::DistantLight{.direction = {float(std::sin(radians)), 0, float(-cosine)}}};
        const double expected = cosine * entering(cosine) * whole;
        EXPECT_NEAR(double(atMiddle(draw(scene, {8, 8}))) / expected, 1, 0.02) << degrees;
    }
}

TEST_F(SubsurfaceTest, AProjectorsLightEntersWhereItsPictureIsBright) {
    scene::Scene scene = sphereFromTheSide(0.01, dense());
    scene::SpotLight lamp{.position = {0, 0, 0.5f},
                          .direction = {0, 0, -1},
                          .intensity = 1,
                          .innerAngle = 20,
                          .outerAngle = 25};
    const auto drawn = [&] {
        scene.lights = {lamp};
        return draw(scene, {24, 24});
    };
    const auto sums = [&](const Image& image) { // left and right half
        dvec2 sum(0);
        for (int y = 0; y < 24; ++y)
            for (int x = 0; x < 24; ++x)
                sum[x < 12 ? 0 : 1] += std::max(0.0, double(image.at(x, y)[1])); // -1 beside the ball
        return sum;
    };
    const dvec2 plain = sums(drawn());
    auto picture = std::make_shared<Image>(2, 2, 3);
    std::fill(picture->pixels.begin(), picture->pixels.end(), 0.5f);
    lamp.image = picture;
    lamp.fov = 10;
    const dvec2 grey = sums(drawn());
    EXPECT_NEAR(grey.x / plain.x, 0.5, 1e-3);
    EXPECT_NEAR(grey.y / plain.y, 0.5, 1e-3);
    // Dark on the left, seen from lamp and camera alike.
    auto halves = std::make_shared<Image>(256, 256, 3);
    for (int y = 0; y < 256; ++y)
        std::fill_n(halves->at(128, y), 3 * 128, 1.0f);
    lamp.image = halves;
    const dvec2 half = sums(drawn());
    EXPECT_NEAR((half.x + half.y) / (plain.x + plain.y), 0.5, 0.01);
    EXPECT_LT(half.x, 0.1 * half.y);
}

TEST_F(SubsurfaceTest, ABodyThatLeavesALampsConeFadesToBlack) {
    scene::Scene scene = sphereFromTheSide(0.01, dense());
    std::vector<double> light;
    for (const float aside : {0.0f, 0.05f, 0.085f, 0.14f}) { // where the cone is 0.09 m wide
        scene.objects[0].transform.translate = {0, aside, 0};
        scene.camera.eye.y = scene.camera.target.y = aside;
        scene.lights = {scene::SpotLight{.position = {0.5f, 0, 0},
                                         .direction = {-1, 0, 0},
                                         .intensity = 1,
                                         .innerAngle = 8,
                                         .outerAngle = 10.2f}};
        const Image image = draw(scene, {24, 24});
        double sum = 0;
        for (std::size_t i = 1; i < image.pixels.size(); i += 4) {
            EXPECT_TRUE(std::isfinite(image.pixels[i]));
            sum += std::max(0.0, double(image.pixels[i]));
        }
        light.push_back(sum);
    }
    EXPECT_GT(light[0], 0);
    EXPECT_NEAR(light[1] / light[0], 1, 0.1); // inside, somewhat farther off
    EXPECT_GT(light[2], 0.01 * light[0]);
    EXPECT_LT(light[2], 0.5 * light[0]);
    EXPECT_EQ(light[3], 0);
}

// Largest over least green radiosity of a picture.
double unevenness(const Image& image) {
    double least = 1e30, most = 0;
    for (std::size_t i = 1; i < image.pixels.size(); i += 4) {
        least = std::min(least, double(image.pixels[i]));
        most = std::max(most, double(image.pixels[i]));
    }
    return most / least;
}

TEST_F(SubsurfaceTest, TooFewSplatsBlurWhereThePapersShowAsDots) {
    // As in figure 6.10: 16 points a side, 2.5 mm apart, of light that reaches about one.
    const scene::Scene scene = sheet(dense(), 0.04f, 0.01f);
    Settings settings = with(Method::Splat);
    settings.mostSplats = 16;
    const Image blurred = draw(scene, {32, 32}, settings);
    const double expected = entering(1) * diffusion::totalReflectance(diffusion::mediaOf(dense())[1],
                                                                      diffusion::Shape::Dipole, 0);
    EXPECT_LT(unevenness(blurred), 1.03);
    EXPECT_NEAR(double(atMiddle(blurred)) / expected, 1, 0.03);
    settings.splats = Splats::Paper;
    EXPECT_GT(unevenness(draw(scene, {32, 32}, settings)), 3);
}

TEST_F(SubsurfaceTest, AThinSheetShinesWhereItIsLitFromBehind) {
    // Through a thickness d, light of points at a distance r >= d: what the profile holds beyond d.
    constexpr double thickness = 0.001;
    scene::Scene scene = seen({bodyOf(scene::Box{{0.04f, 0.04f, float(thickness)}}, dense())}, 0.004f);
    scene.lights = {scene::DistantLight{.direction = {0, 0, 1}}};
    const Image image = draw(scene, {16, 16});
    const diffusion::Medium medium = diffusion::mediaOf(dense())[1];
    const double expected =
        entering(1) * (diffusion::totalReflectance(medium, diffusion::Shape::Dipole, 0) -
                       diffusion::reflectanceWithin(medium, diffusion::Shape::Dipole, 0, thickness));
    EXPECT_NEAR(double(atMiddle(image)) / expected, 1, 0.03); // of what leaves, a fifth of what entered
}

TEST_F(SubsurfaceTest, APointLightAsNearAsItsLightReachesNeedsAllItsFaces) {
    // Below a light at height h: the integral over rings of R(r) I h / (h² + r²)^(3/2) F_t.
    constexpr double height = 0.002;
    scene::Scene scene = sheet(dense(), 0.04f, 0.0005f);
    scene.lights = {scene::PointLight{.position = {0, 0, float(height)},
                                      .intensity = 1e-6f,
                                      .falloff = scene::LightFalloff::InverseSquare}};
    const diffusion::Medium medium = diffusion::mediaOf(dense())[1];
    double expected = 0;
    for (int i = 0; i < 4000; ++i) {
        const double r = 0.02 * (i + 0.5) / 4000, d = std::hypot(height, r);
        expected += 2 * kPi64 * r * 0.02 / 4000 * 1e-6 * height / (d * d * d) * entering(height / d) *
                    diffusion::reflectance(medium, diffusion::Shape::Dipole, 0, r);
    }
    EXPECT_NEAR(double(atMiddle(draw(scene, {9, 9}))) / expected, 1, 0.02);
}

TEST_F(SubsurfaceTest, AnEvenEnvironmentLightsASphereEvenly) {
    // Of a sphere 2 pi r dr lies at distances between r and r + dr: pi mean F_t times what the profile holds
    // within its diameter.
    scene::Scene scene = seen({bodyOf(scene::Sphere{0.01f}, dense())}, 0.022f);
    auto map = std::make_shared<Image>(8, 4, 3);
    std::fill(map->pixels.begin(), map->pixels.end(), 1.0f);
    scene.environment.emplace();
    scene.environment->map = map;
    Settings settings;
    settings.epsilon = 0.05f;
    const Image image = draw(scene, {48, 48}, settings);
    const double expected =
        kPi64 * diffusion::meanTransmittance(1.5) *
        diffusion::reflectanceWithin(diffusion::mediaOf(dense())[1], diffusion::Shape::Dipole, 0, 0.02);
    double worst = 0;
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 48; ++x)
            if (image.at(x, y)[1] >= 0)
                worst = std::max(worst, std::abs(double(image.at(x, y)[1]) / expected - 1));
    EXPECT_LT(worst, 0.05);
}

TEST_F(SubsurfaceTest, TheSamePictureComesOutTwice) {
    const scene::Scene scene = sphereFromTheSide(0.01, dense());
    EXPECT_EQ(draw(scene, {48, 48}).pixels, draw(scene, {48, 48}).pixels);
}

TEST_F(SubsurfaceTest, WhatLeavesIsSeenFromSomewhere) {
    // Radiance times cosine over all directions is B: without the highlight, L = B F_t / (pi mean F_t)
    // head-on.
    scene::Scene scene = sheet(dense(), 0.04f, 0.002f);
    scene.objects[0].material.translucent().roughness = 0; // shows no lamp that is a point
    const float radiosity = atMiddle(draw(scene, {8, 8})),
                radiance = atMiddle(draw(scene, {8, 8}, {}, false));
    EXPECT_NEAR(radiance, radiosity * entering(1) / (kPi64 * diffusion::meanTransmittance(1.5)), 1e-5);
    Settings papers;
    papers.exit = Exit::Paper;
    EXPECT_NEAR(atMiddle(draw(scene, {8, 8}, papers, false)), radiosity * entering(1) / kPi64, 1e-5);
}

TEST_F(SubsurfaceTest, ANearLampIsNamedWhereNoFinerLevelsMakeUpForIt) {
    // Three radii away the far side of a ball is narrower in perspective than its middle. The
    // dissertation's splats have one level.
    scene::Scene scene = seen({bodyOf(scene::Sphere{0.01f}, marble())}, 0.022f);
    scene.lights = {scene::PointLight{.position = {0.02f, 0.01f, 0.02f}}};
    Settings paper = with(Method::Splat);
    paper.splats = Splats::Paper;
    paper.mostSplats = 64;
    testing::internal::CaptureStderr();
    draw(scene, {8, 8});
    const std::string bound = testing::internal::GetCapturedStderr();
    testing::internal::CaptureStderr();
    draw(scene, {8, 8}, paper);
    const std::string papers = testing::internal::GetCapturedStderr();
    EXPECT_EQ(bound.find("patchy"), std::string::npos) << bound;
    for (const char* part : {"subsurface: a light's view of object \"body\" asks for ",
                             " pixels a side; 64 are drawn, and its light is patchy"})
        EXPECT_NE(papers.find(part), std::string::npos) << papers;
}

// The last one: no context stays behind.
TEST_F(SubsurfaceTest, WithoutFloatBlendingLightIsGatheredToThreeDigits) {
    const scene::Scene ball = sphereFromTheSide(0.01, marble()), plane = sheet(dense(), 0.01f, 0.001f);
    const Settings bands = with(Method::Multires, DipoleGeometry::Planar, 0.05f);
    Settings million = with(Method::Splat);
    million.splats = Splats::Paper;
    million.mostSplats = 1024;
    const Image splatted = draw(ball, {32, 32}, bands), dots = draw(plane, {4, 4}, million);
    const std::string_view missing[] = {"EXT_float_blend"};
    const auto lesser = gl::Context::create(missing);
    ASSERT_TRUE(lesser.ok());
    gl::Context* const before = std::exchange(context, lesser->get());
    const Image gathered = draw(ball, {32, 32}, bands), gatheredDots = draw(plane, {4, 4}, million);
    EXPECT_EQ(context->takeError(), "");
    context = before;
    double most = 0, worst = 0;
    for (std::size_t i = 0; i < splatted.pixels.size(); ++i)
        if (i % 4 != 3 && splatted.pixels[i] >= 0) {
            most = std::max(most, double(splatted.pixels[i]));
            worst = std::max(worst, std::abs(double(splatted.pixels[i]) - double(gathered.pixels[i])));
        }
    // Some dozens of sums, each rounded to 11 bits of what is there; measured 1.4e-3 on llvmpipe.
    EXPECT_LT(worst / most, 0.01);
    // A sum of a million in halves stops growing at 2048 of the last digits of what is added; gathered, it is
    // stored once a part.
    const double expected = entering(1) * diffusion::reflectanceWithin(diffusion::mediaOf(dense())[1],
                                                                       diffusion::Shape::Dipole, 0, 0.005);
    EXPECT_NEAR(double(atMiddle(dots)) / expected, 1, 0.02);
    EXPECT_NEAR(atMiddle(gatheredDots) / atMiddle(dots), 1, 0.005f);
}

} // namespace
} // namespace lucent::subsurface
