// Scenes made from a mesh alone.
#include "scene/Load.h"
#include "scene/Mesh.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lucent::scene {
namespace {

/// Two triangles of two materials in a box from (1, 2, 3) to (3, 6, 7): around (2, 4, 5), with a half
/// diagonal of 3.
Mesh twoParts() {
    Mesh mesh{.positions = {{1, 2, 3}, {3, 2, 3}, {1, 6, 7}, {3, 6, 7}}, .indices = {0, 1, 2, 1, 3, 2}};
    Material glass;
    glass.kind = Clear{.ior = 1.7f};
    mesh.parts = {{"paper", 0, 3, {}}, {"window.pane", 3, 3, glass}};
    return mesh;
}

Result<Scene> opened(const Mesh& mesh) { return sceneFromMesh("model.glb", encodeMesh(mesh), {}); }

TEST(SceneFromMesh, KeepsTheMaterialsOfItsFile) {
    const Result<Scene> scene = opened(twoParts());
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    ASSERT_EQ(scene->objects.size(), 2u);
    EXPECT_EQ(scene->objects[0].name, "mesh/paper");
    EXPECT_FALSE(scene->objects[0].material.isRefractive());
    EXPECT_EQ(scene->objects[1].material.clear().ior, 1.7f);
    EXPECT_TRUE(scene->objects[1].material.isRefractive());
    EXPECT_EQ(scene->title, "model.glb");
    EXPECT_EQ(scene->environment->source, "sky");
}

TEST(SceneFromMesh, TheCameraSeesAllOfIt) {
    const Result<Scene> scene = opened(twoParts());
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    const Camera& camera = scene->camera;
    EXPECT_EQ(camera.target, vec3(2, 4, 5));
    // A ball of radius 3 touches the ends of the field of view at 3 / sin(half of it); some air is left.
    const float touching = 3 / std::sin(glm::radians(camera.fov / 2));
    const float distance = glm::distance(camera.eye, camera.target);
    EXPECT_GT(distance, touching);
    EXPECT_LT(distance, 1.1f * touching);
}

TEST(SceneFromMesh, WithoutMaterialsItIsOneOpaqueObject) {
    Mesh mesh = twoParts();
    mesh.parts.clear();
    const Result<Scene> scene = opened(mesh);
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    ASSERT_EQ(scene->objects.size(), 1u);
    EXPECT_EQ(scene->objects[0].material.diffuse, Material().diffuse);
}

TEST(SceneFromMesh, WhatIsNoMeshOrHasNoExtentIsRefused) {
    const Result<Scene> none = sceneFromMesh("model.glb", Bytes(9), {});
    ASSERT_FALSE(none.ok());
    EXPECT_EQ(none.error().message,
              "model.glb: is no mesh file; must be glTF 2.0, OBJ or start with LUCENTM4");
    const Result<Scene> point = opened(Mesh{.positions = {vec3(1)}, .indices = {0, 0, 0}});
    ASSERT_FALSE(point.ok());
    EXPECT_EQ(point.error().message, "model.glb: is a single point; must have some extent");
}

} // namespace
} // namespace lucent::scene
