#include "truth/Walk.h"

#include "tests/truth/bodies.h"
#include "truth/Dipole.h"

namespace lucent::truth {
namespace {

using test::fresnel;

constexpr double kPi = std::numbers::pi;
const std::atomic<bool> kNever = false;

Picture walks(const scene::Scene& scene, ivec2 size, const WalkOptions& options, const Tile& part = {},
              int threads = 2) {
    Work work;
    work.threads = threads;
    Result<Picture> picture = traceWalks(scene, size, options, part, work, kNever);
    EXPECT_TRUE(picture) << picture.error().message;
    return std::move(*picture);
}

EnergyBook bookOf(const scene::Scene& scene, const WalkOptions& options) {
    return *walks(scene, {4, 4}, options).energy;
}

/// The marble sphere from aside: the light comes from the right.
scene::Scene fromAside() {
    scene::Scene scene = test::marbleSphere();
    scene.camera.eye = {0, -1, 0};
    scene.camera.up = {-1, 0, 0};
    scene.camera.height = 0.02f;
    return scene;
}

TEST(Walk, BooksAddUp) {
    const EnergyBook book = bookOf(fromAside(), {.photons = 20000});
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(book.reflected[c] + book.absorbed[c] + book.escaped[c] + book.lost[c], book.incident[c],
                    1e-12 * book.incident[c]);
        EXPECT_EQ(book.lost[c], 0);
        EXPECT_EQ(book.received[c], 0);
        // All rays meet the ball that they are aimed at: pi R² W, of a third of the rays.
        EXPECT_NEAR(book.incident[c] / (kPi * 1e-4), 1, 4 * std::sqrt(2.0 / 20000));
        // 2 integral of F(c) c dc outside.
        EXPECT_NEAR(book.reflected[c] / book.incident[c], 1 - 0.9082, 0.01);
    }
}

TEST(Walk, MarbleSphereGivesBackTheKnownShares) {
    const EnergyBook book = bookOf(fromAside(), {.photons = 90000});
    const double known[] = {0.853, 0.813, 0.769};
    for (int c = 0; c < 3; ++c)
        // A ray's share spreads by 0.2 at most: 0.0012 of the mean of 30000.
        EXPECT_NEAR(book.escaped[c] / book.incident[c], known[c], 0.004);
}

TEST(Walk, WithoutAbsorptionAllLightLeaves) {
    scene::Scene scene = fromAside();
    scene.objects[0].material.translucent().absorption = vec3(0);
    scene.objects[0].material.translucent().scattering = vec3(300, 1000, 1e-6f);
    for (const float ior : {1.0f, 1.5f, 0.7f}) {
        scene.objects[0].material.translucent().ior = ior;
        const EnergyBook book = bookOf(scene, {.photons = 6000});
        for (int c = 0; c < 3; ++c) {
            // Roulette ends ways whose light others carry on: a spread of the few percent that were left.
            EXPECT_NEAR(book.absorbed[c] / book.incident[c], 0, 5e-3) << ior;
            EXPECT_NEAR((book.escaped[c] + book.reflected[c]) / book.incident[c], 1, 5e-3) << ior;
            if (ior == 1) {
                EXPECT_EQ(book.reflected[c], 0);
            }
        }
    }
}

TEST(Walk, HalfSpaceOfIsotropicScatterersReflectsByChandrasekharsFunction) {
    // Index 1, light straight from above: 1 - sqrt(1 - a) H(1), and H by its own equation
    // 1 / H(m) = sqrt(1 - a) + (a / 2) integral of m' H(m') / (m + m') dm' (Chandrasekhar 1950), iterated.
    const auto known = [](double albedo) {
        constexpr int kSteps = 400;
        std::vector<double> h(kSteps, 1.0);
        const auto at = [&](double m) {
            double sum = 0;
            for (int i = 0; i < kSteps; ++i) {
                const double other = (i + 0.5) / kSteps;
                sum += other * h[std::size_t(i)] / (m + other) / kSteps;
            }
            return 1 / (std::sqrt(1 - albedo) + 0.5 * albedo * sum);
        };
        for (int round = 0; round < 60; ++round) {
            std::vector<double> next;
            for (int i = 0; i < kSteps; ++i)
                next.push_back(at((i + 0.5) / kSteps));
            h = next;
        }
        return 1 - std::sqrt(1 - albedo) * at(1);
    };
    // A mean free path is 1e-5 of the plane: nothing reaches its edge.
    scene::Scene scene = test::marbleHalfSpace();
    scene::Translucent& material = scene.objects[0].material.translucent();
    const dvec3 albedo(0.5, 0.9, 0.99);
    material.ior = 1;
    material.scattering = vec3(1e5 * albedo);
    material.absorption = vec3(1e5 * (1.0 - albedo));
    const EnergyBook book = bookOf(scene, {.photons = 300000});
    for (int c = 0; c < 3; ++c)
        // Two thirds of the rays aimed at the ball around the square meet it; a share spreads by 0.4 at most.
        EXPECT_NEAR(book.escaped[c] / book.incident[c], known(albedo[c]), 4 * 0.4 / std::sqrt(6e4));
}

TEST(Walk, ForwardScatteringSpreadsLightAsTheReducedCoefficientSays) {
    // Similarity, where light forgets its direction before it leaves: the sphere is 22 reduced free ways
    // thick.
    scene::Scene scene = fromAside();
    scene::Translucent& material = scene.objects[0].material.translucent();
    material.anisotropy = 0.8f;
    material.scattering /= 1 - material.anisotropy;
    const EnergyBook book = bookOf(scene, {.photons = 15000});
    const double known[] = {0.853, 0.813, 0.769};
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(book.escaped[c] / book.incident[c], known[c], 0.01);
}

TEST(Walk, PicturesFromAllSidesHoldTheLightThatLeaves) {
    // A flat body from above, from below and from its four equal sides: the same rays, each seen once.
    scene::Scene scene = test::sceneOf({test::marble(scene::Box{{0.02f, 0.004f, 0.02f}})});
    scene.lights.push_back(test::sun({0, -1, 0}));
    double leaving = 0, escaped = 0;
    const auto add = [&](vec3 eye, vec3 up, float height, ivec2 size) {
        scene.camera.eye = eye;
        scene.camera.up = up;
        scene.camera.height = height;
        const Picture picture = walks(scene, size, {.aov = scene::Aov::Radiosity, .photons = 8000});
        const double pixel = std::pow(double(height) / size.y, 2);
        for (std::size_t i = 0; i < picture.values.pixels.size(); i += 4) {
            leaving += pixel * double(picture.values.pixels[i]);
            EXPECT_EQ(picture.values.pixels[i + 3], 1);
        }
        escaped = picture.energy->escaped.x;
    };
    add({0, 1, 0}, {0, 0, 1}, 0.02f, {4, 4});
    add({0, -1, 0}, {0, 0, 1}, 0.02f, {4, 4});
    for (const float side : {-1.0f, 1.0f}) {
        add({side, 0, 0}, {0, 1, 0}, 0.004f, {5, 1});
        add({0, 0, side}, {0, 1, 0}, 0.004f, {5, 1});
    }
    EXPECT_GT(escaped, 0);
    EXPECT_NEAR(leaving / escaped, 1, 1e-5); // pixels are floats
}

TEST(Walk, ColourIsRadiosityByTheLobe) {
    scene::Scene scene = fromAside();
    const Picture color = walks(scene, {1, 1}, {.photons = 2000});
    const Picture radiosity = walks(scene, {1, 1}, {.aov = scene::Aov::Radiosity, .photons = 2000});
    // One pixel shows all directions at once: F_t is at most 0.96.
    const double share = double(color.values.pixels[0] / radiosity.values.pixels[0]);
    EXPECT_GT(share, 0.8 / kPi);
    EXPECT_LT(share, 0.96 / (0.908 * kPi) * 1.001);
}

TEST(Walk, ErrorsAreHonest) {
    const WalkOptions one{.aov = scene::Aov::Radiosity, .photons = 20000, .seed = 1};
    WalkOptions two = one;
    two.seed = 2;
    const Picture a = walks(fromAside(), {6, 6}, one), b = walks(fromAside(), {6, 6}, two);
    double sum = 0;
    int count = 0;
    for (std::size_t i = 0; i < 36; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const double error =
                std::hypot(double(a.errors.pixels[3 * i + c]), double(b.errors.pixels[3 * i + c]));
            if (a.values.pixels[4 * i + c] == 0 || b.values.pixels[4 * i + c] == 0) continue;
            const double apart = double(a.values.pixels[4 * i + c] - b.values.pixels[4 * i + c]) / error;
            sum += apart * apart;
            ++count;
        }
    EXPECT_GT(count, 60);
    EXPECT_NEAR(sum / count, 1, 4 * std::sqrt(2.0 / count)); // of a sum of squares of normal numbers
}

TEST(Walk, DependsOnTheSeedAndNotOnThreads) {
    const WalkOptions options{.photons = 9000, .seed = 3};
    const Picture one = walks(fromAside(), {6, 6}, options, {}, 1),
                  three = walks(fromAside(), {6, 6}, options, {}, 3);
    EXPECT_EQ(one.values.pixels, three.values.pixels);
    EXPECT_EQ(one.errors.pixels, three.errors.pixels);
    EXPECT_NE(walks(fromAside(), {6, 6}, {.photons = 9000, .seed = 4}).values.pixels, one.values.pixels);
    EXPECT_NE(walks(fromAside(), {6, 6}, options, {0, 2}).values.pixels,
              walks(fromAside(), {6, 6}, options, {1, 2}).values.pixels);
}

TEST(Walk, LampsOfAnyKindAndTheSkyEnter) {
    for (const bool spot : {false, true}) {
        scene::Scene scene = fromAside();
        scene.lights.clear();
        if (spot) {
            scene::SpotLight lamp;
            lamp.position = {0, 0, 1};
            lamp.direction = {0, 0, -1};
            scene.lights.push_back(lamp);
        } else {
            test::addSky(scene, vec3(1));
        }
        const EnergyBook book = bookOf(scene, {.photons = 6000});
        // The sky: pi W/m² on 4 pi R². The spot: its solid angle of the ball, 1 W/sr at 1 m.
        const double known = spot ? 2 * kPi * (1 - std::sqrt(1 - 1e-4)) : kPi * 4 * kPi * 1e-4;
        EXPECT_NEAR(book.incident.y / known, 1, 4 * std::sqrt(2.0 / 6000)) << spot;
    }
}

TEST(Walk, WhatStandsInTheLightsWayShadows) {
    scene::Scene scene = fromAside();
    scene.objects.push_back(test::matt(scene::Box{{0.1f, 0.1f, 0.01f}}, {0, 0, 0.1f}));
    const Picture dark = walks(scene, {2, 2}, {.aov = scene::Aov::Radiosity, .photons = 1000});
    EXPECT_EQ(dark.energy->incident, dvec3(0));
    EXPECT_EQ(dark.values.pixels[0], 0);
}

TEST(Walk, RefusesSlabsThatAreNoBodies) {
    scene::Scene scene = test::marbleSphere();
    scene.objects[0].material.translucent().thickness = 0.004f;
    const Result<Picture> picture = traceWalks(scene, {2, 2}, {}, {}, {}, kNever);
    ASSERT_FALSE(picture);
    EXPECT_EQ(
        picture.error().message,
        "truth: objects.marble.material.thickness is 0.004; walks go through the whole body: must be 0, "
        "and the shape that thin");
}

/// Mean radiosity in a band of angles from the light, of a square picture of the marble sphere from aside.
dvec3 inBand(const Picture& picture, double from, double to) {
    dvec3 sum(0);
    int count = 0;
    const int size = picture.values.width;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const dvec2 at =
                (dvec2(x, y) + 0.5) / double(size) * 2.0 - 1.0; // over the radius; light from x = 1
            const double angle = test::degrees(std::acos(at.x));
            if (glm::length(at) > 0.9 || angle < from || angle > to) continue; // whole pixels, not at a slant
            const float* value = picture.values.at(x, y);
            sum += dvec3(value[0], value[1], value[2]);
            ++count;
        }
    return sum / double(count);
}

TEST(Walk, DipoleIsFarTooDarkBehindABody) {
    // Over the walk, by offset: known at 150 degrees from the light for each colour, at 85 for all of them.
    constexpr int kParts = 8;
    const scene::Scene scene = fromAside();
    Estimate aside, behind;
    for (int part = 0; part < kParts; ++part) {
        const Picture picture = walks(
            scene, {60, 60}, {.aov = scene::Aov::Radiosity, .photons = 15000, .seed = std::uint64_t(part)});
        aside.add(inBand(picture, 82.5, 87.5));
        behind.add(inBand(picture, 140, 160)); // twenty degrees for enough rays: the ratio changes by a fifth
    }
    const auto dipole =
        DipoleEstimator::create(scene, {60, 60}, {.geometry = DipoleGeometry::Offset, .samples = 1024});
    ASSERT_TRUE(dipole);
    const auto expectRatio = [&](double from, double to, const Estimate& walked, const dvec3& known) {
        Estimate dark;
        constexpr int kSteps = 10;
        for (int i = 0; i < kSteps; ++i) {
            const double angle = (from + (to - from) * (i + 0.5) / kSteps) * kPi / 180;
            const dvec3 direction(0, -std::sin(angle), std::cos(angle));
            const Hit hit = test::intersect(dipole->bodies(), 0.02 * direction, -direction);
            dark.add(dipole->radiosity(dipole->bodies().all()[0], hit, std::uint64_t(i)).mean());
        }
        const dvec3 ratio = dark.mean() / walked.mean(), error = walked.standardError() / walked.mean();
        for (int c = 0; c < 3; ++c) {
            EXPECT_LT(error[c], 0.25);
            EXPECT_NEAR(ratio[c], known[c], 0.03 + 4 * ratio[c] * error[c]) << from << " " << c;
        }
    };
    expectRatio(82.5, 87.5, aside, dvec3(0.62));
    expectRatio(140, 160, behind, {0.36, 0.27, 0.21});
}

} // namespace
} // namespace lucent::truth
