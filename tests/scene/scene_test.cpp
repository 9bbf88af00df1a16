#include "scene/Mesh.h"
#include "scene/Scene.h"
#include "tests/scene/Files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace lucent::scene {
namespace {

// Two height fields, a thing of every other shape, every light, an environment and a technique.
Scene fullScene() {
    Scene scene;
    scene.lights = {PointLight{}, DistantLight{}, SpotLight{}, AreaLight{}};
    scene.environment.emplace();
    scene.technique.emplace("demo", Settings(test::demoParams()));
    scene.objects.resize(2);
    scene.objects[0].name = "coin";
    scene.objects[1].name = "wall";
    for (Object& object : scene.objects)
        object.field().heights = std::make_shared<Image>(test::smallHeights());
    const auto add = [&](const char* name, Shape shape) {
        Object& object = scene.objects.emplace_back();
        object.name = name;
        object.shape = std::move(shape);
    };
    add("bunny", MeshShape{});
    add("floor", Plane{});
    add("block", Box{});
    add("ball", Sphere{});
    add("ring", Torus{});
    add("can", Cylinder{});
    add("pool", Water{});
    for (std::size_t i = 2; i < scene.objects.size(); ++i)
        scene.objects[i].material.kind = Matt{};
    scene.objects[5].material.kind = Clear{};            // the ball
    scene.objects[6].material.kind = Mirror{vec3(0.5f)}; // the ring
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
        const bool changed = bound.path == "objects.ring.material.reflectance" ||
                             (bound.param->id == "kind" && text != "matt");
        EXPECT_EQ(getText(*bound.param, bound.defaults) == text, !changed) << bound.path;
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
        const int group = bound.group() == Group::None ? 100 : int(bound.group());
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
    EXPECT_EQ(scene.objects[1].material.relief().depth, 0.25f);
    EXPECT_EQ(scene.objects[0].material.relief().depth, Relief().depth);
    ASSERT_TRUE(setParam(scene, "camera.type", "perspective"));
    ASSERT_TRUE(setParam(scene, "camera.fov", "25"));
    EXPECT_EQ(scene.camera.fov, 25);
}

TEST(Scene, PointersStayValidWhenParametersAreSet) {
    Scene scene = fullScene();
    const std::vector<BoundParam> before = bindParams(scene);
    ASSERT_TRUE(setParam(scene, "lights.0.intensity", "3"));
    const std::vector<BoundParam> after = bindParams(scene);
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (before[i].isComputed()) continue; // bound anew each time
        EXPECT_EQ(before[i].data, after[i].data);
    }
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

// What stands behind `prefix` in the paths of a scene.
std::vector<std::string> endingsOf(Scene& scene, const std::string& prefix) {
    std::vector<std::string> endings;
    for (const std::string& path : pathsOf(scene))
        if (path.starts_with(prefix)) endings.push_back(path.substr(prefix.size()));
    return endings;
}

TEST(Scene, OnlyTheMaterialParametersThatActAreBound) {
    using List = std::vector<std::string>;
    Scene scene = fullScene();
    EXPECT_EQ(
        endingsOf(scene, "objects.coin.material."),
        (List{"kind", "reflectance", "scattering", "base", "diffuse", "specular", "specularity",
              "forwardScatter", "depth", "specularFalloff", "scatterFalloff", "transmission", "preset"}));
    EXPECT_EQ(endingsOf(scene, "objects.floor.material."),
              (List{"kind", "reflectance", "scattering", "base", "diffuse", "transmission", "preset"}));
    EXPECT_EQ(endingsOf(scene, "objects.ball.material."),
              (List{"kind", "reflectance", "scattering", "transmission", "ior", "dispersion", "fresnel",
                    "attenuationDistance", "attenuationColor", "preset", "absorption"}));
    EXPECT_EQ(endingsOf(scene, "objects.ring.material."),
              (List{"kind", "scattering", "reflectance", "transmission", "preset"}));
}

TEST(Scene, EachShapeAndLightBindsItsOwnParameters) {
    using List = std::vector<std::string>;
    Scene scene = fullScene();
    EXPECT_EQ(endingsOf(scene, "objects.coin.shape."), (List{"heightScale", "width"}));
    EXPECT_EQ(endingsOf(scene, "objects.bunny.shape."), (List{"flatNormals", "textured"}));
    EXPECT_EQ(endingsOf(scene, "objects.floor.shape."), (List{"size"}));
    EXPECT_EQ(endingsOf(scene, "objects.block.shape."), (List{"size"}));
    EXPECT_EQ(endingsOf(scene, "objects.ball.shape."), (List{"radius"}));
    EXPECT_EQ(endingsOf(scene, "objects.ring.shape."), (List{"major", "minor"}));
    EXPECT_EQ(endingsOf(scene, "objects.can.shape."), (List{"radius", "height", "open"}));
    EXPECT_EQ(
        endingsOf(scene, "objects.pool.shape."),
        (List{"size", "cells", "amplitude", "wavelength", "direction", "speed", "damping", "dropInterval"}));
    EXPECT_EQ(endingsOf(scene, "lights.2."),
              (List{"position", "direction", "color", "intensity", "innerAngle", "outerAngle"}));
    EXPECT_EQ(endingsOf(scene, "lights.3."), (List{"corner", "edgeU", "edgeV", "color", "radiance"}));
}

TEST(Scene, AnythingCanBeMadeOfGlassByPath) {
    EXPECT_EQ(set("objects.block.material.transmission", "1"), "1");
    EXPECT_EQ(set("objects.coin.material.transmission", "1"), "1");
    EXPECT_EQ(set("objects.0.material.transmission", "1"), "set"); // objects by number as well
    EXPECT_EQ(set("objects.block.material.ior", "1.3"),
              "objects.block.material.ior is no key of a matt material; must stand in a clear, translucent, "
              "glossy or cook-torrance one");
    EXPECT_EQ(set("objects.ball.material.ior", "1.3"), "1.3");
    EXPECT_EQ(set("objects.ball.material.ior", "0"), "objects.ball.material.ior is 0; must be in (0, 100]");
    EXPECT_EQ(set("objects.ball.material.diffuse", "1 0 0"),
              "objects.ball.material.diffuse is no key of a clear material; must stand in a relief, matt, "
              "glossy, phong, blinn, cook-torrance, oren-nayar or painted translucent one");
    EXPECT_EQ(set("objects.ball.material.attenuationColor", "1 0 0"),
              "objects.ball.material.attenuationColor is 1 0 0; must be in [1e-06, 1]");
    EXPECT_EQ(set("objects.floor.material.depth", "1"),
              "objects.floor.material.depth is no key of a matt material; must stand in a relief one");
}

TEST(Scene, AWaveIsShownOnceItHasAnAmplitude) {
    Scene scene = fullScene();
    const auto groupOf = [&](const std::string& path) {
        for (const BoundParam& bound : bindParams(scene))
            if (bound.path == path) return name(bound.group());
        return std::string_view("unbound");
    };
    EXPECT_EQ(groupOf("objects.bunny.wave.amplitude"), "");
    EXPECT_EQ(groupOf("objects.bunny.wave.period"), "");
    ASSERT_TRUE(setParam(scene, "objects.bunny.wave.amplitude", "0 0.1 0"));
    EXPECT_EQ(groupOf("objects.bunny.wave.amplitude"), "Waves");
    EXPECT_EQ(groupOf("objects.bunny.wave.period"), "Waves");
    EXPECT_EQ(groupOf("objects.block.wave.period"), ""); // each for itself
    EXPECT_EQ(groupOf("objects.pool.wave.period"), "unbound");
    EXPECT_EQ(groupOf("objects.coin.wave.period"), "unbound");
    EXPECT_EQ(set("objects.pool.wave.amplitude", "1 0 0"),
              "objects.pool.wave.amplitude does nothing on height fields and water; must stand on another "
              "shape");
}

TEST(Scene, TimeIsShownWhereSomethingMoves) {
    const auto isShown = [](Scene& scene) {
        for (const BoundParam& bound : bindParams(scene))
            if (bound.path == "view.time") return bound.shown;
        return false;
    };
    Scene scene = fullScene();
    EXPECT_TRUE(isShown(scene)); // the pool
    scene.objects.pop_back();
    EXPECT_FALSE(isShown(scene));
    ASSERT_TRUE(setParam(scene, "view.time", "3")); // reachable all the same
    EXPECT_EQ(scene.view.time, 3);
    ASSERT_TRUE(setParam(scene, "objects.floor.wave.amplitude", "0 0.1 0"));
    EXPECT_TRUE(isShown(scene));
    scene.objects.resize(3); // the bunny is the last
    EXPECT_FALSE(isShown(scene));
    Mesh mesh;
    mesh.rig.duration = 1;
    std::get<MeshShape>(scene.objects[2].shape).mesh = std::make_shared<Mesh>(mesh);
    EXPECT_TRUE(isShown(scene));
}

TEST(Scene, WhatNoRangeCanSayIsChecked) {
    EXPECT_EQ(set("objects.ring.shape.minor", "2"),
              "objects.ring.shape.minor is 2; must be at most major, 1");
    EXPECT_EQ(set("objects.ring.shape.major", "0.25"), "0.25"); // a tube without a hole is one
    EXPECT_EQ(set("objects.pool.shape.direction", "0 0"),
              "objects.pool.shape.direction is 0 0; must have a length");
    EXPECT_EQ(set("objects.bunny.wave.direction", "0 0 0"),
              "objects.bunny.wave.direction is 0 0 0; must have a length");
    EXPECT_EQ(set("lights.2.direction", "0 0 0"), "lights.2.direction is 0 0 0; must have a length");
    EXPECT_EQ(set("lights.2.innerAngle", "25"), "25"); // a hard edge
    EXPECT_EQ(set("lights.2.innerAngle", "26"), "lights.2.innerAngle is 26; must be at most outerAngle, 25");
    EXPECT_EQ(set("lights.2.outerAngle", "90"), "lights.2.outerAngle is 90; must be in [0.1, 89.9]");
    EXPECT_EQ(set("lights.3.edgeU", "0 0 0"), "lights.3.edgeU is 0 0 0; must have a length");
    EXPECT_EQ(set("lights.3.edgeV", "0 0 0"), "lights.3.edgeV is 0 0 0; must have a length");
    EXPECT_EQ(set("lights.3.edgeV", "-2 0 0"), "lights.3.edgeV is -2 0 0, along edgeU; must point elsewhere");
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
    EXPECT_EQ(aovNames()[int(Aov::Irradiance)], "irradiance");
    EXPECT_EQ(aovNames()[int(Aov::Direction)], "direction");
    EXPECT_EQ(aovNames()[int(Aov::Layers)], "layers");
    EXPECT_EQ(aovNames()[int(Aov::Lost)], "lost");
    EXPECT_EQ(aovNames()[int(Aov::CausticMap)], "caustic-map");
    EXPECT_EQ(aovNames().size(), std::size_t(Aov::Atlas) + 1);
}

} // namespace
} // namespace lucent::scene
