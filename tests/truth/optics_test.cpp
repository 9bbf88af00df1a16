#include "truth/Optics.h"

#include "tests/truth/scenes.h"

namespace lucent::truth {
namespace {
using test::glass;
constexpr double kPi = std::numbers::pi;

scene::Object meshObject(scene::Mesh mesh) {
    scene::MeshShape shape;
    shape.mesh = std::make_shared<scene::Mesh>(std::move(mesh));
    return glass(shape, 1.5f);
}

scene::Mesh triangle() {
    scene::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}};
    mesh.indices = {0, 1, 2};
    return mesh;
}

TEST(Optics, PlacesWhatIsRoundExactly) {
    scene::Object ball = glass(scene::Sphere{0.5f}, 1.5f, {1, 2, 3});
    ball.transform.scale = 4;
    ball.transform.rotate = {10, 20, 30};
    const auto sphere = std::get<Sphere>(surfaceOf(ball, 0));
    EXPECT_EQ(sphere.center, dvec3(1, 2, 3));
    EXPECT_EQ(sphere.radius, 2);
    scene::Object ring = glass(scene::Torus{0.75f, 0.25f}, 1.5f);
    ring.transform.rotate = {90, 0, 0}; // y becomes z
    const auto torus = std::get<Torus>(surfaceOf(ring, 0));
    EXPECT_NEAR(glm::distance(torus.axis, dvec3(0, 0, 1)), 0, 1e-15);
    ball.wave.amplitude = {0, 0.1f, 0};
    EXPECT_TRUE(std::holds_alternative<Triangles>(surfaceOf(ball, 0))); // no ball any more
}

TEST(Optics, AWaveMovesPointsAndTurnsNormalsAsItsDerivative) {
    scene::Object sheet = glass(scene::Plane{{2, 2}}, 1.5f);
    sheet.wave = {.amplitude = {0, 0.1f, 0}, .direction = {3, 0, 0}, .wavelength = 0.5f, .period = 2};
    const double time = 0.3, k = 2 * kPi / 0.5;
    const auto triangles = std::get<Triangles>(surfaceOf(sheet, time));
    EXPECT_GT(triangles.positions.size(), 1000u);
    for (std::size_t i = 0; i < triangles.positions.size(); i += 7) {
        const dvec3 place = triangles.positions[i];
        const double angle = k * place.x - kPi * time; // x is not moved
        EXPECT_NEAR(place.y, double(0.1f) * std::sin(angle), 1e-12);
        const dvec3 normal = glm::normalize(dvec3(-double(0.1f) * k * std::cos(angle), 1, 0));
        EXPECT_NEAR(glm::distance(triangles.normals[i], normal), 0, 1e-12);
    }
}

TEST(Optics, AWaveAlongItselfKeepsThePlane) {
    // Points move within the plane: its normal stays, although the derivative is no rotation.
    scene::Object sheet = glass(scene::Plane{{2, 2}}, 1.5f);
    sheet.wave = {.amplitude = {0.1f, 0, 0.05f}, .direction = {1, 0, 0}, .wavelength = 1, .period = 1};
    const auto triangles = std::get<Triangles>(surfaceOf(sheet, 0.2));
    for (const dvec3& normal : triangles.normals)
        EXPECT_NEAR(glm::distance(normal, dvec3(0, 1, 0)), 0, 1e-14);
}

TEST(Optics, JointsAndMorphTargetsMoveAMesh) {
    scene::Mesh mesh = triangle();
    mesh.rig.targets.push_back({{{0, 1, 0}, {0, 1, 0}, {0, 1, 0}}, {}});
    mesh.rig.weights = {0.25f};
    mesh.joints.assign(3, {0, 1, 0, 0});
    mesh.jointWeights.assign(3, vec4(0.5f, 0.5f, 0, 0));
    mesh.rig.nodes = {{.translate = {2, 0, 0}}, {.translate = {0, 0, 4}}};
    mesh.rig.joints = {0, 1};
    mesh.rig.jointFromMesh = {mat4(1), mat4(1)};
    const auto moved = std::get<Triangles>(surfaceOf(meshObject(mesh), 0));
    // A quarter up, then half of both ways.
    EXPECT_EQ(moved.positions[1], dvec3(1 + 1, 0.25, 2));
    EXPECT_EQ(moved.normals[1], dvec3(0, 1, 0));
}

TEST(Optics, AJointThatStretchesTurnsNormalsByItsInverse) {
    scene::Mesh mesh = triangle();
    for (vec3& position : mesh.positions)
        position.y = position.x; // normal (-1, 1, 0)
    mesh.joints.assign(3, {0, 0, 0, 0});
    mesh.jointWeights.assign(3, vec4(1, 0, 0, 0));
    mesh.rig.nodes = {{.scale = {1, 3, 1}}};
    mesh.rig.joints = {0};
    mesh.rig.jointFromMesh = {mat4(1)};
    const auto moved = std::get<Triangles>(surfaceOf(meshObject(mesh), 0));
    EXPECT_NEAR(glm::distance(moved.normals[0], glm::normalize(dvec3(-3, 1, 0))), 0, 1e-7);
}

TEST(Optics, WaterIsMetWhereItsHeightIs) {
    scene::Water water{.size = {4, 4}, .amplitude = 0.1f, .wavelength = 0.5f, .direction = {1, 1}};
    for (const float amplitude : {0.f, 0.1f}) {
        water.amplitude = amplitude;
        const auto ripple = std::get<Ripple>(surfaceOf(glass(water, 1.33f), 0));
        Result<RayScene> rays = RayScene::create({ripple});
        ASSERT_TRUE(rays.ok());
        const auto above = [&](const dvec3& place) {
            return place.y - ripple.amplitude * std::sin(glm::dot(ripple.wave, dvec2(place.x, place.z)));
        };
        for (double tilt = 0; tilt < 20; tilt += 0.37) {
            const dvec3 direction = glm::normalize(dvec3(tilt, -1, 0.3 * tilt));
            const dvec3 origin = dvec3(-0.2, 0, 0.1) - direction;
            const auto hit = rays->intersect({origin, direction});
            ASSERT_TRUE(hit) << tilt;
            EXPECT_NEAR(above(hit->position), 0, 1e-13);
            EXPECT_EQ(rays->intersect({origin, direction, hit->distance - 1e-9}).has_value(), false);
            // Nothing before: a thousand samples on the way have one sign.
            for (double s = 0; s < 1; s += 1e-3)
                EXPECT_GE(above(origin + s * hit->distance * direction) * above(origin), 0);
        }
    }
    const auto waves = std::get<Ripple>(surfaceOf(glass(water, 1.33f), 0));
    Result<RayScene> rays = RayScene::create({waves});
    // A level ray below the crests meets one flank after the other.
    int count = 0;
    WorldRay ray{{-5, 0.05, 0}, {1, 0, 0}};
    for (std::optional<Hit> hit; (hit = rays->intersect(ray)); ++count)
        ray.begin = hit->distance + 1e-9;
    // Eight metres of wavelength 0.5 sqrt 2 along x hold 5.66 waves, each met twice.
    EXPECT_NEAR(count, 11, 1);
}

TEST(Optics, MovedWaterIsMetWhereItsHeightIs) {
    // As above, turned and scaled, after 1.3 s with a drop: no formula, but heights.
    const scene::Water water{.size = {1, 0.7f}, .amplitude = 0.01f, .dropInterval = 0.9f};
    scene::Object object = glass(water, 1.33f, {0.3f, 0.2f, -0.1f});
    object.transform.rotate = {20, 30, 10};
    object.transform.scale = 2;
    const auto waves = std::get<Waves>(surfaceOf(object, 1.3));
    Result<RayScene> rays = RayScene::create({waves});
    ASSERT_TRUE(rays.ok());
    const auto above = [&](const dvec3& place) {
        const dvec3 local = waves.placement.pointFromWorld(place);
        return local.y - waves.basin->at({local.x, local.z}).height;
    };
    const dvec3 middle = waves.placement.pointInWorld({0.07, 0, 0.02});
    for (double tilt = 0; tilt < 20; tilt += 0.37) {
        const dvec3 direction = waves.placement.directionInWorld(glm::normalize(dvec3(tilt, -1, 0.3 * tilt)));
        const dvec3 origin = middle - direction;
        const auto hit = rays->intersect({origin, direction});
        ASSERT_TRUE(hit) << tilt;
        EXPECT_NEAR(above(hit->position), 0, 1e-13);
        for (double s = 0; s < 1; s += 1e-3)
            EXPECT_GE(above(origin + s * hit->distance * direction), 0) << tilt;
        // The normal is across both directions in which the surface runs on.
        const dvec3 local = waves.placement.pointFromWorld(hit->position);
        const double d = 1e-6;
        for (const dvec2 aside : {dvec2(d, 0), dvec2(0, d)}) {
            const dvec2 at = dvec2(local.x, local.z) + aside;
            const dvec3 next = waves.placement.pointInWorld({at.x, waves.basin->at(at).height, at.y});
            EXPECT_NEAR(glm::dot(glm::normalize(next - hit->position), hit->normal), 0, 1e-5);
        }
    }
}

TEST(Optics, WaterTooFarAheadIsRefused) {
    scene::Scene scene = test::sceneOf({glass(scene::Water{.amplitude = 0.01f}, 1.33f)});
    scene.objects[0].name = "pool";
    scene.view.time = 1e6f;
    const auto optics = Optics::create(scene);
    ASSERT_FALSE(optics.ok());
    EXPECT_EQ(optics.error().message, "view.time: is 1000000, to which the waves of objects.pool take "
                                      "1.96608e+12 steps of cells; must take at most 1e+10");
}

TEST(Optics, WhatTheEyeDoesNotSeeIsMetByLightAlone) {
    scene::Object hidden = glass(scene::Sphere{1}, 1.5f);
    hidden.visible = false;
    const test::Bench bench({hidden});
    WorldRay ray{{0, 3, 0}, {0, -1, 0}};
    EXPECT_TRUE(bench.optics().rays().intersect(ray));
    EXPECT_TRUE(bench.optics().rays().occluded(ray));
    ray.hitsHidden = false;
    EXPECT_FALSE(bench.optics().rays().intersect(ray));
    EXPECT_FALSE(bench.optics().rays().occluded(ray));
}

TEST(Optics, LayersCloserThanFloatsCanTellAreAllMet) {
    // Ten sheets a micrometre apart, in a box of a metre.
    std::vector<scene::Object> objects;
    for (int i = 0; i < 10; ++i)
        objects.push_back(glass(scene::Plane{{1, 1}}, 1.5f, {0, 1e-6f * float(i), 0}));
    const test::Bench bench(objects);
    WorldRay ray{{0.1, 3, 0.2}, {0, -1, 0}};
    int count = 0;
    for (std::optional<Hit> hit; (hit = bench.optics().rays().intersect(ray)); ++count) {
        EXPECT_EQ(hit->shape, 9 - count);
        ray.origin = hit->position;
        ray.begin = 1e-9;
    }
    EXPECT_EQ(count, 10);
}

} // namespace
} // namespace lucent::truth
