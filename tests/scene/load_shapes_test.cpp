// Everything of a scene file that is not about height fields: shapes, lights, clear things and mirrors,
// waves.
#include "scene/Load.h"
#include "scene/MaterialPresets.h"
#include "scene/Mesh.h"
#include "tests/scene/Files.h"

#include <gtest/gtest.h>

namespace lucent::scene {
namespace {

using test::Files;

// A scene of one object called ball: `shape` on line 2, `more` members of it on line 3.
std::string objectOf(const std::string& shape, const std::string& more = "") {
    return "{ \"lucent\": 1, \"objects\": [ { \"name\": \"ball\",\n\"shape\": { " + shape + " }" +
           (more.empty() ? "" : ",\n" + more) + " } ] }";
}
std::string sphereWith(const std::string& more) { return objectOf(R"("type": "sphere")", more); }
// A scene with one light, on line 2.
std::string lightOf(const std::string& members) {
    return "{ \"lucent\": 1,\n\"lights\": [ { " + members +
           " } ], \"objects\": [ { \"shape\": { \"type\": \"sphere\" } } ] }";
}

std::string messageOf(const std::string& json, const Files& files = {}) {
    const Result<Scene> scene = test::load(files, json);
    return scene ? "no error" : scene.error().message;
}

template <class Shape>
Shape shapeOf(const std::string& members) {
    const Result<Scene> scene = test::load({}, objectOf(members));
    if (scene) return std::get<Shape>(scene->objects[0].shape);
    ADD_FAILURE() << scene.error().message;
    return {};
}

// Two triangles, of a clear and of an opaque material.
Mesh twoMaterials() {
    Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 1, 2, 0, 2, 3}};
    Material glass, paint;
    glass.kind = Clear{.ior = 1.33f, .absorption = {0, 7, 14}};
    paint.kind = Matt{};
    paint.diffuse = {0.9f, 0.1f, 0.1f};
    mesh.parts = {{"Glass.001", 0, 3, glass}, {"Paint", 3, 3, paint}};
    return mesh;
}
Files withMesh(const Mesh& mesh) {
    Files files;
    files.content["scenes/m.glb"] = encodeMesh(mesh);
    return files;
}
const std::string kMesh = R"("type": "mesh", "source": "m.glb")";

TEST(LoadShapes, ShapesHaveTheirKeysAndTheDefaultsOfTheSpecification) {
    EXPECT_EQ(shapeOf<Plane>(R"("type": "plane")").size, vec2(1));
    EXPECT_EQ(shapeOf<Plane>(R"("type": "plane", "size": [3, 2])").size, vec2(3, 2)); // no range
    EXPECT_EQ(shapeOf<Box>(R"("type": "box", "size": [1, 2, 3])").size, vec3(1, 2, 3));
    EXPECT_EQ(shapeOf<Sphere>(R"("type": "sphere")").radius, 1);
    EXPECT_EQ(shapeOf<Sphere>(R"("type": "sphere", "radius": 0.3)").radius, 0.3f);
    const Torus torus = shapeOf<Torus>(R"("type": "torus", "major": 0.5, "minor": 0.5)");
    EXPECT_EQ(vec2(torus.major, torus.minor), vec2(0.5f));
    const Cylinder can = shapeOf<Cylinder>(R"("type": "cylinder", "radius": 2, "height": 3, "open": true)");
    EXPECT_EQ(vec2(can.radius, can.height), vec2(2, 3));
    EXPECT_TRUE(can.open);
    EXPECT_FALSE(shapeOf<Cylinder>(R"("type": "cylinder")").open);
    const Water water = shapeOf<Water>(
        R"("type": "water", "size": [4, 2], "cells": 64, "speed": 0.3, "damping": 0.1, "amplitude": 0.02,
           "wavelength": 0.5, "direction": [1, -1], "dropInterval": 2)");
    EXPECT_EQ(water.size, vec2(4, 2));
    EXPECT_EQ(water.cells, 64);
    EXPECT_EQ(water.direction, vec2(1, -1));
    EXPECT_EQ(water.dropInterval, 2);
}

TEST(LoadShapes, WrongShapesAreRefused) {
    EXPECT_EQ(messageOf(objectOf(R"("type": "sphere", "size": 1)")),
              "scenes/a.json:2: objects.ball.shape.size is an unknown key; the nearest is \"type\"");
    EXPECT_EQ(messageOf(objectOf(R"("type": "plane", "size": [1, 2, 3])")),
              "scenes/a.json:2: objects.ball.shape.size is a list; must be a list of 2 numbers");
    EXPECT_EQ(messageOf(objectOf(R"("type": "box", "size": [1, 0, 3])")),
              "scenes/a.json:2: objects.ball.shape.size is 1 0 3; must be in (0, 1000000]");
    EXPECT_EQ(messageOf(objectOf(R"("type": "sphere", "radius": -1)")),
              "scenes/a.json:2: objects.ball.shape.radius is -1; must be in (0, 1000000]");
    EXPECT_EQ(messageOf(objectOf(R"("type": "torus", "minor": 1.5)")),
              "scenes/a.json:2: objects.ball.shape.minor is 1.5; must be at most major, 1");
    EXPECT_EQ(messageOf(objectOf(R"("type": "water", "direction": [0, 0])")),
              "scenes/a.json:2: objects.ball.shape.direction is 0 0; must have a length");
    EXPECT_EQ(messageOf(objectOf(R"("type": "water", "cells": 2)")),
              "scenes/a.json:2: objects.ball.shape.cells is 2; must be in [4, 4096]");
}

TEST(LoadShapes, SpotAndAreaLightsAreRead) {
    const Result<Scene> scene = test::load({}, R"({ "lucent": 1, "lights": [
        { "type": "spot", "position": [1, 2, 3], "direction": [0, 0, -1], "intensity": 5, "color": [1, 0.5, 0],
          "innerAngle": 10, "outerAngle": 12 },
        { "type": "area", "corner": [0, 1, 0], "edgeU": [1, 0, 0], "edgeV": [0, 0, 2], "radiance": 7 } ],
        "objects": [ { "shape": { "type": "sphere" } } ] })");
    ASSERT_TRUE(scene) << scene.error().message;
    const auto& spot = std::get<SpotLight>(scene->lights[0]);
    EXPECT_EQ(spot.position, vec3(1, 2, 3));
    EXPECT_EQ(spot.direction, vec3(0, 0, -1));
    EXPECT_EQ(spot.color, vec3(1, 0.5f, 0));
    EXPECT_EQ(spot.intensity, 5);
    EXPECT_EQ(vec2(spot.innerAngle, spot.outerAngle), vec2(10, 12));
    const auto& area = std::get<AreaLight>(scene->lights[1]);
    EXPECT_EQ(area.corner, vec3(0, 1, 0));
    EXPECT_EQ(area.edgeV, vec3(0, 0, 2));
    EXPECT_EQ(area.radiance, 7);
}

TEST(LoadShapes, WrongLightsAreRefused) {
    EXPECT_EQ(messageOf(lightOf(R"("type": "spot", "innerAngle": 30)")),
              "scenes/a.json:2: lights.0.innerAngle is 30; must be at most outerAngle, 25");
    EXPECT_EQ(messageOf(lightOf(R"("type": "spot", "outerAngle": 90)")),
              "scenes/a.json:2: lights.0.outerAngle is 90; must be in [0.1, 89.9]");
    EXPECT_EQ(messageOf(lightOf(R"("type": "spot", "direction": [0, 0, 0])")),
              "scenes/a.json:2: lights.0.direction is 0 0 0; must have a length");
    EXPECT_EQ(messageOf(lightOf(R"("type": "spot", "falloff": "none")")),
              "scenes/a.json:2: lights.0.falloff is an unknown key; the nearest is \"color\"");
    EXPECT_EQ(messageOf(lightOf(R"("type": "area", "edgeU": [0, 0, 3])")),
              "scenes/a.json:2: lights.0.edgeV is 0 0 0.5, along edgeU; must point elsewhere");
    EXPECT_EQ(messageOf(lightOf(R"("type": "area", "edgeV": [0, 0, 0])")),
              "scenes/a.json:2: lights.0.edgeV is 0 0 0; must have a length");
}

TEST(LoadShapes, KeysOfAnotherKindOfMaterialAreRefused) {
    const std::string field = R"("type": "heightfield", "heights": "h.pfm")";
    const auto refused = [](const std::string& scene, const std::string& what) {
        EXPECT_EQ(messageOf(scene), "scenes/a.json:3: objects.ball.material." + what);
    };
    refused(objectOf(field, R"("material": { "ior": 1 })"),
            "ior is no key of a relief material; must stand in a clear, translucent, glossy or cook-torrance "
            "one");
    refused(objectOf(field, R"("material": { "reflectance": [1, 1, 1], "depth": 3 })"),
            "depth is no key of a mirror material; must stand in a relief one");
    for (const std::string key : {"depth", "specularity", "forwardScatter"})
        refused(sphereWith("\"material\": { \"" + key + "\": 1 }"),
                key + " is no key of a matt material; must stand in a relief one");
    refused(sphereWith(R"("material": { "diffuseMap": "c.png" })"),
            "diffuseMap is no key of a matt material; must stand in a relief one");
    refused(sphereWith(R"("material": { "absorption": 1, "transmission": 0 })"),
            "absorption is no key of a matt material; must stand in a clear or translucent one");
    refused(sphereWith(R"("material": { "anisotropy": 0.5, "transmission": 1 })"),
            "anisotropy is no key of a clear material; must stand in a translucent one");
    refused(sphereWith(R"("material": { "dispersion": 0.3, "preset": "marble" })"),
            "dispersion is no key of a translucent material; must stand in a clear one");
    refused(
        sphereWith(R"("material": { "diffuse": [1, 0, 0], "preset": "marble" })"),
        "diffuse is no key of a translucent material; must stand in a relief, matt, glossy, phong, blinn, "
        "cook-torrance, oren-nayar or painted translucent one");
    refused(sphereWith(R"("material": { "preset": "marble", "kind": "clear" })"),
            "preset makes another kind of material than kind; must stand without it");
    refused(sphereWith(R"("material": { "transmission": 1, "reflectance": [0, 0, 1] })"),
            "reflectance makes another kind of material than transmission; must stand without it");
    refused(sphereWith(R"("material": { "kind": "phong", "roughness": 0.2 })"),
            "roughness is no key of a phong material; must stand in a translucent, glossy, cook-torrance or "
            "oren-nayar one");
    refused(sphereWith(R"("material": { "kind": "glass" })"),
            "kind is \"glass\"; must be relief, matt, mirror, clear, translucent, glossy, phong, blinn, "
            "cook-torrance, oren-nayar or measured");
}

TEST(LoadShapes, TheKindFollowsFromTheKeysAndTheShape) {
    const auto kindOf = [](const std::string& scene) {
        const Result<Scene> loaded = test::load({}, scene);
        EXPECT_TRUE(loaded) << loaded.error().message;
        return loaded ? loaded->objects[0].material.kind.index() : 9;
    };
    enum : std::size_t { kRelief, kMatt, kMirror, kClear, kTranslucent };
    const std::string field = R"("type": "heightfield", "heights": "h.pfm")";
    EXPECT_EQ(kindOf(objectOf(field)), kRelief);
    EXPECT_EQ(kindOf(objectOf(field, R"("material": { "kind": "matt" })")), kMatt);
    EXPECT_EQ(kindOf(objectOf(field, R"("material": { "transmission": 1 })")), kClear);
    EXPECT_EQ(kindOf(objectOf(R"("type": "sphere")")), kMatt);
    EXPECT_EQ(kindOf(sphereWith(R"("material": {})")), kMatt);
    EXPECT_EQ(kindOf(sphereWith(R"("material": { "kind": "relief", "specularity": 0.5 })")), kRelief);
    EXPECT_EQ(kindOf(sphereWith(R"("material": { "reflectance": [0, 0, 1] })")), kMirror);
    EXPECT_EQ(kindOf(sphereWith(R"("material": { "kind": "clear" })")), kClear);
    EXPECT_EQ(kindOf(sphereWith(R"("material": { "scattering": 100 })")), kTranslucent);
    EXPECT_EQ(kindOf(sphereWith(R"("material": { "preset": "marble" })")), kTranslucent);
}

TEST(LoadShapes, PresetsAreMeasuredCoefficientsPerMetre) {
    const auto materialWith = [](const std::string& keys) {
        const Result<Scene> scene = test::load({}, sphereWith("\"material\": { " + keys + " }"));
        EXPECT_TRUE(scene) << scene.error().message;
        return scene ? scene->objects[0].material.translucent() : Translucent{};
    };
    const Translucent marble = materialWith(R"("preset": "marble")");
    EXPECT_EQ(marble.scattering, vec3(2190, 2620, 3000));
    EXPECT_EQ(marble.ior, 1.5f);
    for (int i = 0; i < 3; ++i)
        EXPECT_FLOAT_EQ(marble.absorption[i], vec3(2.1f, 4.1f, 7.1f)[i]);
    EXPECT_EQ(materialWith(R"("preset": "spectralon")").absorption, vec3(0));
    EXPECT_EQ(materialPresets().size(), 12u);
    for (const MaterialPreset& preset : materialPresets())
        EXPECT_NE(materialWith("\"preset\": \"" + std::string(preset.name) + "\"").scattering, vec3(0));

    // What was measured is (1 - g) sigma_s.
    EXPECT_FLOAT_EQ(materialWith(R"("preset": "marble", "anisotropy": 0.75)").scattering.x, 4 * 2190);
    const Translucent other =
        materialWith(R"("preset": "marble", "ior": 1.3, "absorption": 2, "roughness": 0.1)");
    EXPECT_EQ(other.scattering, marble.scattering);
    EXPECT_EQ(other.ior, 1.3f);
    EXPECT_FLOAT_EQ(other.absorption.z, 2);
    EXPECT_EQ(materialWith(R"("preset": "marble", "scattering": [1, 2, 3])").scattering, vec3(1, 2, 3));

    EXPECT_EQ(
        messageOf(sphereWith(R"("material": { "preset": "granite" })")),
        "scenes/a.json:3: objects.ball.material.preset is \"granite\"; must be apple, chicken1, chicken2, "
        "cream, ketchup, marble, potato, skimmilk, skin1, skin2, spectralon or wholemilk");
}

TEST(LoadShapes, LayersLieInTheirOrderAndAreSetByPath) {
    const auto ballOf = [](const std::string& layers) {
        return sphereWith(R"("material": { "preset": "marble", "layers": )" + layers + " }");
    };
    Result<Scene> scene = test::load({}, ballOf(R"([ { "preset": "skin1", "thickness": 0.0005, "ior": 1.4 },
        { "scattering": [1, 2, 3], "absorption": [4, 5, 6], "anisotropy": 0.5, "thickness": 0.002 } ])"));
    ASSERT_TRUE(scene) << scene.error().message;
    const Material& material = scene->objects[0].material;
    ASSERT_EQ(material.translucent().layers.size(), 2u);
    EXPECT_EQ(material.translucent().layers[0].scattering, vec3(740, 880, 1010));
    EXPECT_EQ(material.translucent().layers[0].absorption, vec3(32, 170, 480));
    EXPECT_EQ(material.translucent().layers[1].absorption, vec3(4, 5, 6));
    EXPECT_EQ(material.translucent().surfaceIor(), 1.4f);
    ASSERT_TRUE(setParam(*scene, "objects.ball.material.layers.0.order", "2"));
    EXPECT_EQ(material.translucent().stackedLayers()[0].scattering, vec3(1, 2, 3));
    EXPECT_EQ(material.translucent().surfaceIor(), 1.5f);
    ASSERT_TRUE(setParam(*scene, "objects.ball.material.layers.1.thickness", "0"));
    EXPECT_EQ(material.translucent().stackedLayers().size(), 1u);
    EXPECT_EQ(setParam(*scene, "objects.ball.material.layers.0.ior", "9").error().message,
              "objects.ball.material.layers.0.ior is 9; must be in [0.3, 3]");
    EXPECT_EQ(setParam(*scene, "objects.ball.material.layers.2.ior", "1.3").error().message,
              "objects.ball.material.layers.2.ior is not a parameter; the nearest is "
              "objects.ball.material.layers.0.ior");

    EXPECT_EQ(messageOf(sphereWith(R"("material": { "layers": [ {} ] })")),
              "scenes/a.json:3: objects.ball.material.layers is no key of a matt material; must stand in a "
              "translucent one");
    EXPECT_EQ(
        messageOf(ballOf("[ {}, {}, {}, {}, {} ]")),
        "scenes/a.json:3: objects.ball.material.layers has 5 layers; must be a list of at most 4 layers");
    EXPECT_EQ(messageOf(ballOf(R"([ { "thick": 1 } ])")),
              "scenes/a.json:3: objects.ball.material.layers.0.thick is an unknown key; the nearest is "
              "\"thickness\"");
}

TEST(LoadShapes, WhatScattersIsNeitherClearNorAMirrorAndHasAnOrdinaryIndex) {
    EXPECT_EQ(messageOf(sphereWith(R"("material": { "scattering": [0, 1, 0], "transmission": 1 })")),
              "scenes/a.json:3: objects.ball.material.scattering makes another kind of material than "
              "transmission; must stand without it");
    EXPECT_EQ(
        messageOf(sphereWith(R"("material": { "preset": "marble", "reflectance": [1, 1, 1] })")),
        "scenes/a.json:3: objects.ball.material.preset makes another kind of material than reflectance; "
        "must stand without it");
    EXPECT_EQ(messageOf(sphereWith(R"("material": { "kind": "translucent", "scattering": [0, 0, 0] })")),
              "scenes/a.json:3: objects.ball.material.scattering is 0 0 0; must be above 0 in a colour of a "
              "translucent material");
    EXPECT_EQ(messageOf(sphereWith(R"("material": { "scattering": [1, 1, 1], "ior": 4 })")),
              "scenes/a.json:3: objects.ball.material.ior is 4; must be in [0.3, 3]");
    EXPECT_EQ(messageOf(sphereWith(R"("material": { "scattering": [1, 1, 1], "anisotropy": 1 })")),
              "scenes/a.json:3: objects.ball.material.anisotropy is 1; must be in [-0.999, 0.999]");
}

TEST(LoadShapes, AbsorptionIsAnotherWayToSayAttenuation) {
    const auto absorptionOf = [](const std::string& value) {
        const Result<Scene> scene = test::load(
            {}, sphereWith("\"material\": { \"transmission\": 1, \"absorption\": " + value + " }"));
        EXPECT_TRUE(scene) << scene.error().message;
        return scene->objects[0].material.clear().absorption;
    };
    for (int i = 0; i < 3; ++i) {
        EXPECT_FLOAT_EQ(absorptionOf("4")[i], 4);
        EXPECT_FLOAT_EQ(absorptionOf("[0.45, 0.07, 0.02]")[i], vec3(0.45f, 0.07f, 0.02f)[i]);
    }
    EXPECT_EQ(absorptionOf("0"), vec3(0));
    const auto messageFor = [](const std::string& material) {
        return messageOf(sphereWith("\"material\": { \"transmission\": 1, " + material + " }"));
    };
    EXPECT_EQ(messageFor(R"("absorption": -1)"),
              "scenes/a.json:3: objects.ball.material.absorption is -1 -1 -1; must be in [0, 1e+09]");
    EXPECT_EQ(messageFor(R"("absorption": [1, -1, 0])"),
              "scenes/a.json:3: objects.ball.material.absorption is 1 -1 0; must be in [0, 1e+09]");
    EXPECT_EQ(
        messageFor(R"("absorption": "blue")"),
        "scenes/a.json:3: objects.ball.material.absorption is \"blue\"; must be a number or a list of 3 "
        "numbers");
    EXPECT_EQ(messageFor(R"("absorption": [1, 2])"),
              "scenes/a.json:3: objects.ball.material.absorption is a list; must be a list of 3 numbers");
    EXPECT_EQ(messageFor(R"("absorption": 1, "attenuationDistance": 1)"),
              "scenes/a.json:3: objects.ball.material has absorption and attenuationDistance; must have "
              "absorption, or attenuationColor with attenuationDistance");
    EXPECT_EQ(messageFor(R"("absorption": 1, "attenuationColor": [1, 1, 1])"),
              "scenes/a.json:3: objects.ball.material has absorption and attenuationColor; must have "
              "absorption, or attenuationColor with attenuationDistance");
    EXPECT_EQ(
        messageFor(R"("attenuationColor": [1, 1, 0.5])"),
        "scenes/a.json:3: objects.ball.material.attenuationColor is given without a distance; must stand "
        "beside attenuationDistance");
    EXPECT_EQ(messageFor(R"("attenuationColor": [1, 1, 0], "attenuationDistance": 1)"),
              "scenes/a.json:3: objects.ball.material.attenuationColor is 1 1 0; must be in [1e-06, 1]");
}

TEST(LoadShapes, WavesRunThroughEverythingButFieldsAndWater) {
    const std::string wave = R"("wave": { "amplitude": [0, 0.1, 0], "period": 2 })";
    const Result<Scene> scene = test::load({}, sphereWith(wave));
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->objects[0].wave.amplitude, vec3(0, 0.1f, 0));
    EXPECT_EQ(scene->objects[0].wave.direction, vec3(1, 0, 0));
    EXPECT_EQ(scene->objects[0].wave.period, 2);
    const std::string refused = "scenes/a.json:3: objects.ball.wave does nothing on height fields and water; "
                                "must stand on another shape";
    EXPECT_EQ(messageOf(objectOf(R"("type": "water")", wave)), refused);
    EXPECT_EQ(messageOf(objectOf(R"("type": "heightfield", "heights": "h.pfm")", wave)), refused);
    EXPECT_EQ(messageOf(sphereWith(R"("wave": { "period": 1 })")),
              "scenes/a.json:3: objects.ball.wave.amplitude is missing; must be a list of 3 numbers");
    EXPECT_EQ(messageOf(sphereWith(R"("wave": { "amplitude": [1, 0, 0], "direction": [0, 0, 0] })")),
              "scenes/a.json:3: objects.ball.wave.direction is 0 0 0; must have a length");
}

// 64 bits may take 16 GiB, which five sheets of 4097 x 4097 vertices pass; in a page one does.
TEST(LoadShapes, MoreWaterThanMemoryIsRefusedByNameBeforeAnyIsTaken) {
    const auto pools = [](int count, int cells) {
        std::string objects;
        for (int i = 0; i < count; ++i)
            objects += std::string(i ? "," : "") + "\n{ \"name\": \"" + std::string(1, char('a' + i)) +
                       R"(", "shape": { "type": "water", "cells": )" + std::to_string(cells) + " } }";
        return "{ \"lucent\": 1, \"objects\": [" + objects + " ] }";
    };
    const std::string why =
        ".shape.cells is 4096: with it all objects take about 18.8 GiB of memory; must take at "
        "most 16 GiB";
    EXPECT_EQ(messageOf(pools(5, 4096)), "scenes/a.json:6: objects.e" + why);
    Result<Scene> scene = test::load({}, pools(5, 64));
    ASSERT_TRUE(scene) << scene.error().message;
    for (const char* pool : {"a", "b", "c", "d"})
        ASSERT_TRUE(setParam(*scene, std::string("objects.") + pool + ".shape.cells", "4096"));
    const Status set = setParam(*scene, "objects.e.shape.cells", "4096");
    ASSERT_FALSE(set);
    EXPECT_EQ(set.error().message, "objects.e" + why);
}

TEST(LoadShapes, AMeshWithItsOwnMaterialIsOneObject) {
    const Result<Scene> scene = test::load(withMesh(twoMaterials()),
                                           objectOf(kMesh + R"(, "flatNormals": true)", R"("material": {})"));
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->objects.size(), 1u);
    const auto& shape = std::get<MeshShape>(scene->objects[0].shape);
    EXPECT_EQ(shape.source, "m.glb");
    EXPECT_EQ(shape.part, "");
    EXPECT_TRUE(shape.flatNormals);
    EXPECT_EQ(shape.mesh->indices.size(), 6u);
    EXPECT_FALSE(scene->objects[0].material.isRefractive());
}

TEST(LoadShapes, MissingNormalsAreThoseOfTheTriangles) {
    const Result<Scene> scene =
        test::load(withMesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}}), objectOf(kMesh));
    ASSERT_TRUE(scene) << scene.error().message;
    const Mesh& mesh = *std::get<MeshShape>(scene->objects[0].shape).mesh;
    EXPECT_EQ(mesh.normals, (std::vector<vec3>(3, vec3(0, 0, 1))));
}

TEST(LoadShapes, TheMaterialsOfAFileMakeAnObjectEach) {
    const Files files = withMesh(twoMaterials());
    const Result<Scene> scene =
        test::load(files, objectOf(kMesh, R"("transform": { "translate": [1, 2, 3] }, "visible": false)"));
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->objects.size(), 2u);
    const Object &glass = scene->objects[0], &paint = scene->objects[1];
    EXPECT_EQ(glass.name, "ball/Glass-001"); // dots would cut its path
    EXPECT_EQ(paint.name, "ball/Paint");
    EXPECT_EQ(std::get<MeshShape>(glass.shape).part, "Glass.001");
    EXPECT_EQ(std::get<MeshShape>(glass.shape).mesh->indices.size(), 3u);
    EXPECT_EQ(glass.material.clear().ior, 1.33f);
    EXPECT_EQ(glass.material.clear().absorption, vec3(0, 7, 14));
    EXPECT_EQ(paint.material.diffuse, vec3(0.9f, 0.1f, 0.1f));
    for (const Object& object : scene->objects) {
        EXPECT_EQ(object.transform.translate, vec3(1, 2, 3));
        EXPECT_FALSE(object.visible);
    }
}

TEST(LoadShapes, TheMaterialsOfAFileAreWrittenAndLoadBack) {
    const Files files = withMesh(twoMaterials());
    Result<Scene> scene = test::load(files, objectOf(kMesh));
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_TRUE(setParam(*scene, "objects.ball/Glass-001.material.ior", "1.7"));
    const Result<Scene> back = test::load(files, toJson(*scene));
    ASSERT_TRUE(back) << back.error().message << toJson(*scene);
    ASSERT_EQ(back->objects.size(), 2u);
    EXPECT_EQ(toJson(*back), toJson(*scene));
    EXPECT_EQ(back->objects[0].material.clear().ior, 1.7f);
    EXPECT_EQ(back->objects[0].material.clear().absorption, scene->objects[0].material.clear().absorption);
    const Mesh &before = *std::get<MeshShape>(scene->objects[1].shape).mesh,
               &after = *std::get<MeshShape>(back->objects[1].shape).mesh;
    EXPECT_EQ(after.positions, before.positions);
    EXPECT_EQ(after.normals, before.normals);
    EXPECT_EQ(after.indices, before.indices);
}

TEST(LoadShapes, APartKeepsTheMaterialOfTheFileUnlessItHasOne) {
    const Files files = withMesh(twoMaterials());
    const std::string part = kMesh + R"(, "part": "Paint")";
    const Result<Scene> own = test::load(files, objectOf(part));
    ASSERT_TRUE(own) << own.error().message;
    ASSERT_EQ(own->objects.size(), 1u);
    EXPECT_EQ(own->objects[0].name, "ball");
    EXPECT_EQ(own->objects[0].material.diffuse, vec3(0.9f, 0.1f, 0.1f));
    const Result<Scene> given = test::load(files, objectOf(part, R"("material": { "base": [1, 1, 1] })"));
    ASSERT_TRUE(given) << given.error().message;
    EXPECT_EQ(given->objects[0].material.diffuse, Material().diffuse);
    EXPECT_EQ(std::get<MeshShape>(given->objects[0].shape).mesh->indices.size(), 3u);
}

TEST(LoadShapes, AMeshThatSeveralObjectsNameIsReadOnce) {
    const Result<Scene> scene = test::load(
        withMesh(twoMaterials()), "{ \"lucent\": 1, \"objects\": [ { \"name\": \"a\", \"shape\": { " + kMesh +
                                      " } }, { \"name\": \"b\", \"shape\": { " + kMesh + " } } ] }");
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->objects.size(), 4u);
    EXPECT_EQ(std::get<MeshShape>(scene->objects[0].shape).mesh,
              std::get<MeshShape>(scene->objects[2].shape).mesh);
}

TEST(LoadShapes, WrongMeshesAreRefused) {
    const Files files = withMesh(twoMaterials());
    EXPECT_EQ(messageOf(objectOf(R"("type": "mesh")")),
              "scenes/a.json:2: objects.ball.shape.source is missing; must be the name of a file");
    EXPECT_EQ(messageOf(objectOf(R"("type": "mesh", "source": "none.glb")")),
              "scenes/a.json:2: objects.ball.shape.source: scenes/none.glb: cannot be read (no such file)");
    EXPECT_EQ(messageOf(objectOf(kMesh + R"(, "part": "Glas")"), files),
              "scenes/a.json:2: objects.ball.shape.part is \"Glas\", no material of the file; the nearest is "
              "\"Glass.001\"");
    Mesh plain = twoMaterials();
    plain.parts.clear();
    EXPECT_EQ(messageOf(objectOf(kMesh + R"(, "part": "Glass")"), withMesh(plain)),
              "scenes/a.json:2: objects.ball.shape.part is \"Glass\", but the file has no materials; must be "
              "left out");
    Mesh black = twoMaterials();
    black.parts[0].values.clear().absorption = vec3(-1);
    EXPECT_EQ(messageOf(objectOf(kMesh), withMesh(black)),
              "scenes/a.json:1: objects.ball.shape.source: material \"Glass.001\": absorption is -1 -1 -1; "
              "must be in [0, 1e+09]");
    EXPECT_EQ(messageOf(objectOf(kMesh, R"("material": { "transmission": 1 })"), withMesh(black)),
              "no error");
    Mesh twins = twoMaterials();
    twins.parts[0].material = "Paint-1";
    twins.parts[1].material = "Paint.1";
    EXPECT_EQ(messageOf(objectOf(kMesh), withMesh(twins)),
              "scenes/a.json:1: objects.0.name is \"ball/Paint-1\", as another object's; must be unique");
}

TEST(LoadShapes, AGlassBallOverAFloorUnderASpotIsRead) {
    const std::string json = R"({ "lucent": 1, "title": "Glass ball", "size": [640, 480],
        "camera": { "type": "perspective", "eye": [0, 2, 5], "target": [0, 0.5, 0], "fov": 35 },
        "view": { "time": 1.5 },
        "environment": { "source": "rainbow", "rotation": [0, 30, 0] },
        "lights": [ { "type": "spot", "position": [1, 4, 1], "direction": [-1, -4, -1], "intensity": 40,
                      "innerAngle": 18, "outerAngle": 22 } ],
        "objects": [
          { "name": "floor", "shape": { "type": "plane", "size": [6, 6] }, "material": { "diffuse": "#c8c0b4" } },
          { "name": "ball", "shape": { "type": "sphere", "radius": 0.5 },
            "material": { "transmission": 1, "ior": 1.5, "absorption": [0.2, 0.1, 0.4], "dispersion": 0.31 },
            "transform": { "translate": [0, 0.8, 0] } } ] })";
    const Result<Scene> scene = test::load({}, json);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->view.time, 1.5f);
    EXPECT_FALSE(scene->objects[0].material.isRefractive());
    EXPECT_NEAR(scene->objects[0].material.diffuse.x, 0.577580, 1e-5); // ((200/255 + 0.055) / 1.055)^2.4
    EXPECT_TRUE(scene->objects[1].material.isRefractive());
    EXPECT_EQ(scene->objects[1].material.clear().dispersion, 0.31f);
    EXPECT_EQ(toJson(*test::load({}, toJson(*scene))), toJson(*scene));
    const auto bytes = std::as_bytes(std::span(json.data(), json.size()));
    EXPECT_TRUE(dependencies("a.json", bytes)->empty());
}

} // namespace
} // namespace lucent::scene
