#include "scene/Scene.h"
#include "tests/scene/Files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace lucent::scene {
namespace {

// Two objects, two lights, an environment and a technique.
Scene fullScene() {
    Scene scene;
    scene.lights = {PointLight{}, DistantLight{}};
    scene.environment.emplace();
    scene.technique.emplace("demo", Settings(test::demoParams()));
    scene.objects.resize(2);
    scene.objects[0].name = "coin";
    scene.objects[1].name = "wall";
    for (Object& object : scene.objects)
        object.field().heights = std::make_shared<Image>(test::smallHeights());
    return scene;
}

std::vector<std::string> pathsOf(Scene& scene) {
    std::vector<std::string> paths;
    for (const BoundParam& bound : bindParams(scene))
        paths.push_back(bound.path);
    return paths;
}

bool has(const std::vector<std::string>& paths, const std::string& path) {
    return std::find(paths.begin(), paths.end(), path) != paths.end();
}

std::string set(std::string_view path, std::string_view value) {
    Scene scene = fullScene();
    const Status status = setParam(scene, path, value);
    if (!status) return status.error().message;
    for (const BoundParam& bound : bindParams(scene))
        if (bound.path == path) return getText(*bound.param, bound.data);
    return "set";
}

TEST(Scene, EveryParameterReadsBackFromItsOwnText) {
    Scene scene = fullScene();
    for (const BoundParam& bound : bindParams(scene)) {
        const std::string text = getText(*bound.param, bound.data);
        const Status status = setText(*bound.param, bound.data, text);
        ASSERT_TRUE(status) << bound.path << " " << status.error().message;
        EXPECT_EQ(getText(*bound.param, bound.data), text) << bound.path;
        EXPECT_EQ(getText(*bound.param, bound.defaults), text) << bound.path; // nothing was changed
        EXPECT_LT(bound.param->low, bound.param->high) << bound.path;
        EXPECT_GE(bound.param->low, bound.param->min) << bound.path;
        EXPECT_LE(bound.param->high, bound.param->max) << bound.path;
        EXPECT_FALSE(bound.param->label.empty()) << bound.path;
        EXPECT_TRUE(bound.param->doc.ends_with('.')) << bound.path;
    }
}

TEST(Scene, ParametersStandInTheOrderOfThePanel) {
    Scene scene = fullScene();
    int last = 0;
    for (const BoundParam& bound : bindParams(scene)) {
        const int group = bound.param->group == Group::None ? 100 : int(bound.param->group);
        EXPECT_GE(group, last) << bound.path;
        last = group;
    }
    EXPECT_EQ(pathsOf(scene).front(), "lights.0.position");
}

TEST(Scene, PathsFollowTheSceneFile) {
    Scene scene = fullScene();
    const std::vector<std::string> paths = pathsOf(scene);
    for (const char* path :
         {"lights.0.position", "lights.1.direction", "objects.coin.material.depth",
          "objects.wall.shape.heightScale", "objects.coin.transform.rotate", "environment.rotation",
          "camera.height", "view.exposure", "technique.demo.method"})
        EXPECT_TRUE(has(paths, path)) << path;
    EXPECT_FALSE(has(paths, "camera.fov")); // an orthographic camera has none
    scene.camera.type = Camera::Type::Perspective;
    EXPECT_TRUE(has(pathsOf(scene), "camera.fov"));
    EXPECT_FALSE(has(pathsOf(scene), "camera.height"));
    EXPECT_EQ(std::set<std::string>(paths.begin(), paths.end()).size(), paths.size());
}

TEST(Scene, AttributesAreUniqueAndAddressTheFirstLightAndObject) {
    Scene scene = fullScene();
    std::map<std::string, std::string> pathOfAttribute;
    for (const BoundParam& bound : bindParams(scene)) {
        const std::string attribute = attributeName(bound);
        if (attribute.empty()) continue;
        EXPECT_TRUE(pathOfAttribute.emplace(attribute, bound.path).second) << attribute;
    }
    EXPECT_EQ(pathOfAttribute["light"], "lights.0.position");
    EXPECT_EQ(pathOfAttribute["light-intensity"], "lights.0.intensity");
    EXPECT_EQ(pathOfAttribute["env-rotation"], "environment.rotation");
    EXPECT_EQ(pathOfAttribute["material-specular-falloff"], "objects.coin.material.specularFalloff");
    EXPECT_EQ(pathOfAttribute["height-scale"], "objects.coin.shape.heightScale");
    EXPECT_EQ(pathOfAttribute["demo-method"], "technique.demo.method");
    EXPECT_EQ(pathOfAttribute["view-exposure"], "view.exposure");
}

TEST(Scene, ParametersAreSetByPathWithNamesOrNumbers) {
    EXPECT_EQ(set("objects.coin.material.specularity", "0.4"), "0.4");
    EXPECT_EQ(set("technique.demo.method", "plain"), "plain");
    Scene scene = fullScene();
    ASSERT_TRUE(setParam(scene, "objects.1.material.depth", "0.25"));
    EXPECT_EQ(scene.objects[1].material.depth, 0.25f);
    EXPECT_EQ(scene.objects[0].material.depth, Material().depth);
    ASSERT_TRUE(setParam(scene, "camera.type", "perspective"));
    ASSERT_TRUE(setParam(scene, "camera.fov", "25"));
    EXPECT_EQ(scene.camera.fov, 25);
}

TEST(Scene, PointersStayValidWhenParametersAreSet) {
    Scene scene = fullScene();
    const std::vector<BoundParam> before = bindParams(scene);
    ASSERT_TRUE(setParam(scene, "lights.0.intensity", "3"));
    const std::vector<BoundParam> after = bindParams(scene);
    for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_EQ(before[i].data, after[i].data);
}

TEST(Scene, FailedSetNamesPathFoundAndExpectedAndChangesNothing) {
    EXPECT_EQ(set("objects.coin.material.specularity", "2"),
              "objects.coin.material.specularity is 2; must be in [0, 1]");
    EXPECT_EQ(set("view.exposure", "bright"), "view.exposure is \"bright\"; must be a number");
    EXPECT_EQ(set("objects.coin.material.speculrity", "1"),
              "objects.coin.material.speculrity is not a parameter; the nearest is "
              "objects.coin.material.specularity");
    EXPECT_EQ(set("lights.1.direction", "0 0 0"), "lights.1.direction is 0 0 0; must have a length");
    EXPECT_EQ(set("camera.eye", "0 0 0"), "camera.target is 0 0 0, the eye; must differ from it");
    Scene scene = fullScene();
    EXPECT_FALSE(setParam(scene, "lights.1.direction", "0 0 0"));
    EXPECT_EQ(std::get<DistantLight>(scene.lights[1]).direction, vec3(0, 0, -1));
}

TEST(Scene, ObjectsAreScaledThenTurnedThenMoved) {
    Transform transform;
    transform.translate = {10, 0, 0};
    transform.rotate = {0, 0, 90};
    transform.scale = 2;
    // (1, 0, 0) doubled is (2, 0, 0), turned about z (0, 2, 0), moved (10, 2, 0).
    EXPECT_NEAR(glm::distance(vec3(transform.worldFromObject() * vec4(1, 0, 0, 1)), vec3(10, 2, 0)), 0, 1e-5);
}

TEST(Scene, AovNamesAreThoseOfTheCommandLine) {
    EXPECT_EQ(aovNames()[int(Aov::Color)], "color");
    EXPECT_EQ(aovNames()[int(Aov::Illumination)], "d");
    EXPECT_EQ(aovNames()[int(Aov::Iterations)], "iterations");
    EXPECT_EQ(aovNames().size(), std::size_t(Aov::Iterations) + 1);
}

} // namespace
} // namespace lucent::scene
