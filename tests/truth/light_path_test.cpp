#include "scene/Keys.h"
#include "truth/LightPath.h"

#include "truth/Interface.h"

#include "tests/truth/scenes.h"

namespace lucent::truth {
namespace {
using test::angleBetween;
using test::Bench;
using test::degrees;
using test::glass;
using test::matt;

constexpr double kPi = std::numbers::pi;

TEST(Interface, ReflectsAsFresnelSays) {
    EXPECT_NEAR(reflectance(1, 1 / 1.5), 0.04, 1e-15); // ((n - 1) / (n + 1))²
    EXPECT_NEAR(reflectance(1, 1.5), 0.04, 1e-15);
    EXPECT_EQ(reflectance(0, 1 / 1.5), 1);
    EXPECT_EQ(reflectance(0.3, 1), 0);
    for (const double relative : {1 / 1.5, 1.5, 1 / 2.4, 1.33, 1 + 1e-4})
        for (double angle = 0; angle < 1.57; angle += 0.01)
            EXPECT_NEAR(reflectance(std::cos(angle), relative), test::fresnel(angle, relative), 1e-9)
                << relative << " " << angle;
    // Brewster's angle, tan = n: no light polarised along the plane, so half of what the other polarisation
    // reflects, ((n² - 1) / (n² + 1))².
    const double amplitude = 1.25 / 3.25;
    EXPECT_NEAR(reflectance(std::cos(std::atan(1.5)), 1 / 1.5), 0.5 * amplitude * amplitude, 1e-15);
}

TEST(LightPath, ASlabKeepsTheDirectionAndMovesTheRayAside) {
    const double thick = 0.4, n = 1.5;
    const Bench bench({glass(scene::Box{{20, 0.4f, 20}}, 1.5f), matt(scene::Plane{{40, 40}}, {0, -1, 0})});
    for (const double a : {0.0, 10.0, 45.0, 60.0, 80.0}) {
        const double sine = std::sin(a * kPi / 180), cosine = std::cos(a * kPi / 180);
        const Arrival arrival = bench.send({-sine / cosine, 1, 0}, {sine, -cosine, 0});
        ASSERT_EQ(arrival.at, Arrival::At::Opaque);
        EXPECT_NEAR(glm::distance(arrival.direction, dvec3(sine, -cosine, 0)), 0, 1e-14) << a;
        EXPECT_EQ(arrival.bends, 2);
        // Across the ray, and so on a floor parallel to the slab by 1 / cos. The box's sides are floats.
        const double aside = thick * sine * (1 - cosine / std::sqrt(n * n - sine * sine));
        const double straight = sine / cosine; // on the floor at -1, aimed at the origin
        EXPECT_NEAR(straight - arrival.hit.position.x, aside / cosine, 1e-6 * (1 + aside / cosine)) << a;
        const double kept = 1 - test::fresnel(a * kPi / 180, 1 / n);
        EXPECT_NEAR(arrival.weight.g, kept * kept, 1e-12) << a;
    }
}

TEST(LightPath, AFlatFieldOfGlassIsASlab) {
    const double thick = 0.05, n = 1.5;
    const Bench bench({test::glassRelief(64, 1.5f, [](double, double) { return 0.05; }),
                       matt(scene::Plane{{40, 40}}, {0, -0.1f, 0})});
    for (const double a : {0.0, 10.0, 30.0}) {
        const double sine = std::sin(a * kPi / 180), cosine = std::cos(a * kPi / 180);
        const Arrival arrival = bench.send({-0.1 * sine / cosine, 0.1, 0}, {sine, -cosine, 0});
        ASSERT_EQ(arrival.at, Arrival::At::Opaque);
        EXPECT_EQ(arrival.bends, 2);
        EXPECT_NEAR(glm::distance(arrival.direction, dvec3(sine, -cosine, 0)), 0, 1e-7) << a;
        const double aside = thick * sine * (1 - cosine / std::sqrt(n * n - sine * sine));
        EXPECT_NEAR(0.1 * sine / cosine - arrival.hit.position.x, aside / cosine, 1e-7) << a;
    }
}

TEST(LightPath, ALensOfHeightsFocusesWhereItsCurvatureSays) {
    // Light along the axis on the convex side of radius 0.5 m leaves a thickness of 0.05 m towards a point
    // R / (n - 1) - d / n behind the flat one. At a 40th of the radius the sphere's own error is below 1e-3.
    const double radius = 0.5, thick = 0.05, n = 1.5;
    const Bench bench({test::glassRelief(
        101, 1.5f, [&](double x, double y) { return thick - (x * x + y * y) / (2 * radius); })});
    for (const dvec2 at : {dvec2(0.0125, 0), dvec2(0, -0.0093), dvec2(0.0077, 0.0041)}) {
        const dvec3 out = bench.send({at.x, 1, at.y}, {0, -1, 0}).direction;
        const double slope = glm::dot(dvec2(out.x, out.z), glm::normalize(at)) / out.y; // to the axis
        const double high = thick - glm::dot(at, at) / (2 * radius);
        // Inside it goes to the axis by (n - 1) / n of the surface's slope, for the height of the glass.
        const double inside = glm::length(at) * (1 - (n - 1) / n * high / radius);
        EXPECT_NEAR(inside / slope, radius / (n - 1) - thick / n, 3e-3);
    }
}

TEST(LightPath, AbsorptionGoesByTheLengthInside) {
    scene::Object slab = glass(scene::Box{{20, 0.5f, 20}}, 1.5f);
    slab.material.clear().fresnel = false;
    slab.material.clear().absorption = scene::absorptionOf({0.25f, {0.5f, 0.25f, 1}});
    const dvec3 sigma(slab.material.clear().absorption);
    const Bench bench({slab});
    for (const double a : {0.0, 50.0}) {
        const double sine = std::sin(a * kPi / 180), cosine = std::cos(a * kPi / 180);
        const double length = 0.5 / std::sqrt(1 - sine * sine / 2.25);
        const Arrival arrival = bench.send({0, 1, 0}, {sine, -cosine, 0});
        // A half after each quarter of a metre, e^(-sigma l) with sigma = ln 2 / 0.25, to a float's digits.
        EXPECT_NEAR(arrival.weight.r, std::exp(-sigma.r * length), 1e-12);
        EXPECT_NEAR(arrival.weight.g, std::exp(-sigma.g * length), 1e-12);
        EXPECT_NEAR(arrival.weight.r, std::pow(0.5, length / 0.25), 1e-8);
        EXPECT_EQ(arrival.weight.b, 1);
        EXPECT_NEAR(arrival.absorbed.r, 1 - arrival.weight.r, 1e-12);
    }
}

TEST(LightPath, AnIndexOfOneShowsTheBackgroundExactly) {
    scene::Object torus = glass(scene::Torus{0.8f, 0.3f}, 1);
    torus.transform.rotate = {40, 10, 0};
    const Bench bench({glass(scene::Sphere{0.9f}, 1), torus});
    for (double x = -1; x < 1; x += 0.01) {
        const dvec3 direction = glm::normalize(dvec3(0.3 * x, 0.1, -1));
        const Arrival arrival = bench.send({x, 0.2 * x, 3}, direction);
        EXPECT_EQ(arrival.direction, glm::normalize(direction));
        EXPECT_EQ(arrival.weight, dvec3(1));
        EXPECT_EQ(arrival.at, Arrival::At::Sky);
    }
}

TEST(LightPath, ABallDeviatesByTwiceTheDifferenceOfTheAngles) {
    for (const float ior : {1.5f, 1.33f, 2.4f, 1.0001f}) {
        const double n = double(ior);
        const Bench bench({glass(scene::Sphere{2}, ior)});
        for (const double b : {0.0, 0.1, 0.5, 0.9, 0.999, 0.999999}) {
            const Arrival arrival = bench.send({2 * b, 5, 0}, {0, -1, 0});
            const double expected = 2 * (std::asin(b) - std::asin(b / n));
            // The angle of incidence near the rim is as sharp as b: 1e-16 of it is 1e-16 / cos.
            const double room = 1e-14 / std::sqrt(1 - b * b) + 1e-15;
            EXPECT_NEAR(angleBetween(arrival.direction, {0, -1, 0}), expected, 10 * room) << ior << " " << b;
            EXPECT_LE(arrival.direction.x, 0); // towards the axis
            EXPECT_EQ(arrival.bends, 2);
        }
    }
}

TEST(LightPath, ABallFocusesParaxialRaysBehindItself) {
    const Bench bench({glass(scene::Sphere{1}, 1.5f), matt(scene::Plane{{9, 9}}, {0, -1.5f, 0})});
    // n R / (2 (n - 1)) = 1.5 from the centre; the error falls with the cube of the offset.
    for (const double b : {1e-2, 1e-3}) {
        const Arrival arrival = bench.send({b, 5, 0}, {0, -1, 0});
        EXPECT_NEAR(arrival.hit.position.x, 0, 2 * b * b * b);
    }
}

TEST(LightPath, ABubbleSpreadsLightAndReflectsItsRimTotally) {
    const double n = 0.75;
    const Bench bench({glass(scene::Sphere{1}, 0.75f)});
    for (const double b : {0.3, 0.7, 0.749, 0.751, 0.9}) {
        const Arrival arrival = bench.send({b, 5, 0}, {0, -1, 0});
        const double expected = b < n ? 2 * (std::asin(b / n) - std::asin(b)) : kPi - 2 * std::asin(b);
        EXPECT_NEAR(angleBetween(arrival.direction, {0, -1, 0}), expected, 1e-12) << b;
        EXPECT_GT(arrival.direction.x, 0);
        EXPECT_EQ(arrival.weight.g < 1, b < n); // total reflection keeps everything
    }
}

TEST(LightPath, OfNestedBallsTheLaterOneInTheListCounts) {
    const scene::Object outer = glass(scene::Sphere{1}, 1.5f), inner = glass(scene::Sphere{0.5f}, 1.25f);
    const double n = 1.5, m = 1.25, r = 0.5;
    for (const double b : {0.1, 0.4, 0.6}) {
        // The inner ball is met at b / n from its centre.
        const double both =
            2 * (std::asin(b) - std::asin(b / n) + std::asin(b / (n * r)) - std::asin(b / (m * r)));
        const Arrival arrival = Bench({outer, inner}).send({b, 5, 0}, {0, -1, 0});
        EXPECT_NEAR(std::asin(-arrival.direction.x), both, 1e-12);
        EXPECT_EQ(arrival.bends, 4);
        const Arrival drowned = Bench({inner, outer}).send({b, 5, 0}, {0, -1, 0});
        EXPECT_NEAR(std::asin(-drowned.direction.x), 2 * (std::asin(b) - std::asin(b / n)), 1e-12);
        EXPECT_EQ(drowned.bends, 2);
        EXPECT_EQ(drowned.surfaces, 4);
    }
}

TEST(LightPath, LightIsTotallyReflectedBeyondTheCriticalAngleOnly) {
    // asin(1 / 1.5) = 41.8103 degrees.
    const Bench bench({glass(scene::Box{{2, 2, 2}}, 1.5f), matt(scene::Plane{{9, 9}}, {0, 3, 0}),
                       matt(scene::Plane{{9, 9}}, {0, -3, 0})});
    const auto send = [&](double a) {
        const double angle = a * kPi / 180;
        return bench.send({-0.5, 0, 0}, {std::sin(angle), std::cos(angle), 0});
    };
    const Arrival below = send(41.81), beyond = send(41.811);
    EXPECT_EQ(below.bends, 1);
    EXPECT_GT(degrees(std::asin(below.direction.x)), 89.5); // along the surface
    EXPECT_GT(beyond.bends, 1);
    EXPECT_NE(below.direction, beyond.direction);
    EXPECT_EQ(send(0).weight, dvec3(1 - 0.04));
}

TEST(LightPath, LightThatStaysInsideForEverIsGivenUp) {
    // At 45 degrees in a square of glass every reflection is total; the model follows eight.
    const Bench bench({glass(scene::Box{{2, 2, 2}}, 1.5f)});
    const Arrival arrival = bench.send({0.25, 0, 0}, {1, 1, 0});
    EXPECT_EQ(arrival.at, Arrival::At::Lost);
    EXPECT_EQ(arrival.surfaces, 9);
    EXPECT_EQ(arrival.weight, dvec3(1));
}

/// Twenty metres long, its refracting edge of `apex` degrees along z, its faces mirrored at the yz plane.
scene::Object prism(double apex) {
    const double half = std::tan(apex * kPi / 360);
    scene::Mesh mesh;
    for (const float z : {-10.f, 10.f})
        for (const vec3 corner : {vec3(0, 1, z), vec3(float(-half), 0, z), vec3(float(half), 0, z)})
            mesh.positions.push_back(corner);
    mesh.indices = {0, 2, 1, 3, 4, 5, 0, 1, 4, 0, 4, 3, 0, 5, 2, 0, 3, 5, 1, 2, 5, 1, 5, 4};
    scene::MeshShape shape;
    shape.flatNormals = true;
    shape.mesh = std::make_shared<scene::Mesh>(mesh);
    return glass(shape, 1.5f);
}

TEST(LightPath, APrismDeviatesLeastWhereTheRayIsSymmetric) {
    const double apex = 60, half = apex * kPi / 360;
    const double least = 2 * std::asin(1.5 * std::sin(half)) - 2 * half; // 37.18 degrees
    const Bench bench({prism(apex)});
    const auto deviation = [&](double incidence) { // on the left face, from below its normal
        const double angle = incidence - half;
        const dvec3 direction(std::cos(angle), std::sin(angle), 0);
        const dvec3 entry(-0.5 * std::tan(half), 0.5, 0);
        const Arrival arrival = bench.send(entry - direction, direction);
        EXPECT_EQ(arrival.bends, 2);
        return angleBetween(arrival.direction, direction);
    };
    const double symmetric = std::asin(1.5 * std::sin(half));
    EXPECT_NEAR(deviation(symmetric), least, 1e-7); // its corners are floats
    EXPECT_GT(deviation(symmetric - 0.05), least + 1e-4);
    EXPECT_GT(deviation(symmetric + 0.05), least + 1e-4);
}

TEST(LightPath, FacesThatLieOnEachOtherAreOneInterface) {
    const scene::Object lower = glass(scene::Box{{9, 1, 9}}, 1.5f, {0, -0.5f, 0}),
                        upper = glass(scene::Box{{9, 1, 9}}, 1.25f, {0, 0.5f, 0});
    const dvec3 direction = glm::normalize(dvec3(0.5, -1, 0.2));
    const double incident = std::acos(-direction.y), middle = std::asin(std::sin(incident) / 1.25);
    const double kept = (1 - test::fresnel(incident, 1 / 1.25)) * (1 - test::fresnel(middle, 1.25 / 1.5)) *
                        (1 - test::fresnel(std::asin(std::sin(incident) / 1.5), 1.5));
    for (const auto& objects : {std::vector{lower, upper}, std::vector{upper, lower}}) {
        const Arrival arrival = Bench(objects).send({0, 3, 0}, direction);
        EXPECT_EQ(arrival.bends, 3);
        EXPECT_NEAR(glm::distance(arrival.direction, direction), 0, 1e-14);
        EXPECT_NEAR(arrival.weight.g, kept, 1e-12);
    }
}

TEST(LightPath, ATorusIsEnteredAgain) {
    const Bench bench({glass(scene::Torus{1, 0.25f}, 1.5f)});
    const Arrival through = bench.send({-3, 0, 0}, {1, 0, 0});
    EXPECT_EQ(through.bends, 4);
    EXPECT_EQ(through.direction, dvec3(1, 0, 0));
    EXPECT_NEAR(through.weight.g, std::pow(0.96, 4), 1e-14);
    // In a plane through the axis its sections are two circles of radius 1/4 around -1 and 1, each of which
    // deviates as a ball does. A ray at 1/4 b from the first one's middle leaves it at that distance again,
    // turned by the deviation, and passes the other middle 2 sin(deviation) further down.
    for (const double b : {0.02, 0.1, -0.1}) {
        const auto deviation = [](double offset) {
            return 2 * (std::asin(offset) - std::asin(offset / 1.5));
        };
        const double first = deviation(b), second = deviation(b - 2 * std::sin(first) / 0.25);
        const Arrival arrival = bench.send({-3, 0.25 * b, 0}, {1, 0, 0});
        EXPECT_EQ(arrival.bends, 4);
        EXPECT_NEAR(std::asin(arrival.direction.y), -(first + second), 1e-12) << b;
    }
}

TEST(LightPath, AnOpenSurfaceIsLeftOnlyWhereItWasEntered) {
    const Bench bench({glass(scene::Plane{{9, 9}}, 1.5f)});
    const Arrival down = bench.send({0, 1, 0}, {1, -1, 0});
    EXPECT_NEAR(down.direction.x, std::sin(kPi / 4) / 1.5, 1e-12);
    EXPECT_EQ(down.at, Arrival::At::Sky);
    const dvec3 upwards = glm::normalize(dvec3(1, 1, 0));
    const Arrival up = bench.send({0, -1, 0}, upwards);
    EXPECT_EQ(up.direction, glm::normalize(upwards));
    EXPECT_EQ(up.bends, 0);
    EXPECT_EQ(up.surfaces, 1);
}

TEST(LightPath, MeshesBendLightAsTheirInterpolatedNormalsSay) {
    scene::MeshShape shape;
    shape.mesh = std::make_shared<scene::Mesh>(scene::meshOf(scene::Sphere{1}));
    scene::Object smooth = glass(shape, 1.5f);
    shape.flatNormals = true;
    const Bench exact({glass(scene::Sphere{1}, 1.5f)}), round({smooth}), flat({glass(shape, 1.5f)});
    double worst = 0, worstFlat = 0;
    for (double b = 0.05; b < 0.9; b += 0.0137) {
        const dvec3 origin(b, 0.3 * b, 5), direction(0, 0, -1);
        const dvec3 expected = exact.send(origin, direction).direction;
        worst = std::max(worst, degrees(angleBetween(round.send(origin, direction).direction, expected)));
        worstFlat =
            std::max(worstFlat, degrees(angleBetween(flat.send(origin, direction).direction, expected)));
    }
    // 256 segments: normals of triangles are off by up to 1.4 degrees / 2, interpolated ones by its square.
    EXPECT_LT(worst, 0.05);
    EXPECT_GT(worstFlat, 0.1);
    EXPECT_LT(worstFlat, 2);
}

TEST(LightPath, AnEyeInsideKnowsIt) {
    scene::MeshShape ball;
    ball.mesh = std::make_shared<scene::Mesh>(scene::meshOf(scene::Sphere{1}));
    const scene::Object torus = glass(scene::Torus{1, 0.25f}, 1.5f);
    scene::Water pool{.size = {2, 2}, .amplitude = 0.1f, .wavelength = 0.5f};
    const auto inside = [](const scene::Object& object, dvec3 place) {
        return Bench({object}).optics().mediaAt(place, true).medium() == 0;
    };
    for (const scene::Object& object : {glass(ball, 1.5f), glass(scene::Sphere{1}, 1.5f)}) {
        EXPECT_TRUE(inside(object, {0.6, 0.6, 0.5}));
        EXPECT_FALSE(inside(object, {0.6, 0.6, 0.6}));
    }
    EXPECT_TRUE(inside(torus, {1.1, 0, 0}));
    EXPECT_FALSE(inside(torus, {0.5, 0, 0}));
    EXPECT_TRUE(inside(glass(pool, 1.33f), {0, -0.5, 0}));
    EXPECT_FALSE(inside(glass(pool, 1.33f), {0, 0.5, 0}));
    EXPECT_FALSE(inside(glass(pool, 1.33f), {1.5, -0.5, 0}));
    // From the middle of a ball every ray leaves at a right angle.
    const Arrival out = Bench({glass(ball, 1.5f)}).send({0, 0, 0}, {1, 2, 3});
    EXPECT_NEAR(degrees(angleBetween(out.direction, glm::normalize(dvec3(1, 2, 3)))), 0, 0.02);
    EXPECT_EQ(out.bends, 1);
}

TEST(LightPath, ColoursPartAsTheAbbeNumberSays) {
    const scene::Clear flint{.ior = 1.6f, .dispersion = 0.6f}; // Abbe number 33.3
    const double n = double(1.6f);
    EXPECT_EQ(iorOf(flint, 1), n);
    EXPECT_NEAR(iorOf(flint, 2) - iorOf(flint, 0), (n - 1) * double(0.6f) / 20, 1e-15);
    EXPECT_GT(iorOf(flint, 2), n);
    EXPECT_LT(iorOf(flint, 0), n);
    scene::Object ball = glass(scene::Sphere{1}, 1.6f);
    ball.material.clear().dispersion = 0.6f;
    const Bench bench({ball});
    const auto deviation = [&](int channel) {
        return angleBetween(bench.send({0.5, 3, 0}, {0, -1, 0}, channel).direction, {0, -1, 0});
    };
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(deviation(channel), 2 * (std::asin(0.5) - std::asin(0.5 / iorOf(flint, channel))), 1e-12);
}

TEST(LightPath, AMirrorReflectsItsShareAndKeepsTheRest) {
    scene::Object wall = test::mirror(scene::Plane{{4, 4}});
    wall.material.mirror().reflectance = vec3(0.9f, 0.5f, 0.1f);
    const Arrival arrival = Bench({wall}).send({0, 1, 0}, {1, -1, 0});
    EXPECT_NEAR(glm::distance(arrival.direction, glm::normalize(dvec3(1, 1, 0))), 0, 1e-15);
    EXPECT_EQ(arrival.weight, dvec3(vec3(0.9f, 0.5f, 0.1f)));
    EXPECT_EQ(arrival.absorbed, 1.0 - dvec3(vec3(0.9f, 0.5f, 0.1f)));
}

} // namespace
} // namespace lucent::truth
