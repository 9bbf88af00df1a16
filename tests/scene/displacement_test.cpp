// Displacement in scene files: what it may stand on, what it says, and that it is kept.
#include "scene/Displacement.h"
#include "scene/Load.h"
#include "scene/Mesh.h"
#include "tests/scene/Files.h"

#include <gtest/gtest.h>

namespace lucent::scene {
namespace {

using test::Files;

std::string sceneWith(const std::string& shape, const std::string& displacement,
                      const std::string& more = "") {
    return R"({ "lucent": 1, "objects": [ { "name": "stone", "shape": )" + shape + R"(, "displacement": )" +
           displacement + more + " } ] }";
}
constexpr const char* kPlane = R"({ "type": "plane", "size": [2, 2] })";

std::string messageOf(const std::string& json, const Files& files = {}) {
    const Result<Scene> scene = test::load(files, json);
    return scene ? "no error" : scene.error().message;
}

TEST(Displacement, IsReadAndWrittenBack) {
    const Files files;
    const Result<Scene> scene = test::load(
        files,
        sceneWith(kPlane, R"({ "heights": "h.pfm", "scale": 0.2, "repeat": [2, 3], "method": "interval",
                                     "searchSteps": 64 })"));
    ASSERT_TRUE(scene) << scene.error().message;
    const Object& stone = scene->objects[0];
    ASSERT_TRUE(stone.isDisplaced());
    EXPECT_EQ(stone.displacement->method, DisplacementMethod::Interval);
    EXPECT_EQ(stone.displacement->repeat, vec2(2, 3));
    EXPECT_EQ(baseOf(stone)->triangles.size(), 2u);
    const std::string text = toJson(*scene);
    const Result<Scene> again = test::load(files, text);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(toJson(*again), text);
    EXPECT_EQ(again->objects[0].displacement->searchSteps, 64);
}

TEST(Displacement, StandsOnlyWhereItActs) {
    const std::string heights = R"({ "heights": "h.pfm" })";
    EXPECT_EQ(messageOf(sceneWith(R"({ "type": "box" })", heights)),
              "scenes/a.json:1: objects.stone.displacement does nothing on a box; must stand on a plane, "
              "sphere, torus or mesh");
    EXPECT_EQ(messageOf(sceneWith(kPlane, heights, R"(, "wave": { "amplitude": [0, 1, 0] })")),
              "scenes/a.json:1: objects.stone.wave does nothing on a displaced surface; must stand without "
              "displacement");
    EXPECT_EQ(messageOf(sceneWith(kPlane, R"({ "scale": 1 })")),
              "scenes/a.json:1: objects.stone.displacement has no heights; must have one of heights, "
              "normalMap, mesh");
}

TEST(Displacement, HeightsLieBetween0And1) {
    Files files;
    Image deep(2, 2, 1);
    *deep.at(1, 0) = -0.5f;
    files.put("scenes/deep.pfm", deep);
    EXPECT_EQ(messageOf(sceneWith(kPlane, R"({ "heights": "deep.pfm" })"), files),
              "scenes/a.json:1: objects.stone.displacement.heights lie from -0.5 to 0; must lie from 0 to 1");
}

TEST(Displacement, ItsFilesAreToldBeforeTheyAreRead) {
    const std::string json = sceneWith(kPlane, R"({ "heights": "h.pfm" })");
    const auto files = dependencies("scenes/a.json", std::as_bytes(std::span(json)));
    ASSERT_TRUE(files);
    EXPECT_EQ(*files, std::vector<std::string>{"scenes/h.pfm"});
}

TEST(Displacement, ASphereHasASeamThatCloses) {
    Object ball;
    ball.shape = Sphere{1};
    auto map = std::make_shared<Image>(8, 8, 1);
    for (int i = 0; i < 64; ++i)
        map->pixels[std::size_t(i)] = float(i % 7) / 7;
    ball.displacement = Displacement{.heights = map};
    const auto base = baseOf(ball);
    EXPECT_TRUE(base->closed);
    // Around the poles alone the map lies otherwise on neighbours.
    for (const DisplacedTriangle& one : base->triangles) {
        float highest = 0;
        for (const vec3& place : one.places)
            highest = std::max(highest, std::abs(place.y));
        if (highest < 0.99f) {
            EXPECT_EQ(one.walls, 0u);
        }
    }
    ball.material.kind = Clear{};
    EXPECT_EQ(openEdges(*meshOf(ball)), 0u);
}

} // namespace
} // namespace lucent::scene
