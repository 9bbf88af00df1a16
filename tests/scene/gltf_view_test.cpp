// What glTF files show their triangles with.
#include "tests/scene/Gltf.h"

namespace lucent::scene {
namespace {

TEST(GltfView, LampsAndTheFirstCameraStandWhereTheirNodesHoldThem) {
    const Bytes buffer = test::squareBuffer<std::uint16_t>();
    // A spot that is moved and turned to shine down, in a node of twice the size; a camera beside it.
    std::string json = test::gltf(buffer, 5123, R"(, "scale": [2, 2, 2], "children": [1, 2] },
        { "translation": [1, 2, 3], "rotation": [-0.70710678, 0, 0, 0.70710678],
          "extensions": { "KHR_lights_punctual": { "light": 0 } } },
        { "translation": [0, 0, 5], "camera": 0)",
                                  "", "");
    json.insert(json.rfind('}'), R"(, "extensionsUsed": [ "KHR_lights_punctual" ],
        "extensions": { "KHR_lights_punctual": { "lights": [ { "type": "spot", "color": [1, 0.5, 0.25],
            "intensity": 40, "spot": { "innerConeAngle": 0.1, "outerConeAngle": 0.5 } } ] } },
        "cameras": [ { "type": "perspective", "perspective": { "yfov": 0.5, "znear": 1, "aspectRatio": 1.5 } } ])");
    std::string error;
    testing::internal::CaptureStderr();
    const Mesh mesh = test::read(test::glb(buffer, json), error, "m/a.glb");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    ASSERT_EQ(error, "");
    ASSERT_EQ(mesh.lights.size(), 1u);
    const FileLight& light = mesh.lights[0];
    EXPECT_EQ(light.kind, FileLight::Kind::Spot);
    EXPECT_EQ(light.position, vec3(2, 4, 6));
    EXPECT_LT(glm::distance(light.direction, vec3(0, -1, 0)), 1e-6f);
    EXPECT_EQ(light.color, vec3(1, 0.5f, 0.25f));
    EXPECT_EQ(light.intensity, 40);
    EXPECT_NEAR(light.innerAngle, 5.72958f, 1e-4f);
    EXPECT_NEAR(light.outerAngle, 28.6479f, 1e-3f);
    ASSERT_EQ(mesh.cameras.size(), 1u);
    EXPECT_EQ(mesh.cameras[0].eye, vec3(0, 0, 10));
    EXPECT_EQ(mesh.cameras[0].forward, vec3(0, 0, -1));
    EXPECT_NEAR(mesh.cameras[0].fov, 28.6479f, 1e-3f);
    EXPECT_EQ(mesh.cameras[0].aspect, 1.5f);
}

} // namespace
} // namespace lucent::scene
