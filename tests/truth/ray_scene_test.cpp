#include "truth/RayScene.h"

#include "truth/Relief.h"
#include "truth/Torus.h"

#include "scene/Mesh.h"
#include "tests/truth/fields.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lucent::truth {
namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();

RayScene sceneOf(std::vector<Shape> shapes) {
    Result<RayScene> scene = RayScene::create(std::move(shapes));
    EXPECT_TRUE(scene.ok());
    return std::move(*scene);
}

dvec3 anyDirection(test::Random& random) {
    const double z = random.between(-1, 1), angle = random.between(0, 2 * std::numbers::pi);
    return dvec3(std::sqrt(1 - z * z) * dvec2(std::cos(angle), std::sin(angle)), z);
}

TEST(RayScene, MeetsASphereWhereItsEquationSays) {
    const Sphere sphere{{0.3, -0.2, 1.5}, 0.7};
    const RayScene scene = sceneOf({sphere});
    test::Random random(1);
    int hits = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const dvec3 origin = sphere.center + random.between(0, 3) * anyDirection(random);
        const dvec3 direction = anyDirection(random);
        // |origin + s direction - center|² = r²
        const dvec3 out = origin - sphere.center;
        const double b = glm::dot(out, direction), c = glm::dot(out, out) - sphere.radius * sphere.radius;
        const double root = b * b - c;
        double expected = kInfinity;
        for (const double s : {-b - std::sqrt(root), -b + std::sqrt(root)})
            if (root >= 0 && s > 0) expected = std::min(expected, s);
        const auto hit = scene.intersect({origin, direction});
        ASSERT_EQ(hit.has_value(), expected < kInfinity);
        EXPECT_EQ(scene.occluded({origin, direction}), hit.has_value());
        if (!hit) continue;
        ++hits;
        EXPECT_NEAR(hit->distance, expected, 1e-9); // the formula above, near its double root
        EXPECT_NEAR(glm::distance(hit->position, sphere.center), sphere.radius, 1e-12);
        EXPECT_NEAR(glm::dot(hit->normal, hit->position - sphere.center), sphere.radius, 1e-12);
    }
    EXPECT_GT(hits, 300);
}

TEST(RayScene, GrazingRaysKeepTheirDigits) {
    // At the height 1 - e over the middle of a unit sphere half the chord is sqrt(e (2 - e)).
    const RayScene scene = sceneOf({Sphere{{0, 0, 0}, 1}});
    for (const double e : {1e-3, 1e-6, 1e-9, 0x1p-40}) {
        const auto hit = scene.intersect({{-2, 0, 1 - e}, {1, 0, 0}});
        ASSERT_TRUE(hit) << e;
        EXPECT_NEAR(2 - hit->distance, std::sqrt(e * (2 - e)), 1e-12 + 1e-16 / std::sqrt(e));
        EXPECT_FALSE(scene.intersect({{-2, 0, 1 + e}, {1, 0, 0}})) << e;
    }
}

TEST(RayScene, SeesTheSameFromVeryFarAway) {
    const RayScene scene = sceneOf({Sphere{{0, 0, 0}, 1}, Torus{{4, 0, 0}, {0, 0, 1}, 1, 0.25}});
    for (const double far : {10.0, 1e6}) {
        EXPECT_NEAR(scene.intersect({{0.5, 0, far}, {0, 0, -1}})->position.z, std::sqrt(0.75), 1e-9);
        EXPECT_NEAR(scene.intersect({{5, 0, far}, {0, 0, -1}})->position.z, 0.25, 1e-9);
    }
}

TEST(Torus, IsMetWhereItsCirclesAre) {
    // Along x through the middle: -(R + r), -(R - r), R - r, R + r. Along z through the tube's middle: -r, r.
    const auto expect = [](const TorusHits& hits, std::vector<double> expected) {
        ASSERT_EQ(hits.count, int(expected.size()));
        for (int i = 0; i < hits.count; ++i)
            EXPECT_NEAR(hits.at[std::size_t(i)], expected[std::size_t(i)], 1e-14);
    };
    expect(torusHits({0, 0, 0}, {1, 0, 0}, 1, 0.25), {-1.25, -0.75, 0.75, 1.25});
    expect(torusHits({0, 1, 5}, {0, 0, -1}, 1, 0.25), {4.75, 5.25});
    expect(torusHits({0, 0, 5}, {0, 0, -1}, 1, 0.25), {});
    // At the height r/2 the tube's section is r sqrt(3)/2 wide.
    const double w = 0.25 * std::sqrt(3) / 2;
    expect(torusHits({0, 0, 0.125}, {1, 0, 0}, 1, 0.25), {-1 - w, -1 + w, 1 - w, 1 + w});
}

TEST(Torus, IsGrazedAtItsOuterCircleAndItsTop) {
    // A line at y = R + r - e beside the axis, in the plane z = 0, meets the outer circle only:
    // half the chord is sqrt(e (2 (R + r) - e)). Where e is small the quartic's own digits end: e loses 1e-16
    // of it.
    for (const double e : {1e-2, 1e-5, 1e-8}) {
        const TorusHits hits = torusHits({-3, 1.25 - e, 0}, {1, 0, 0}, 1, 0.25);
        ASSERT_EQ(hits.count, 2) << e;
        const double half = std::sqrt(e * (2.5 - e));
        EXPECT_NEAR(hits.at[0], 3 - half, 1e-14 / half) << e;
        EXPECT_NEAR(hits.at[1], 3 + half, 1e-14 / half) << e;
        EXPECT_EQ(torusHits({-3, 1.25 + e, 0}, {1, 0, 0}, 1, 0.25).count, 0) << e;
        // Over the top, across the tube: four meetings, in pairs around -1 and 1.
        const TorusHits top = torusHits({0, 0, 0.25 - e}, {1, 0, 0}, 1, 0.25);
        const double width = std::sqrt(e * (0.5 - e));
        ASSERT_EQ(top.count, 4) << e;
        EXPECT_NEAR(top.at[3], 1 + width, 1e-14 / width) << e;
        EXPECT_NEAR(top.at[2], 1 - width, 1e-14 / width) << e;
        EXPECT_EQ(torusHits({0, 0, 0.25 + e}, {1, 0, 0}, 1, 0.25).count, 0) << e;
    }
}

TEST(Torus, IsMetWhereverTheDistanceChangesItsSign) {
    test::Random random(4);
    int found = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const double major = 1, minor = random.between(0.01, 1);
        const dvec3 origin = random.between(0, 4) * anyDirection(random), direction = anyDirection(random);
        const auto distance = [&](double s) {
            const dvec3 p = origin + s * direction;
            return std::hypot(std::hypot(p.x, p.y) - major, p.z) - minor;
        };
        const TorusHits hits = torusHits(origin, direction, major, minor);
        for (int i = 0; i < hits.count; ++i)
            EXPECT_NEAR(distance(hits.at[std::size_t(i)]), 0, 1e-12);
        constexpr double kStep = 1e-3;
        for (double s = -8; s < 8; s += kStep) {
            if ((distance(s) < 0) == (distance(s + kStep) < 0)) continue;
            const bool known = std::any_of(hits.at.begin(), hits.at.begin() + hits.count, [&](double at) {
                return at >= s - 1e-9 && at <= s + kStep + 1e-9;
            });
            EXPECT_TRUE(known) << "trial " << trial << " at " << s;
            ++found;
        }
    }
    EXPECT_GT(found, 100);
}

TEST(RayScene, MeetsATiltedTorusFromOutsideAndInside) {
    const dvec3 axis = glm::normalize(dvec3(1, 2, 3));
    const dvec3 across = glm::normalize(glm::cross(axis, dvec3(1, 0, 0)));
    const dvec3 center(0.5, -1, 2);
    const RayScene scene = sceneOf({Torus{center, axis, 2, 0.5}});
    const auto outside = scene.intersect({center + 5.0 * across, -across});
    ASSERT_TRUE(outside);
    EXPECT_NEAR(outside->distance, 2.5, 1e-12);
    EXPECT_NEAR(glm::dot(outside->normal, across), 1, 1e-12);
    const auto inside = scene.intersect({center + 2.0 * across, axis});
    ASSERT_TRUE(inside);
    EXPECT_NEAR(inside->distance, 0.5, 1e-12);
    EXPECT_FALSE(scene.intersect({center, axis}));
    EXPECT_FALSE(scene.occluded({center + 5.0 * across, -across, 2.4}));
    EXPECT_TRUE(scene.occluded({center + 5.0 * across, -across, 2.6}));
}

TEST(RayScene, AFieldIsMetWhereItsOwnCutSays) {
    const auto shape = test::shapeOf(17, 11, 1, 0.3f, test::noise(8));
    const auto field = std::make_shared<Field>(shape);
    scene::Transform transform;
    transform.rotate = {30, 40, 50};
    transform.translate = {1, 2, 3};
    transform.scale = 2.5f;
    const Placement placement(transform);
    const RayScene scene = sceneOf({FieldBlock{field, placement}});
    test::Random random(2);
    int hits = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        const dvec3 from{random.between(-1, 1), random.between(-1, 1), random.between(-0.2, 1)};
        const dvec3 target{random.between(-0.5, 0.5), random.between(-0.3, 0.3), random.between(0, 0.3)};
        const WorldRay ray{placement.pointInWorld(from),
                           glm::normalize(placement.directionInWorld(target - from))};
        const auto own = firstHit(*field, {from, dvec3(0), glm::normalize(target - from)}, {0, kInfinity});
        const auto hit = scene.intersect(ray);
        ASSERT_EQ(hit.has_value(), own.has_value()) << trial;
        if (!hit) continue;
        ++hits;
        EXPECT_NEAR(glm::distance(placement.pointFromWorld(hit->position), own->position), 0, 1e-9);
        EXPECT_NEAR(glm::dot(placement.directionFromWorld(hit->normal), own->normal), 1, 1e-9);
        EXPECT_TRUE(scene.occluded(ray));
        EXPECT_FALSE(scene.occluded({ray.origin, ray.direction, hit->distance * (1 - 1e-9)}));
    }
    EXPECT_GT(hits, 1000);
}

TEST(RayScene, AFieldIsABlockThatEndsAtItsBottom) {
    // 1 m wide, from z = 0 to 0.2; and a sheet without thickness at z = 0.
    for (const float height : {1.f, 0.f}) {
        const auto field =
            std::make_shared<Field>(test::shapeOf(4, 4, 1, 0.2f, [=](int, int) { return height; }));
        const RayScene scene = sceneOf({FieldBlock{field, {}}});
        EXPECT_TRUE(scene.occluded({{0.1, 0.1, 1}, {0, 0, -1}}));
        EXPECT_TRUE(scene.occluded({{0.1, 0.1, -1}, {0, 0, 1}}));
        EXPECT_FALSE(scene.occluded({{-1, 0.1, -0.1}, {1, 0, 0}}));
        EXPECT_EQ(scene.occluded({{-1, 0.1, 0.1}, {1, 0, 0}}), height > 0);
        EXPECT_TRUE(scene.occluded({{-1, 0.1, -0.5}, glm::normalize(dvec3(1, 0, 0.5))}));
        EXPECT_FALSE(scene.occluded({{-1, 0.1, -0.5}, glm::normalize(dvec3(1, 0, 0.2))}));
    }
}

TEST(RayScene, ATriangleIsMetInItsPlane) {
    Triangles mesh;
    mesh.positions = {{0, 0, 1}, {1, 0, 2}, {0, 1, 3}};
    mesh.indices = {0, 1, 2};
    const RayScene scene = sceneOf({mesh});
    // The plane z = 1 + x + 2 y.
    const auto hit = scene.intersect({{0.3, 0.4, 10}, {0, 0, -1}});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->position.z, 2.1, 1e-14);
    EXPECT_NEAR(glm::distance(hit->normal, glm::normalize(dvec3(-1, -2, 1))), 0, 1e-14);
    EXPECT_FALSE(scene.occluded({{0.6, 0.6, 10}, {0, 0, -1}}));
    EXPECT_FALSE(scene.occluded({{0.3, 0.4, 10}, {0, 0, -1}, 7.8}));
    EXPECT_TRUE(scene.occluded({{0.3, 0.4, 10}, {0, 0, -1}, 8}));
}

TEST(RayScene, OfManyShapesTheNearestIsMetAndTheOneLeftIsNot) {
    Triangles floor;
    floor.positions = {{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}};
    floor.indices = {0, 1, 2};
    const RayScene scene = sceneOf({floor, Sphere{{0, 0, 1}, 0.5}, Torus{{0, 0, 3}, {1, 0, 0}, 1, 0.25}});
    const WorldRay down{{0, 0, 10}, {0, 0, -1}};
    EXPECT_EQ(scene.intersect(down)->shape, 2);
    EXPECT_EQ(scene.intersect(down)->distance, 5.75);
    EXPECT_EQ(scene.intersect(down, {2, 100})->shape, 1);
    EXPECT_EQ(scene.intersect({{3, 0, 10}, {0, 0, -1}})->shape, 0);
    EXPECT_FALSE(scene.intersect({{3, 0, 10}, {0, 0, 1}}));
    // From the sphere's own surface: with the way out left alone nothing is met, inwards its other side.
    EXPECT_FALSE(scene.occluded({{0.5, 0, 1}, {1, 0, 0}}, {1, 1e-9}));
    EXPECT_NEAR(scene.intersect({{0.5, 0, 1}, {-1, 0, 0}}, {1, 1e-9})->distance, 1, 1e-12);
    EXPECT_FALSE(scene.occluded({{3, 0, 0}, {0, 0, 1}}, {0, 1e-9}));
}

TEST(RayScene, BoxesFindWhatEmbreeFinds) {
    // Everything at once, balls in balls and triangles among them, a hidden one too.
    test::Random random(7);
    std::vector<Shape> shapes{Sphere{{0, 0, 0}, 1}, Sphere{{0.1, 0, 0}, 0.5},
                              Torus{{0.5, 0, 0}, {0, 0, 1}, 1, 0.25}};
    Triangles soup;
    for (std::uint32_t i = 0; i < 3 * 400; ++i) {
        const dvec3 middle = i % 3 == 0 ? 2.0 * anyDirection(random) : soup.positions[i - i % 3];
        soup.positions.push_back(middle + random.between(0, 0.5) * anyDirection(random));
        soup.indices.push_back(i);
    }
    shapes.push_back(soup);
    const std::vector<bool> hidden{false, true, false, false};
    const RayScene embree = std::move(*RayScene::create(shapes, hidden, RayScene::By::Embree));
    const RayScene boxes = std::move(*RayScene::create(shapes, hidden, RayScene::By::Boxes));
    int hits = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        WorldRay ray{3.0 * anyDirection(random), anyDirection(random)};
        ray.direction = glm::normalize(random.between(0, 2) * anyDirection(random) - ray.origin);
        ray.hitsHidden = trial % 2 == 0;
        if (trial % 3 == 0) ray.length = random.between(0, 6);
        if (trial % 5 == 0) ray.begin = -kInfinity;
        const Hits expected = embree.coincidentHits(ray), found = boxes.coincidentHits(ray);
        ASSERT_EQ(found.count, expected.count) << trial;
        EXPECT_EQ(boxes.occluded(ray), embree.occluded(ray)) << trial;
        for (int i = 0; i < found.count; ++i) {
            EXPECT_EQ(found.at[std::size_t(i)].shape, expected.at[std::size_t(i)].shape) << trial;
            EXPECT_EQ(found.at[std::size_t(i)].distance, expected.at[std::size_t(i)].distance) << trial;
        }
        hits += found.count;
        const auto near = embree.nearest(ray.origin), nearest = boxes.nearest(ray.origin);
        ASSERT_TRUE(near && nearest);
        EXPECT_EQ(nearest->triangle, near->triangle) << trial;
    }
    EXPECT_GT(hits, 2000);
}

TEST(RayScene, ATreeOfBoxesLetsNoRayThroughAnEdge) {
    // A ball of 2048 triangles around the origin; every fourth ray is aimed at a corner or along an edge.
    const scene::Mesh ball = scene::meshOf(scene::Sphere{1}, 45);
    Triangles triangles;
    for (const vec3& place : ball.positions)
        triangles.positions.emplace_back(place);
    triangles.indices = ball.indices;
    const RayScene boxes = std::move(*RayScene::create({triangles}, {}, RayScene::By::Boxes));
    test::Random random(8);
    for (std::size_t trial = 0; trial < 4000; ++trial) {
        const std::size_t first = trial % triangles.indices.size() / 3 * 3;
        const dvec3 a = triangles.positions[triangles.indices[first]],
                    b = triangles.positions[triangles.indices[first + 1]];
        const dvec3 target = trial % 4 == 0   ? a
                             : trial % 4 == 1 ? glm::mix(a, b, random.between(0, 1))
                                              : anyDirection(random);
        EXPECT_TRUE(boxes.intersect({dvec3(0), glm::normalize(target)})) << trial;
    }
}

TEST(RayScene, AnEmptySceneIsInNobodysWay) {
    const RayScene scene = sceneOf({});
    EXPECT_FALSE(scene.intersect({{0, 0, 0}, {0, 0, 1}}));
    EXPECT_FALSE(scene.occluded({{0, 0, 0}, {0, 0, 1}}));
}

} // namespace
} // namespace lucent::truth
