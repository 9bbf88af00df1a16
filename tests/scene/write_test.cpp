#include "base/Pfm.h"
#include "scene/Json.h"
#include "scene/Keys.h"
#include "scene/Load.h"
#include "scene/Mesh.h"
#include "tests/scene/Files.h"

#include <gtest/gtest.h>

#include <set>

namespace lucent::scene {
namespace {

Result<Json> parse(std::string_view text) {
    return parseJson(std::as_bytes(std::span(text.data(), text.size())), "text");
}

// What makes a material clear, translucent or a mirror, and others act or not.
bool decidesWhatActs(const BoundParam& bound) {
    const std::string_view id = bound.param->id;
    return id == "kind" || id == "transmission" || id == "reflectance" || id == "scattering";
}

// Moves every other parameter away from its default, within its range.
void changeEverything(Scene& scene) {
    int number = 0;
    for (const BoundParam& bound : bindParams(scene)) {
        if (decidesWhatActs(bound)) continue;
        const double start =
            0.05 + 0.06 * (number++ % 10); // neighbours differ: the eye must not be the target
        for (int i = 0; i < componentCount(bound.param->kind); ++i) {
            const double value = getComponent(*bound.param, bound.data, i);
            double other = bound.param->low + (bound.param->high - bound.param->low) * (start + 0.1 * i);
            if (bound.param->kind == Kind::Toggle) other = 1 - value;
            if (bound.param->kind == Kind::Choice) other = value == 0;
            if (bound.param->kind == Kind::Integer) other = value + 1;
            setComponent(*bound.param, bound.data, i, other);
        }
    }
}

TEST(ToJson, LoadsBackToTheSameValues) {
    test::Files files;
    files.put("scenes/c.png", Image(1, 1, 3));
    files.put("scenes/a.png", Image(1, 1, 1));
    const std::string shape = R"("shape": { "type": "heightfield", "heights": "h.pfm", "alpha": "a.png" })";
    Result<Scene> scene =
        test::load(files, R"({ "lucent": 1, "title": "A \"b\"\n", "caption": "c", "size": [30, 20],
        "environment": { "source": "sky" }, "quality": { "maxError": 0.1 },
        "lights": [ { "type": "point" }, { "type": "distant" } ], "objects": [
        { "name": "one", "visible": false, "material": { "diffuseMap": "c.png" }, )" +
                              shape + " }, { " + shape + " } ] }");
    ASSERT_TRUE(scene) << scene.error().message;
    changeEverything(*scene);
    scene->camera.fov = 25; // bound only now that the camera is a perspective one
    const Result<Scene> back = test::load(files, toJson(*scene));
    ASSERT_TRUE(back) << back.error().message << "\n" << toJson(*scene);
    Scene copy = *back;
    const std::vector<BoundParam> a = bindParams(*scene), b = bindParams(copy);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(getText(*a[i].param, a[i].data), getText(*b[i].param, b[i].data)) << a[i].path;
        if (a[i].isComputed()) continue;
        EXPECT_NE(getText(*a[i].param, a[i].data), getText(*a[i].param, a[i].defaults)) << a[i].path;
    }
    EXPECT_EQ(toJson(copy), toJson(*scene)); // names, files, sizes and flags as well
    EXPECT_EQ(copy.title, "A \"b\"\n");
    EXPECT_EQ(copy.size, ivec2(30, 20));
    EXPECT_EQ(copy.quality.maxError, scene->quality.maxError);
    EXPECT_FALSE(copy.objects[0].visible);
    EXPECT_EQ(copy.objects[0].material.diffuseMapFile, "c.png");
}

TEST(Write, AProjectorKeepsItsPictureAndNobodyElseHasOne) {
    test::Files files;
    files.content["scenes/p.pfm"] = encodePfm(Image(2, 1, 3));
    const auto load = [&](const std::string& light) {
        return test::load(files, R"({ "lucent": 1, "lights": [ )" + light +
                                     R"( ], "objects": [ { "shape": { "type": "plane" } } ] })");
    };
    const Result<Scene> scene = load(R"({ "type": "spot", "image": "p.pfm", "fov": 30, "roll": -20 })");
    ASSERT_TRUE(scene) << scene.error().message;
    const Result<Scene> back = test::load(files, toJson(*scene));
    ASSERT_TRUE(back) << back.error().message;
    const auto& lamp = std::get<SpotLight>(back->lights[0]);
    EXPECT_EQ(lamp.fov, 30);
    EXPECT_EQ(lamp.roll, -20);
    EXPECT_EQ(lamp.imageFile, "p.pfm");
    ASSERT_TRUE(lamp.image);
    EXPECT_EQ(lamp.image->size(), ivec2(2, 1));
    const std::string text = toJson(*scene);
    EXPECT_EQ(*dependencies("scenes/s.json", std::as_bytes(std::span(text))),
              std::vector<std::string>{"scenes/p.pfm"});
    const Result<Scene> bare = load(R"({ "type": "spot", "fov": 30 })");
    ASSERT_FALSE(bare);
    EXPECT_NE(bare.error().message.find("fov does nothing without a picture; must stand beside image"),
              std::string::npos)
        << bare.error().message;
    Scene plain = *load(R"({ "type": "spot" })");
    EXPECT_EQ(toJson(plain).find("fov"), toJson(plain).rfind("fov")); // the camera's alone, or none
    EXPECT_FALSE(setParam(plain, "lights.0.roll", "5"));
}

TEST(ToJson, LoadsBackEveryShapeLightAndKindOfMaterial) {
    test::Files files;
    files.content["scenes/m"] = encodeMesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}});
    Result<Scene> scene = test::load(files, R"({ "lucent": 1,
        "lights": [ { "type": "spot" }, { "type": "area" } ], "objects": [
        { "name": "mesh", "shape": { "type": "mesh", "source": "m" } },
        { "name": "floor", "shape": { "type": "plane" } },
        { "name": "block", "shape": { "type": "box" }, "material": { "transmission": 0.5 } },
        { "name": "ball", "shape": { "type": "sphere" }, "material": { "reflectance": [0.5, 0.6, 0.7] } },
        { "name": "ring", "shape": { "type": "torus" } },
        { "name": "can", "shape": { "type": "cylinder" }, "material": { "preset": "ketchup",
            "layers": [ { "preset": "skin1" }, { "thickness": 0.002 } ] } },
        { "name": "pool", "shape": { "type": "water" }, "material": { "transmission": 1 } } ] })");
    ASSERT_TRUE(scene) << scene.error().message;
    changeEverything(*scene);
    std::get<Torus>(scene->objects[4].shape) = {.major = 0.75f, .minor = 0.5f};
    std::get<SpotLight>(scene->lights[0]).innerAngle = 5;
    std::get<SpotLight>(scene->lights[0]).outerAngle = 15;
    scene->camera.fov = 25; // bound only now that the camera is a perspective one
    const Result<Scene> back = test::load(files, toJson(*scene));
    ASSERT_TRUE(back) << back.error().message << "\n" << toJson(*scene);
    Scene copy = *back;
    const std::vector<BoundParam> a = bindParams(*scene), b = bindParams(copy);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].path, b[i].path);
        EXPECT_EQ(getText(*a[i].param, a[i].data), getText(*b[i].param, b[i].data)) << a[i].path;
        if (decidesWhatActs(a[i]) || a[i].isComputed()) continue;
        EXPECT_NE(getText(*a[i].param, a[i].data), getText(*a[i].param, a[i].defaults)) << a[i].path;
    }
    EXPECT_EQ(toJson(copy), toJson(*scene));
}

TEST(ToJson, WritesNothingThatWouldBeRefused) {
    Result<Scene> scene = test::load({}, R"({ "lucent": 1, "objects": [ { "name": "ball",
        "shape": { "type": "sphere" }, "material": { "diffuse": [1, 0, 0] } } ] })");
    ASSERT_TRUE(scene) << scene.error().message;
    // As a person does it: clear, absorbing, then opaque again.
    Object& ball = scene->objects[0];
    ASSERT_TRUE(setParam(*scene, "objects.ball.material.transmission", "1"));
    ASSERT_TRUE(setParam(*scene, "objects.ball.material.attenuationDistance", "2"));
    ASSERT_TRUE(setParam(*scene, "objects.ball.material.attenuationColor", "0.5 0.5 0.5"));
    const Result<Scene> clear = test::load({}, toJson(*scene));
    ASSERT_TRUE(clear) << clear.error().message;
    EXPECT_EQ(clear->objects[0].material.clear().absorption, ball.material.clear().absorption);
    ASSERT_TRUE(setParam(*scene, "objects.ball.material.kind", "matt"));
    const Result<Scene> opaque = test::load({}, toJson(*scene));
    ASSERT_TRUE(opaque) << opaque.error().message;
    EXPECT_EQ(opaque->objects[0].material.diffuse, vec3(1, 0, 0));
}

TEST(ToJson, KeepsTheSourceOfMeshAndNormalHeights) {
    test::Files files;
    Image up(2, 2, 3);
    for (std::size_t i = 0; i < up.pixels.size(); ++i)
        up.pixels[i] = i % 3 == 2 ? 1.0f : 0.5f;
    files.put("scenes/n.pfm", up);
    files.content["scenes/m"] = encodeMesh({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}});
    const Result<Scene> scene = test::load(files, R"({ "lucent": 1, "objects": [
        { "shape": { "type": "heightfield", "normalMap": "n.pfm" } },
        { "shape": { "type": "heightfield", "mesh": "m", "resolution": [6, 4], "meshRotate": [1, 2, 3], "margin": 0.1,
                     "floorGap": 0.3 } } ] })");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->objects[0].field().heightScale, 0); // a flat map
    const Result<Scene> back = test::load(files, toJson(*scene));
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->objects[0].field().heightScale, 0);
    EXPECT_EQ(back->objects[1].field().source.meshRotate, vec3(1, 2, 3));
    EXPECT_EQ(back->objects[1].field().source.floorGap, 0.3f);
    EXPECT_EQ(back->objects[1].field().heights->pixels, scene->objects[1].field().heights->pixels);
}

TEST(JsonSchema, IsJsonAndListsEveryKey) {
    const Result<Json> schema = parse(jsonSchema(test::kTechniques));
    ASSERT_TRUE(schema) << schema.error().message;
    const auto listed = [](const Json* place, const KeySet& keys) {
        ASSERT_TRUE(place);
        const Json* properties = place->find("properties");
        ASSERT_TRUE(properties);
        const std::vector<std::string_view> ids = keys.ids(); // kinds of a material share some
        for (const std::string_view id : ids)
            EXPECT_TRUE(properties->find(id)) << id;
        EXPECT_EQ(properties->keys.size(), std::set<std::string_view>(ids.begin(), ids.end()).size());
        EXPECT_FALSE(place->find("additionalProperties")->boolean);
    };
    const Json& properties = *schema->find("properties");
    const Json* objects = properties.find("objects")->find("items");
    const Json* lights = properties.find("lights")->find("items")->find("oneOf");
    listed(&*schema, sceneKeys());
    listed(properties.find("camera"), cameraKeys());
    listed(properties.find("view"), viewKeys());
    listed(properties.find("environment"), environmentKeys());
    listed(properties.find("quality"), qualityKeys());
    const Json* shapes = objects->find("properties")->find("shape")->find("oneOf");
    ASSERT_EQ(lights->items.size(), lightTypes().size());
    ASSERT_EQ(shapes->items.size(), shapeTypes().size());
    for (std::size_t i = 0; i < lights->items.size(); ++i)
        listed(&lights->items[i], lightTypes()[i].keys);
    for (std::size_t i = 0; i < shapes->items.size(); ++i)
        listed(&shapes->items[i], shapeTypes()[i].keys);
    listed(objects, objectKeys());
    listed(objects->find("properties")->find("wave"), waveKeys());
    listed(objects->find("properties")->find("material"), materialKeys());
    listed(objects->find("properties")->find("transform"), transformKeys());
    const KeySet demo{{&test::demoParams()}, {}};
    listed(properties.find("technique")->find("properties")->find("demo"), demo);
}

TEST(JsonSchema, CarriesTheRangesOfTheTables) {
    const Result<Json> schema = parse(jsonSchema(test::kTechniques));
    const Json* object = schema->find("properties")->find("objects")->find("items")->find("properties");
    const Json* depth = object->find("material")->find("properties")->find("depth");
    EXPECT_EQ(depth->find("exclusiveMinimum")->number, 0);
    EXPECT_EQ(depth->find("maximum")->number, 1000);
    EXPECT_TRUE(depth->find("description")->string.ends_with(" [m]"));
    const Json* absorption = object->find("material")->find("properties")->find("absorption")->find("anyOf");
    EXPECT_EQ(absorption->items[0].find("minimum")->number, 0);
    EXPECT_EQ(absorption->items[1].find("items")->find("maximum")->number, 1e9);
    const std::vector<Json>& shapes = object->find("shape")->find("oneOf")->items;
    EXPECT_EQ(shapes[0].find("oneOf")->items.size(), 3u); // sources of heights
    EXPECT_EQ(shapes[1].find("required")->items[1].string, "source");
    EXPECT_EQ(shapes[2].find("properties")->find("type")->find("const")->string, "plane");
    EXPECT_EQ(shapes[2].find("properties")->find("size")->find("maxItems")->number, 2);
    EXPECT_EQ(object->find("wave")->find("required")->items[0].string, "amplitude");
    const Json* method = schema->find("properties")->find("technique")->find("properties")->find("demo");
    EXPECT_EQ(method->find("properties")->find("method")->find("enum")->items[1].string, "fancy");
}

} // namespace
} // namespace lucent::scene
