#include "viewer/Interaction.h"

#include <gtest/gtest.h>

#include <numbers>

namespace lucent::viewer {
namespace {

using scene::Camera;

void expectNear(vec3 a, vec3 b, float tolerance) {
    EXPECT_LT(glm::distance(a, b), tolerance) << a.x << " " << a.y << " " << a.z;
}

Camera perspective() {
    Camera camera;
    camera.type = Camera::Type::Perspective;
    camera.fov = 90;
    return camera; // at (0, 0, 2), looking along -z
}

TEST(Lens, AnOrthographicCameraShowsItsHeightFromTopToBottom) {
    Camera camera;
    camera.height = 2;
    const Lens lens(camera, {400, 200}); // 0.01 m a pixel
    EXPECT_EQ(*lens.project({0, 0, 0}), vec2(200, 100));
    EXPECT_LT(glm::distance(*lens.project({0.5f, 1, -7}), vec2(250, 0)), 1e-3f);
}

TEST(Lens, APerspectiveCameraSeesTheEdgeOfItsAngleAtTheEdge) {
    const Lens lens(perspective(), {200, 200});
    // 90 degrees: at depth 2 the view is 4 m high, so y = 2 is at the top; at depth 1, y = 1.
    EXPECT_LT(glm::distance(*lens.project({0, 2, 0}), vec2(100, 0)), 1e-3f);
    EXPECT_LT(glm::distance(*lens.project({0, 1, 1}), vec2(100, 0)), 1e-3f);
    EXPECT_FALSE(lens.project({0, 0, 3}).has_value()); // behind
}

TEST(Lens, OnPlaneIsTheInverseOfProject) {
    Camera camera = perspective();
    camera.eye = {0.7f, -0.4f, 1.5f};
    const Lens lens(camera, {300, 200});
    const vec3 point(0.2f, 0.1f, 0.3f);
    for (const vec3 normal : {vec3(0, 0, 1), lens.forward()}) {
        const auto back = lens.onPlane(*lens.project(point), point, normal);
        ASSERT_TRUE(back.has_value());
        expectNear(*back, point, 1e-5f);
    }
}

TEST(Lens, APlaneSeenFromItsEdgeHasNoPlaceForThePointer) {
    Camera camera;
    camera.eye = {0, -2, 0};
    camera.up = {0, 0, 1};
    EXPECT_FALSE(Lens(camera, {100, 100}).onPlane({50, 50}, {0, 0, 0.5f}, {0, 0, 1}).has_value());
}

constexpr vec2 kView(400, 300);

TEST(LightHandle, ALightInThePictureIsGrippedWhereItIsSeen) {
    const scene::PointLight light{.position = {0.5f, 0, 0}};
    const LightHandle handle = handleOf(light, Lens(perspective(), kView), kView);
    EXPECT_FALSE(handle.towards);
    EXPECT_LT(glm::distance(handle.place, vec2(200 + 0.5f * 75, 150)),
              1e-3f); // 4 m high at depth 2: 75 a metre
}

TEST(LightHandle, ALightOutsideOrBehindHasAnArrowAtTheBorderTowardsIt) {
    const Lens lens(perspective(), kView);
    for (const auto& [position, towards] : {std::pair(vec3(9, 0, 0), vec2(1, 0)),
                                            {vec3(-9, 0, 0), vec2(-1, 0)},
                                            {vec3(0, 9, 0), vec2(0, -1)},
                                            {vec3(0, -9, 0), vec2(0, 1)},
                                            {vec3(3, 0, 5), vec2(1, 0)},
                                            {vec3(0, -1, 5), vec2(0, 1)},
                                            {vec3(0, 0, 5), vec2(0, -1)}}) {
        const LightHandle handle = handleOf(scene::PointLight{.position = position}, lens, kView);
        ASSERT_TRUE(handle.towards) << position.x << " " << position.y << " " << position.z;
        EXPECT_GT(glm::dot(*handle.towards, towards), 0.99f);
        EXPECT_TRUE(glm::all(glm::greaterThan(handle.place, vec2(20))));
        EXPECT_TRUE(glm::all(glm::lessThan(handle.place, kView - 20.0f)));
        const vec2 way = handle.place - kView / 2.0f;
        EXPECT_GT(glm::dot(way, towards), 80); // near the border on that side
    }
}

TEST(LightHandle, ADistantLightStandsOnADiscAsItShines) {
    const Lens lens(perspective(), kView);
    const auto placeOfDirection = [&](vec3 direction) {
        const LightHandle handle = handleOf(scene::DistantLight{.direction = direction}, lens, kView);
        EXPECT_FALSE(handle.towards);
        return handle.place - kView / 2.0f;
    };
    EXPECT_LT(glm::length(placeOfDirection({0, 0, -2})), 1e-3f); // along the line of sight
    EXPECT_GT(placeOfDirection({0, -1, 0}).y, -0.5f * kView.y);
    EXPECT_LT(placeOfDirection({0, -1, 0}).y, -80);                            // from above
    EXPECT_NEAR(placeOfDirection({-1, 0, 0}).x, 300 / std::numbers::pi, 1e-3); // from the right, at the rim
}

TEST(MovedLight, OneBehindTheCameraMovesParallelToThePicture) {
    const Lens lens(perspective(), {200, 200});
    // At 3 m from the eye the view is 6 m high: 0.03 m a pixel.
    expectNear(movedLight(lens, {1, 0, 5}, {0, 0, 1}, {100, 100}, {110, 80}), {1.3f, 0.6f, 5}, 1e-4f);
}

TEST(Framed, ANarrowViewShowsTheWholeWidthOfTheScene) {
    Camera camera;
    camera.height = 1;
    // A square scene in a view half as wide as high: the height must double for the width to fit.
    EXPECT_FLOAT_EQ(framed(camera, {512, 512}, {100, 200}).height, 2);
    EXPECT_FLOAT_EQ(framed(camera, {512, 512}, {300, 200}).height, 1);
    // tan(45 degrees) doubles: 2 atan(2) = 126.87 degrees.
    EXPECT_NEAR(framed(perspective(), {512, 512}, {100, 200}).fov, 126.8699f, 1e-3f);
}

TEST(MovedLight, TheLightStaysUnderThePointerAtItsHeight) {
    const Lens lens(perspective(), {200, 200});
    const vec3 light(0.1f, 0.2f, 0.5f);
    const vec2 from = *lens.project(light), to = from + vec2(20, -10);
    const vec3 moved = movedLight(lens, light, {0, 0, 1}, from, to);
    EXPECT_NEAR(moved.z, light.z, 1e-6f);
    EXPECT_LT(glm::distance(*lens.project(moved), to), 1e-3f);
}

TEST(MovedLight, OverAFloorItStaysUnderThePointerAtItsDistanceFromThePicture) {
    Camera camera = perspective();
    camera.eye = {0, 3, 0.01f}; // from above: along z no plane can be hit
    const Lens lens(camera, {200, 200});
    const vec3 light(0.1f, 1, 0.02f);
    const vec2 from = *lens.project(light), to = from + vec2(20, -10);
    EXPECT_EQ(movedLight(lens, light, {0, 0, 1}, from, to), light);
    const vec3 moved = movedLight(lens, light, lens.forward(), from, to);
    EXPECT_LT(glm::distance(*lens.project(moved), to), 1e-3f);
    EXPECT_NEAR(glm::dot(moved - light, lens.forward()), 0, 1e-6f);
}

TEST(PlaceOf, ASpotStandsSomewhereAnAreaLightBeginsAtItsCornerADistantLightIsNowhere) {
    EXPECT_EQ(*placeOf(scene::SpotLight{.position = {1, 2, 3}}), vec3(1, 2, 3));
    EXPECT_EQ(*placeOf(scene::AreaLight{.corner = {4, 5, 6}}), vec3(4, 5, 6));
    EXPECT_EQ(placeOf(scene::DistantLight{}), nullptr);
    EXPECT_EQ(colorOf(scene::SpotLight{.color = {0.1f, 0.2f, 0.3f}}), vec3(0.1f, 0.2f, 0.3f));
}

TEST(TurnedLight, TheSourceGoesWithThePointer) {
    Camera camera;
    // Light from the camera; a quarter turn to the right brings its source to +x, one down to -y.
    expectNear(turnedLight(camera, {0, 0, -1}, {0.5f, 0}), {-1, 0, 0}, 1e-6f);
    expectNear(turnedLight(camera, {0, 0, -1}, {0, 0.5f}), {0, 1, 0}, 1e-6f);
}

TEST(TurnedMap, SidewaysTurnsAboutYUpAndDownAboutXAndRollAboutZ) {
    expectNear(turnedMap({10, 20, 30}, {0.5f, 0.25f}, false), {55, 110, 30}, 1e-4f);
    expectNear(turnedMap({10, 20, 30}, {0.5f, 0.25f}, true), {10, 20, -60}, 1e-4f);
    expectNear(turnedMap({0, 170, 0}, {0.125f, 0}, false), {0, 170 + 22.5f - 360, 0}, 1e-4f);
}

TEST(Orbited, GoesAroundTheTargetAndStopsBeforeThePole) {
    Camera camera;
    camera.target = {0.5f, 0, 0};
    camera.eye = {0.5f, 0, 2};
    expectNear(orbited(camera, {0.5f, 0}), {-1.5f, 0, 0}, 1e-5f); // the object is turned to the right
    const vec3 top = orbited(camera, {0, 3});
    // One degree from straight above: 2 cos 1 = 1.9997 up, 2 sin 1 = 0.0349 aside.
    expectNear(top, {0.5f, 1.99970f, 0.03490f}, 1e-4f);
    EXPECT_NEAR(glm::distance(orbited(camera, {0.3f, 0.2f}), camera.target), 2, 1e-5f);
}

TEST(Zoomed, ShowsLessOfTheSceneAtTwiceTheSize) {
    Camera camera;
    camera.height = 3;
    EXPECT_FLOAT_EQ(zoomed(camera, 2).height, 1.5f);
    expectNear(zoomed(perspective(), 2).eye, {0, 0, 1}, 1e-6f);
}

TEST(WaterAt, APixelShowsAPlaceOfTheNearestSheet) {
    scene::Scene scene;
    scene.camera.eye = {0, 2, 0};
    scene.camera.up = {0, 0, -1};
    scene.camera.height = 4;
    scene::Object floor, water;
    floor.shape = scene::Plane{{9, 9}};
    water.shape = scene::Water{.size = {2, 1}};
    water.transform = {.translate = {0.5f, 0, 0}, .rotate = {0, 90, 0}}; // its x axis lies along -z
    scene.objects = {floor, water};
    const Lens lens(scene.camera, {400, 400}); // 0.01 m a pixel, x to the right, -z up
    const auto found = waterAt(scene, lens, {260, 130});
    ASSERT_TRUE(found.has_value()); // world x = 0.6, z = -0.7
    EXPECT_EQ(found->object, 1);
    EXPECT_LT(glm::distance(found->at, vec2(0.7f, 0.1f)), 1e-5f);
    EXPECT_FALSE(waterAt(scene, lens, {310, 130}).has_value()); // x = 1.1 lies beside it
    scene.objects.push_back(water);
    scene.objects.back().transform.translate.y = 0.5f;
    EXPECT_EQ(waterAt(scene, lens, {260, 130})->object, 2);
    scene.objects.back().visible = false;
    EXPECT_EQ(waterAt(scene, lens, {260, 130})->object, 1);
}

TEST(LiftedLight, MovesByAFactorAndLeavesZero) {
    EXPECT_FLOAT_EQ(liftedLight(0.5f, 1.1f), 0.55f);
    EXPECT_FLOAT_EQ(liftedLight(-0.5f, 2), -1);
    EXPECT_FLOAT_EQ(liftedLight(0, 2), 0.002f); // from a millimetre on
}

} // namespace
} // namespace lucent::viewer
