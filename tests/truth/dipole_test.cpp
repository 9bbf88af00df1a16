#include "truth/Dipole.h"

#include "truth/EnteredLight.h"
#include "truth/Random.h"

#include "tests/truth/bodies.h"

#include <deque>

namespace lucent::truth {
namespace {

using test::fresnel;

constexpr double kPi = std::numbers::pi;
/// B over what enters evenly into a half space of marble, in closed form; see tests/diffusion.
constexpr double kHalfSpace[] = {0.8302, 0.7910, 0.7526};
constexpr double kRounded = 5e-5; ///< of the known answers as they are written

/// Estimators refer to their scene: it is kept.
DipoleEstimator estimator(const scene::Scene& scene, const DipoleOptions& options) {
    static std::deque<scene::Scene> kept;
    Result<DipoleEstimator> made = DipoleEstimator::create(kept.emplace_back(scene), {8, 8}, options);
    EXPECT_TRUE(made) << made.error().message;
    return std::move(*made);
}

/// B at the first place that a ray meets.
Estimate radiosityAt(const DipoleEstimator& dipole, const dvec3& from, const dvec3& direction,
                     std::uint64_t number = 0) {
    const Hit hit = test::intersect(dipole.bodies(), from, direction);
    return dipole.radiosity(*dipole.bodies().of(hit.shape), hit, number);
}

/// On a plane y = 0 at (x, 0).
Estimate onPlane(const DipoleEstimator& dipole, double x) {
    return radiosityAt(dipole, {x, 0.01, 0}, {0, -1, 0});
}

TEST(Dipole, HalfSpaceUnderEvenLightGivesBackTheKnownShare) {
    for (const DipoleGeometry geometry : {DipoleGeometry::Planar, DipoleGeometry::Offset})
        for (const Diffusion profile : {Diffusion::Dipole, Diffusion::Burley, Diffusion::Multipole}) {
            const DipoleEstimator dipole = estimator(
                test::marbleHalfSpace(), {.profile = profile, .geometry = geometry, .samples = 4096});
            const Estimate estimate = onPlane(dipole, 0.01);
            const double entering = 1 - fresnel(0, 1 / 1.5);
            for (int c = 0; c < 3; ++c) {
                EXPECT_LT(estimate.standardError()[c], 2e-3);
                EXPECT_NEAR(estimate.mean()[c], entering * kHalfSpace[c],
                            4 * estimate.standardError()[c] + kRounded);
            }
        }
}

TEST(Dipole, HalfSpaceUnderAnEvenSkyTakesTheMeanTransmittance) {
    scene::Scene scene = test::marbleHalfSpace();
    scene.lights.clear();
    test::addSky(scene, vec3(1));
    const Estimate estimate = onPlane(estimator(scene, {.samples = 1024}), 0);
    for (int c = 0; c < 3; ++c) // an irradiance of pi, of which 0.9082 enter (tests/diffusion)
        EXPECT_NEAR(estimate.mean()[c], kPi * 0.9082 * kHalfSpace[c], 4 * estimate.standardError()[c] + 1e-3);
}

TEST(Dipole, LightThatCameThroughAPaneEntersAsItDoesWithoutIt) {
    // Of an index so near to that of vacuum that nothing is bent: all light under it comes by rays.
    scene::Scene scene = test::marbleHalfSpace();
    scene.objects.push_back(test::glass(scene::Box{{0.1f, 0.01f, 0.1f}}, 1.0001f, {0, 0.03f, 0}));
    scene.objects.back().material.clear().fresnel = false;
    const DipoleEstimator dipole = estimator(scene, {.samples = 1024, .rays = 2'000'000});
    const double entering = 1 - fresnel(0, 1 / 1.5);
    for (const double x : {0.01, 0.05}) { // below the pane, and below its edge: half by rays, half straight
        const Estimate estimate = onPlane(dipole, x);
        for (int c = 0; c < 3; ++c) {
            EXPECT_LT(estimate.standardError()[c], 0.05); // mean free paths hold few of the rays
            EXPECT_NEAR(estimate.mean()[c], entering * kHalfSpace[c],
                        4 * estimate.standardError()[c] + kRounded)
                << x;
        }
    }
    const DipoleEstimator without = estimator(scene, {.samples = 1024, .rays = 0});
    EXPECT_LT(onPlane(without, 0.01).mean().g, 0.05);
}

TEST(EnteredLight, CountsWhatLiesFarAwayTogether) {
    Random random(1, 2, 3);
    std::vector<LightEntry> entries;
    for (int i = 0; i < 5000; ++i)
        entries.push_back({dvec3(random.next(), 0, random.next()), {0, 1, 0}, dvec3(random.next(), 1, 2)});
    const EnteredLight light(entries);
    for (const dvec3 place : {dvec3(0.5, 0, 0.5), dvec3(-0.2, 0.1, 0.3), dvec3(4, 1, 2)}) {
        const auto share = [&](const LightEntry& entry) {
            return entry.flux / (1e-6 + std::pow(glm::distance(entry.place, place), 3));
        };
        dvec3 all(0), together(0);
        int visits = 0;
        for (const LightEntry& entry : entries)
            all += share(entry);
        light.visit(place, [&](const LightEntry& entry) {
            together += share(entry);
            ++visits;
        });
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(together[c], all[c], 3e-3 * all[c]);
        if (place.x > 1) {
            EXPECT_LT(visits, 500);
        }
    }
}

TEST(Dipole, EdgeOfLightIsHalfAsBrightAndBothSidesAddUp) {
    // A screen over x < 0, too high for light to pass beneath it: the sun is straight above.
    scene::Scene scene = test::marbleHalfSpace();
    scene.objects.push_back(test::matt(scene::Plane{{0.6f, 0.6f}}, {-0.3f, 0.1f, 0}));
    const DipoleEstimator dipole = estimator(scene, {.samples = 4096});
    const double entering = 1 - fresnel(0, 1 / 1.5);
    for (const double x : {0.0, 2e-4, 1e-3, 5e-3}) {
        const Estimate lit = onPlane(dipole, x), dark = onPlane(dipole, -x);
        for (int c = 0; c < 3; ++c) {
            const double error = std::hypot(lit.standardError()[c], dark.standardError()[c]);
            EXPECT_LT(error, 0.01);
            EXPECT_NEAR(lit.mean()[c] + dark.mean()[c], entering * kHalfSpace[c], 4 * error + kRounded) << x;
            if (x > 1e-3) {
                EXPECT_GT(lit.mean()[c], 2 * dark.mean()[c]);
            }
        }
        if (x == 0) {
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(lit.mean()[c], 0.5 * entering * kHalfSpace[c],
                            4 * lit.standardError()[c] + kRounded);
        }
    }
}

/// B of the marble sphere at an angle from the light.
Estimate onSphere(const DipoleEstimator& dipole, double angle, std::uint64_t number = 0) {
    const dvec3 direction(std::sin(angle), 0, std::cos(angle));
    return radiosityAt(dipole, 0.02 * direction, -direction, number);
}

/// The share of the light that met the sphere which leaves it: integral of B over its surface, over pi R² E.
dvec3 shareThatLeaves(const DipoleEstimator& dipole) {
    constexpr int kBands = 40; // of equal area
    dvec3 sum(0);
    for (int i = 0; i < kBands; ++i)
        sum += onSphere(dipole, std::acos(1 - (2 * i + 1.0) / kBands), std::uint64_t(i)).mean();
    return 4.0 * sum / double(kBands);
}

TEST(Dipole, MarbleSphereGivesBackTheKnownSharesByEitherGeometry) {
    const double known[][3] = {{0.747, 0.717, 0.683}, {0.698, 0.677, 0.652}};
    for (const DipoleGeometry geometry : {DipoleGeometry::Planar, DipoleGeometry::Offset}) {
        const dvec3 share =
            shareThatLeaves(estimator(test::marbleSphere(), {.geometry = geometry, .samples = 4096}));
        // Of each of 40 places the error is 0.005 at most: 0.0008 of their mean, beside that of the answers.
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(share[c], known[int(geometry)][c], 3e-3) << int(geometry);
    }
}

TEST(Dipole, AnisotropyCountsOnlyInTheReducedCoefficient) {
    scene::Scene even = test::marbleSphere(), forward = test::marbleSphere();
    scene::Translucent& material = forward.objects[0].material.translucent();
    material.anisotropy = 0.99f;
    material.scattering /= 1 - material.anisotropy;
    const Estimate a = onSphere(estimator(even, {}), 1), b = onSphere(estimator(forward, {}), 1);
    for (int c = 0; c < 3; ++c) // 1 - 0.99 in floats: 6e-8 a hundred times over
        EXPECT_NEAR(b.mean()[c] / a.mean()[c], 1, 2e-5);
}

TEST(Dipole, LayerOfGreatThicknessIsAHalfSpace) {
    scene::Scene scene = test::marbleSphere();
    scene.objects[0].material.translucent().thickness = 1; // 117 or more diffusion lengths
    for (const DipoleGeometry geometry : {DipoleGeometry::Planar, DipoleGeometry::Offset})
        EXPECT_NEAR(
            onSphere(estimator(scene, {.profile = Diffusion::Multipole, .geometry = geometry}), 2).mean().x,
            onSphere(estimator(scene, {.geometry = geometry}), 2).mean().x, 1e-9);
}

TEST(Dipole, ThinLayerReflectsAsDiffusionInASlabDoes) {
    // Without absorption R = 1 - (l + z_b) / (d + 2 z_b), z_b = 2 A / (3 sigma'): tests/diffusion.
    scene::Scene scene = test::marbleHalfSpace();
    scene::Translucent& material = scene.objects[0].material.translucent();
    material.absorption = vec3(0);
    material.scattering = vec3(2000);
    material.thickness = 0.004f; // 8 mean free paths
    const double internal = 0.5967333, boundary = 2 * (1 + internal) / (1 - internal) / 6000;
    const double collides = 1 - std::exp(-8), depth = 5e-4 - 0.004 * std::exp(-8) / collides;
    const double share = collides * (1 - (depth + boundary) / (0.004 + 2 * boundary));
    const Estimate estimate =
        onPlane(estimator(scene, {.profile = Diffusion::Multipole, .samples = 8192}), 0);
    EXPECT_NEAR(estimate.mean().x, (1 - fresnel(0, 1 / 1.5)) * share, 4 * estimate.standardError().x + 1e-4);
}

TEST(Dipole, BodiesInTheDarkStayBlackBesideLitOnes) {
    // The small one touches the large one from behind, wholly in its shadow.
    scene::Scene scene = test::marbleSphere();
    scene.objects.push_back(test::marble(scene::Sphere{0.002f}, {0, 0, -0.012f}));
    const DipoleEstimator dipole = estimator(scene, {});
    EXPECT_GT(radiosityAt(dipole, {0.001, 0, 0.1}, {0, 0, -1}).mean().x, 0);
    for (int i = 0; i < 8; ++i) {
        const Estimate dark = radiosityAt(dipole, {0.0002 * i, 0, -0.1}, {0, 0, 1}, std::uint64_t(i));
        EXPECT_EQ(dark.mean(), dvec3(0));
    }
}

TEST(Dipole, LeavingLightIsSeenWhole) {
    // Integral of the lobe times the cosine over the hemisphere is 1: 2 pi c dc in even steps of c².
    const scene::Scene scene = test::marbleSphere();
    const Result<Bodies> bodies = Bodies::create(scene);
    const Body& body = bodies->all()[0];
    double sum = 0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i)
        sum += kPi / kSteps * body.lobe(std::sqrt((i + 0.5) / kSteps));
    EXPECT_NEAR(sum, 1, 1e-5);
}

TEST(Dipole, PixelsShowRadiosityOrItsLobe) {
    scene::Scene scene = test::marbleHalfSpace();
    scene.objects[0].material.translucent().roughness = 0; // mirrors no lamp
    scene.camera.type = scene::Camera::Type::Orthographic;
    scene.camera.eye = {0, 1, 1};
    scene.camera.up = {0, 1, 0};
    scene.camera.height = 0.01f;
    const auto solve = [&](scene::Aov aov, bool normalised) {
        return estimator(scene, {.aov = aov, .normalisedExit = normalised}).solve({3, 4});
    };
    const Pixel radiosity = solve(scene::Aov::Radiosity, true);
    EXPECT_EQ(radiosity.coverage, 1);
    const double through = 1 - fresnel(kPi / 4, 1 / 1.5);
    EXPECT_NEAR(solve(scene::Aov::Color, true).value.x / radiosity.value.x, through / (kPi * 0.9082), 1e-5);
    EXPECT_NEAR(solve(scene::Aov::Color, false).value.x / radiosity.value.x, through / kPi, 1e-9);
    EXPECT_NEAR(solve(scene::Aov::Color, true).variance.x / radiosity.variance.x,
                std::pow(through / (kPi * 0.9082), 2), 1e-5);
}

TEST(Dipole, HardCasesStayFinite) {
    const auto sphereOf = [](float scattering, float absorption, float ior, float radius) {
        scene::Scene scene = test::marbleSphere();
        std::get<scene::Sphere>(scene.objects[0].shape).radius = radius;
        scene::Translucent& material = scene.objects[0].material.translucent();
        material.scattering = vec3(scattering, scattering, 0); // the last colour does not scatter
        material.absorption = vec3(absorption);
        material.ior = ior;
        return scene;
    };
    for (const scene::Scene& scene :
         {sphereOf(2000, 0, 1.3f, 0.01f), sphereOf(1e-9f, 0, 1.3f, 0.01f), sphereOf(1e-9f, 1e6f, 1.3f, 0.01f),
          sphereOf(1, 0.1f, 1.5f, 0.01f), sphereOf(1e6f, 10, 1.5f, 0.01f), sphereOf(2000, 1, 1, 0.01f),
          sphereOf(2000, 1, 0.5f, 0.01f)})
        for (const DipoleGeometry geometry : {DipoleGeometry::Planar, DipoleGeometry::Offset})
            for (const double angle : {0.1, 1.5, 3.0}) {
                const Estimate estimate = onSphere(estimator(scene, {.geometry = geometry}), angle);
                EXPECT_TRUE(std::isfinite(estimate.mean().x) && std::isfinite(estimate.standardError().x));
                EXPECT_GE(estimate.mean().x, 0);
                EXPECT_LE(estimate.mean().x, 1.5); // of 1 W/m²
                EXPECT_EQ(estimate.mean().z, 0);
            }
}

TEST(Dipole, ThinSheetLitFromBehindIsFiniteAndGlows) {
    // As thick as the source lies deep: by offset the pole stands on the other side.
    scene::Scene scene = test::sceneOf({test::marble(scene::Box{{0.1f, 4.56e-4f, 0.1f}})});
    scene.lights.push_back(test::sun({0, -1, 0}));
    for (const DipoleGeometry geometry : {DipoleGeometry::Planar, DipoleGeometry::Offset}) {
        const Estimate below =
            radiosityAt(estimator(scene, {.geometry = geometry, .samples = 2048}), {0, -1, 0}, {0, 1, 0});
        EXPECT_GT(below.mean().x, 0.1);
        EXPECT_LT(below.mean().x, 1);
        EXPECT_LT(below.standardError().x, 0.02);
    }
}

TEST(Dipole, ScenesWithoutBodiesAndOtherQuantitiesAreRefused) {
    const auto messageOf = [](const scene::Scene& scene, scene::Aov aov) {
        const auto made = DipoleEstimator::create(scene, {8, 8}, {.aov = aov});
        return made ? std::string() : made.error().message;
    };
    EXPECT_EQ(messageOf(test::sceneOf({test::matt(scene::Sphere{})}), scene::Aov::Color),
              "truth: no object has subsurface scattering; must be one with material.scattering above 0");
    EXPECT_EQ(messageOf(test::marbleSphere(), scene::Aov::Depth),
              "truth: AOV depth is none of what has subsurface scattering; must be color or radiosity");
}

} // namespace
} // namespace lucent::truth
