#include "scene/Load.h"
#include "scene/Painting.h"
#include "tests/base/Png.h"
#include "tests/scene/Files.h"

#include "scene/Mesh.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace lucent::scene {
namespace {

using test::Files;

// The object's members around a small field, on line 3; `more` follows its name.
std::string around(const std::string& more, const std::string& shape = R"("heights": "h.pfm")") {
    return "{ \"lucent\": 1,\n  \"objects\": [\n{ \"name\": \"coin\", \"shape\": { \"type\": "
           "\"heightfield\",\n" +
           shape + " }" + (more.empty() ? "" : ",\n" + more) + " } ] }";
}
// The scene's members, on line 2.
std::string beside(const std::string& more) {
    return "{ \"lucent\": 1,\n" + more +
           ",\n\"objects\": [ { \"name\": \"coin\", \"shape\": { \"type\": \"heightfield\", \"heights\": "
           "\"h.pfm\" } } ] }";
}

std::string messageOf(const std::string& json, const Files& files = {}) {
    const Result<Scene> scene = test::load(files, json);
    return scene ? "no error" : scene.error().message;
}

TEST(Load, SceneOfTheSpecificationIsRead) {
    Files files;
    files.put("scenes/coin.png", test::smallHeights());
    files.put("scenes/coin-alpha.png", Image(1, 1, 1));
    const Result<Scene> scene =
        test::load(files, R"({ "lucent": 1, "title": "Coin under a lamp", "size": [640, 480],
        "camera": { "type": "orthographic", "eye": [0,0,2], "target": [0,0,0], "up": [0,1,0], "height": 1.5 },
        "environment": { "source": "rainbow", "rotation": [0, 30, 0], "intensity": 1 },
        "lights": [ { "type": "point", "position": [0.3,0.4,0.6], "color": "#ffffff", "intensity": 2 },
                    { "type": "distant", "direction": [0,0,-1], "irradiance": 0.5 } ],
        "objects": [ { "name": "coin",
            "shape": { "type": "heightfield", "heights": "coin.png", "heightScale": 0.12, "alpha": "coin-alpha.png" },
            "material": { "base": [0,0,0], "diffuse": [0.8,0.7,0.4], "specular": [1,1,1], "specularity": 0.3,
                          "forwardScatter": 0.0, "depth": 0.05, "scatterFalloff": [0.2, 0.6] },
            "transform": { "translate": [1,0,0], "rotate": [0,0,0], "scale": 2 }, "visible": false } ],
        "technique": { "demo": { "method": "plain" } },
        "quality": { "maxError": 0.01 } })");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->title, "Coin under a lamp");
    EXPECT_EQ(scene->size, ivec2(640, 480));
    EXPECT_EQ(scene->camera.height, 1.5f);
    EXPECT_EQ(scene->environment->source, "rainbow");
    EXPECT_EQ(scene->environment->rotation, vec3(0, 30, 0));
    EXPECT_EQ(scene->environment->map->channels, 3);
    EXPECT_EQ(std::get<PointLight>(scene->lights[0]).intensity, 2);
    EXPECT_EQ(std::get<DistantLight>(scene->lights[1]).irradiance, 0.5f);
    const Object& coin = scene->objects[0];
    EXPECT_EQ(coin.name, "coin");
    EXPECT_EQ(coin.field().heightScale, 0.12f);
    EXPECT_EQ(coin.field().texels(), ivec2(4, 2));
    EXPECT_NEAR(*coin.field().heights->at(3, 1), 223 / 255.0, 1e-6); // 7/8 in 8 bits
    EXPECT_EQ(coin.field().alpha->channels, 1);
    EXPECT_EQ(coin.material.diffuse, vec3(0.8f, 0.7f, 0.4f));
    EXPECT_EQ(coin.material.relief().scatterFalloff, vec2(0.2f, 0.6f));
    EXPECT_EQ(coin.transform.scale, 2);
    EXPECT_FALSE(coin.visible);
    EXPECT_EQ(scene->technique.at("demo").as<test::Demo>().method, test::Method::Plain);
    EXPECT_EQ(scene->technique.at("demo").as<test::Demo>().steps, 64);
    EXPECT_EQ(scene->quality.maxError, 0.01f);
}

// With no time at all one file is decoded each time (heights and colours in four pieces), and each once,
// whoever names it; the whole comes by itself.
TEST(Load, GoesOnWhereItWasInterrupted) {
    Files files;
    files.put("h.pfm", test::smallHeights());
    files.put("colors.pfm", Image(2, 2, 3));
    const std::string coin = R"("shape": { "type": "heightfield", "heights": "h.pfm" },
                                "material": { "diffuseMap": "colors.pfm" } })";
    files.put("scene.json", "{ \"lucent\": 1, \"objects\": [ { \"name\": \"a\", " + coin +
                                ", { \"name\": \"b\", " + coin + " ] }");
    std::map<std::string, int> reads;
    const ReadFile read = [&](const std::string& path) {
        ++reads[path];
        return files.reader()(path);
    };
    Loading loading("scene.json", read, {});
    std::optional<Result<Scene>> scene;
    int steps = 0;
    for (; !scene && steps < 20; ++steps)
        scene = loading.advance(0);
    ASSERT_TRUE(scene && *scene) << (scene ? scene->error().message : "does not end");
    EXPECT_EQ(steps, 10); // the tree, and what it names
    EXPECT_EQ(reads["h.pfm"], 1);
    EXPECT_EQ(reads["scene.json"], 1);
    EXPECT_EQ(reads["colors.pfm"], 1);
    EXPECT_EQ((*scene)->objects[0].material.diffuseMap, (*scene)->objects[1].material.diffuseMap);
}

// The atlas and its texels come piece by piece, then each stroke, and paint the same bits.
TEST(Load, PaintsStrokeByStroke) {
    Files files;
    files.put("scene.json", R"({ "lucent": 1, "objects": [ { "name": "a", "shape": { "type": "plane" },
        "material": { "scattering": 100, "absorption": 1 },
        "paint": { "side": 32, "strokes": [
            { "brush": "translucency", "value": 0.5, "fill": { "low": [-1, -1, -1], "high": [0, 1, 1] } },
            { "brush": "glow", "value": [1, 0.5, 0], "radius": 0.3,
              "dabs": [ [0, 0, 0, 0, 1, 0, 1] ] } ] } } ] })");
    const ReadFile read = files.reader();
    const Result<Scene> atOnce = load("scene.json", read, {});
    ASSERT_TRUE(atOnce) << atOnce.error().message;
    Loading loading("scene.json", read, {});
    std::optional<Result<Scene>> scene;
    int steps = 0;
    for (; !scene && steps < 100; ++steps)
        scene = loading.advance(0);
    ASSERT_TRUE(scene && *scene) << (scene ? scene->error().message : "does not end");
    EXPECT_GE(steps, 20); // eighths of texels and of their places, two strokes
    const Painting &whole = *atOnce->objects[0].painting, &pieces = *(*scene)->objects[0].painting;
    EXPECT_EQ(pieces.entering->pixels, whole.entering->pixels);
    EXPECT_EQ(pieces.leaving->pixels, whole.leaving->pixels);
    EXPECT_NE(pieces.leaving->pixels, std::vector<float>(32 * 32 * 4, 1.0f));
    EXPECT_EQ(pieces.strokes.size(), 2u);
}

TEST(Load, OnlyObjectsAreRequired) {
    const Result<Scene> scene = test::load(
        {}, R"({ "lucent": 1, "objects": [ { "shape": { "type": "heightfield", "heights": "h.pfm" } } ] })");
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->objects[0].name, "0");
    EXPECT_FALSE(scene->environment);
    EXPECT_TRUE(scene->lights.empty());
    EXPECT_EQ(scene->technique.at("demo").as<test::Demo>().method, test::Method::Fancy);
}

TEST(Load, UnknownKeysAreRefusedWithTheNearestKnownOne) {
    EXPECT_EQ(messageOf(beside(R"("lihgts": [])")),
              "scenes/a.json:2: lihgts is an unknown key; the nearest is \"lights\"");
    EXPECT_EQ(messageOf(around(R"("material": { "specularty": 1 })")),
              "scenes/a.json:5: objects.coin.material.specularty is an unknown key; the nearest is "
              "\"specularity\"");
    EXPECT_EQ(messageOf(around(R"("material": { "sigmaSPrime": 1 })")),
              "scenes/a.json:5: objects.coin.material.sigmaSPrime is an unknown key; the nearest is "
              "\"scattering\"");
    EXPECT_EQ(
        messageOf(around("", R"("heights": "h.pfm", "heightscale": 1)")),
        "scenes/a.json:4: objects.coin.shape.heightscale is an unknown key; the nearest is \"heightScale\"");
    EXPECT_EQ(messageOf(beside(R"("technique": { "dmo": {} })")),
              "scenes/a.json:2: technique.dmo is an unknown technique; the nearest is \"demo\"");
    EXPECT_EQ(messageOf(beside(R"("technique": { "demo": { "step": 3 } })")),
              "scenes/a.json:2: technique.demo.step is an unknown key; the nearest is \"steps\"");
    EXPECT_EQ(messageOf(beside(R"("lights": [ { "type": "point", "itensity": 3 } ])")),
              "scenes/a.json:2: lights.0.itensity is an unknown key; the nearest is \"intensity\"");
}

TEST(Load, WrongTypesSayWhatWasExpected) {
    EXPECT_EQ(messageOf("[1]"), "scenes/a.json:1: the scene is a list; must be an object");
    EXPECT_EQ(messageOf(beside(R"("title": 3)")), "scenes/a.json:2: title is 3; must be text");
    EXPECT_EQ(messageOf(beside(R"("camera": [])")), "scenes/a.json:2: camera is a list; must be an object");
    EXPECT_EQ(messageOf(beside(R"("camera": { "height": "1" })")),
              "scenes/a.json:2: camera.height is \"1\"; must be a number");
    EXPECT_EQ(messageOf(beside(R"("camera": { "eye": [1, 2] })")),
              "scenes/a.json:2: camera.eye is a list; must be a list of 3 numbers");
    EXPECT_EQ(
        messageOf(around(R"("material": { "diffuse": 1 })")),
        "scenes/a.json:5: objects.coin.material.diffuse is 1; must be a list of 3 numbers or \"#rrggbb\"");
    EXPECT_EQ(messageOf(around(R"("material": { "diffuse": "red" })")),
              "scenes/a.json:5: objects.coin.material.diffuse is \"red\"; must be 3 numbers or #rrggbb");
    EXPECT_EQ(messageOf(around(R"("visible": 1)")),
              "scenes/a.json:5: objects.coin.visible is 1; must be true or false");
    EXPECT_EQ(messageOf(beside(R"("technique": { "demo": { "steps": 2.5 } })")),
              "scenes/a.json:2: technique.demo.steps is \"2.5\"; must be an integer");
    EXPECT_EQ(messageOf(beside(R"("technique": { "demo": { "method": "best" } })")),
              "scenes/a.json:2: technique.demo.method is \"best\"; must be plain or fancy");
    EXPECT_EQ(messageOf(beside(R"("size": [640, 0])")),
              "scenes/a.json:2: size is [640, 0]; must be two integers in [1, 8192]");
    EXPECT_EQ(messageOf(beside(R"("quality": { "maxError": -1 })")),
              "scenes/a.json:2: quality.maxError is -1; must be in [0, 1]");
    EXPECT_EQ(messageOf(around(R"("material": { "baseMap": "" })")),
              "scenes/a.json:5: objects.coin.material.baseMap is \"\"; must be the name of a file");
}

TEST(Load, ValuesOutOfRangeSayTheRange) {
    EXPECT_EQ(messageOf(around(R"("material": { "depth": -0.8 })")),
              "scenes/a.json:5: objects.coin.material.depth is -0.8; must be in (0, 1000]");
    EXPECT_EQ(messageOf(around(R"("material": { "specularFalloff": [0.8, 0.2] })")),
              "scenes/a.json:5: objects.coin.material.specularFalloff is 0.8 0.2; the first must not be "
              "above the second");
    EXPECT_EQ(messageOf(around(R"("transform": { "scale": 0 })")),
              "scenes/a.json:5: objects.coin.transform.scale is 0; must be in (0, 1000000]");
    EXPECT_EQ(messageOf(around("", R"("heights": "h.pfm", "heightScale": 1e6)")),
              "scenes/a.json:4: objects.coin.shape.heightScale is 1000000; must be in [0, 100000]");
    EXPECT_EQ(messageOf(beside(R"("view": { "exposure": 31 })")),
              "scenes/a.json:2: view.exposure is 31; must be in [-30, 30]");
    EXPECT_EQ(messageOf(beside(R"("lights": [ { "type": "point", "intensity": -1 } ])")),
              "scenes/a.json:2: lights.0.intensity is -1; must be at least 0");
}

TEST(Load, WhatIsMissingIsNamed) {
    EXPECT_EQ(messageOf("{}"), "scenes/a.json:1: lucent is missing; must be 1");
    EXPECT_EQ(messageOf(R"({ "lucent": 2 })"), "scenes/a.json:1: lucent is 2; must be 1");
    EXPECT_EQ(messageOf(R"({ "lucent": 1 })"),
              "scenes/a.json:1: objects is missing; must be a list of at least one object");
    EXPECT_EQ(messageOf(R"({ "lucent": 1, "objects": [] })"),
              "scenes/a.json:1: objects is empty; must hold at least one object");
    EXPECT_EQ(messageOf(R"({ "lucent": 1, "objects": [ {} ] })"),
              "scenes/a.json:1: objects.0.shape is missing; must be an object");
    EXPECT_EQ(
        messageOf(R"({ "lucent": 1, "objects": [ { "shape": {} } ] })"),
        "scenes/a.json:1: objects.0.shape.type is missing; must be heightfield, mesh, plane, box, sphere, "
        "torus, cylinder or water");
    EXPECT_EQ(messageOf(beside(R"("lights": [ {} ])")),
              "scenes/a.json:2: lights.0.type is missing; must be point, distant, spot or area");
}

TEST(Load, WhatIsNotBuiltIsRefusedWithWhatExists) {
    EXPECT_EQ(messageOf(beside(R"("lights": [ { "type": "tube", "length": 3 } ])")),
              "scenes/a.json:2: lights.0.type is \"tube\"; must be point, distant, spot or area");
    EXPECT_EQ(messageOf(R"({ "lucent": 1, "objects": [ { "shape": { "type": "cone", "radius": 1 } } ] })"),
              "scenes/a.json:1: objects.0.shape.type is \"cone\"; must be heightfield, mesh, plane, box, "
              "sphere, torus, cylinder or water");
}

TEST(Load, NamesOfObjectsAreUniqueAndWithoutDots) {
    const auto named = [](const std::string& a, const std::string& b) {
        const std::string shape = R"("shape": { "type": "heightfield", "heights": "h.pfm" } })";
        return R"({ "lucent": 1, "objects": [ { "name": ")" + a + "\", " + shape + ",\n{ \"name\": \"" + b +
               "\", " + shape + " ] }";
    };
    EXPECT_EQ(messageOf(named("a", "b")), "no error");
    EXPECT_EQ(messageOf(named("a", "a")),
              "scenes/a.json:2: objects.1.name is \"a\", as another object's; must be unique");
    EXPECT_EQ(messageOf(named("a", "b.c")),
              "scenes/a.json:2: objects.1.name is \"b.c\"; must be text without dots");
}

TEST(Load, DirectionsMustHaveALength) {
    EXPECT_EQ(messageOf(beside(R"("lights": [ { "type": "distant", "direction": [0, 0, 0] } ])")),
              "scenes/a.json:2: lights.0.direction is 0 0 0; must have a length");
    EXPECT_EQ(messageOf(beside(R"("camera": { "eye": [0, 0, 0] })")),
              "scenes/a.json:2: camera.target is 0 0 0, the eye; must differ from it");
    EXPECT_EQ(messageOf(beside(R"("camera": { "up": [0, 0, 1] })")),
              "scenes/a.json:2: camera.up is 0 0 1, along the view; must point elsewhere");
}

TEST(Load, HeightsComeFromExactlyOneSource) {
    EXPECT_EQ(
        messageOf(around("", R"("width": 2)")),
        "scenes/a.json:3: objects.coin.shape has no heights; must have one of heights, normalMap, mesh");
    EXPECT_EQ(messageOf(around("", R"("heights": "h.pfm", "mesh": "m.glb")")),
              "scenes/a.json:3: objects.coin.shape has heights and mesh; must have one of heights, "
              "normalMap, mesh");
    EXPECT_EQ(messageOf(around("", R"("heights": "h.pfm", "margin": 0.1)")),
              "scenes/a.json:4: objects.coin.shape.margin is given without a mesh; must stand beside mesh");
}

TEST(Load, FilesAreNamedWhereTheyFail) {
    EXPECT_EQ(messageOf(around("", R"("heights": "none.png")")),
              "scenes/a.json:4: objects.coin.shape.heights: scenes/none.png: cannot be read (no such file)");
    Files files;
    files.put("scenes/cut.png", "\x89PNG\r\n\x1a\n");
    files.put("scenes/empty.png", "");
    files.content["scenes/zero.png"] = test::makePng(0, 0, 8, 0, {});
    EXPECT_EQ(messageOf(around("", R"("heights": "cut.png")"), files),
              "scenes/a.json:4: objects.coin.shape.heights: scenes/cut.png: the file ends too early; must be "
              "a whole PNG "
              "file");
    EXPECT_EQ(messageOf(around("", R"("heights": "zero.png")"), files),
              "scenes/a.json:4: objects.coin.shape.heights: scenes/zero.png: is 0 x 0 pixels; must be 1 to "
              "16384 a side "
              "and at most 67 million in all");
    EXPECT_EQ(messageOf(beside(R"("environment": { "source": "empty.png" })"), files),
              "scenes/a.json:2: environment.source: scenes/empty.png: is empty; must be a PNG, JPEG, HDR or "
              "PFM image");
    EXPECT_EQ(messageOf(around(R"("material": { "diffuseMap": "cut.png" })"), files),
              "scenes/a.json:5: objects.coin.material.diffuseMap: scenes/cut.png: the file ends too early; "
              "must be a "
              "whole PNG file");
    EXPECT_EQ(scene::load("x/none.json", files.reader(), {}).error().message,
              "x/none.json: cannot be read (no such file)");
}

TEST(Load, HeightsThatAreNoNumbersAreRefusedWithTheirPlace) {
    Image heights = test::smallHeights();
    heights.at(3, 1)[0] = std::nanf("");
    Files files;
    files.put("scenes/h.pfm", heights);
    EXPECT_EQ(messageOf(around(""), files),
              "scenes/a.json:4: objects.coin.shape.heights: scenes/h.pfm: texel (3, 1) is "
              "nan; heights must be finite, at most 1e9 in size");
    heights.at(2, 0)[0] = -INFINITY;
    files.put("scenes/h.pfm", heights);
    EXPECT_EQ(messageOf(around(""), files),
              "scenes/a.json:4: objects.coin.shape.heights: scenes/h.pfm: texel (2, 0) is "
              "-inf; heights must be finite, at most 1e9 in size");
}

TEST(Load, HeightsAreTheFirstOfOneOrTwoChannelsElseTheMeanOfRgb) {
    Files files;
    files.content["scenes/two.png"] = test::makePng(1, 1, 8, 4, {std::byte(51), std::byte(200)});
    files.content["scenes/four.png"] =
        test::makePng(1, 1, 8, 6, {std::byte(0), std::byte(51), std::byte(102), std::byte(9)});
    EXPECT_EQ(*test::load(files, around("", R"("heights": "two.png")"))->objects[0].field().heights->at(0, 0),
              0.2f);
    EXPECT_NEAR(
        *test::load(files, around("", R"("heights": "four.png")"))->objects[0].field().heights->at(0, 0), 0.2,
        1e-7);
}

TEST(Load, ColourMapsAreDecodedFromSrgbAndHaveThreeChannels) {
    Files files;
    files.content["scenes/c.png"] = test::makePng(1, 1, 8, 4, {std::byte(188), std::byte(200)});
    const Result<Scene> scene = test::load(
        files,
        around(R"("material": { "baseMap": "c.png", "diffuseMap": "c.png", "specularMap": "c.png" })"));
    ASSERT_TRUE(scene) << scene.error().message;
    const Material& material = scene->objects[0].material;
    for (const auto& map : {material.baseMap, material.diffuseMap, material.specularMap}) {
        ASSERT_EQ(map->channels, 3);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(map->at(0, 0)[c], 0.502886, 1e-6); // see image_test
    }
}

TEST(Load, AlphaThatIsNotSolidDigsHoles) {
    Files files;
    Image alpha(2, 1, 1); // the left half of the field is outside
    alpha.pixels = {0, 1};
    files.put("scenes/a.png", alpha);
    const std::string shape = R"("heights": "h.pfm", "heightScale": 0.5, "width": 2, "alpha": "a.png")";
    const Result<Scene> solid = test::load(files, around("", shape));
    ASSERT_TRUE(solid) << solid.error().message;
    EXPECT_EQ(solid->objects[0].field().heights->pixels, test::smallHeights().pixels);
    const Result<Scene> holes = test::load(files, around("", shape + ", \"alphaIsSolid\": false"));
    ASSERT_TRUE(holes) << holes.error().message;
    // The lowest height is 0, the footprint 2 x 1 m: 2 m below are -4 heights of 0.5 m.
    EXPECT_EQ(holes->objects[0].field().heights->pixels,
              (std::vector<float>{-4, -4, 2 / 8.0f, 3 / 8.0f, -4, -4, 6 / 8.0f, 7 / 8.0f}));
}

TEST(Load, NormalMapKeepsItsSlopesUnlessAScaleIsGiven) {
    // n = (-1, 0, 2)/sqrt(5) everywhere: a slope of 1/2 to the right; 5 texels rise 4 * 1/2 = 2 texel widths.
    Image normals(5, 3, 3);
    for (std::size_t i = 0; i < normals.pixels.size(); ++i)
        normals.pixels[i] = 0.5f + 0.5f * std::array{-1 / std::sqrt(5.0f), 0.0f, 2 / std::sqrt(5.0f)}[i % 3];
    Files files;
    files.put("scenes/n.pfm", normals);
    const Result<Scene> scene = test::load(files, around("", R"("normalMap": "n.pfm", "width": 10)"));
    ASSERT_TRUE(scene) << scene.error().message;
    const HeightField& field = scene->objects[0].field();
    EXPECT_NEAR(field.heightScale, 2 * 10 / 5.0, 1e-5); // 2 texels of 2 m
    for (int x = 0; x < 5; ++x)
        EXPECT_NEAR(*field.heights->at(x, 1), x / 4.0, 1e-5);
    EXPECT_EQ(test::load(files, around("", R"("normalMap": "n.pfm", "heightScale": 0.3)"))
                  ->objects[0]
                  .field()
                  .heightScale,
              0.3f);
}

TEST(Load, MeshBecomesItsDepth) {
    Files files;
    const Mesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3}};
    files.content["scenes/m.mesh"] = encodeMesh(square);
    const Result<Scene> scene =
        test::load(files, around("", R"("mesh": "m.mesh", "resolution": [8, 4], "margin": 0.125)"));
    ASSERT_TRUE(scene) << scene.error().message;
    const Image& heights = *scene->objects[0].field().heights;
    EXPECT_EQ(heights.size(), ivec2(8, 4));
    // A margin of one texel leaves 6 x 2 for the square: 2 x 2 texels in the middle.
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x)
            EXPECT_EQ(*heights.at(x, y), (x == 3 || x == 4) && (y == 1 || y == 2) ? 1.0f : 0.0f)
                << x << " " << y;
}

TEST(Load, DependenciesAreAllFilesOnceInTheOrderOfTheFile) {
    const std::string json = R"({ "environment": { "source": "sky" }, "objects": [
        { "material": { "baseMap": "b.png", "diffuseMap": "b.png", "specularMap": "s.png" },
          "shape": { "heights": "h.pfm", "alpha": "/abs/a.png" } },
        { "shape": { "normalMap": "n.png" } }, { "shape": { "mesh": "m/m.glb" } },
        { "shape": { "type": "mesh", "source": "g.gltf" } }, { "shape": { "source": "sky" } } ] })";
    const auto bytes = std::as_bytes(std::span(json.data(), json.size()));
    const Result<std::vector<std::string>> files = dependencies("x/a.json", bytes);
    ASSERT_TRUE(files);
    EXPECT_EQ(*files, (std::vector<std::string>{"x/b.png", "x/s.png", "x/h.pfm", "/abs/a.png", "x/n.png",
                                                "x/m/m.glb", "x/g.gltf", "x/sky"}));
    const std::string probe = R"({ "environment": { "source": "p.hdr" } })";
    EXPECT_EQ(*dependencies("a.json", std::as_bytes(std::span(probe.data(), probe.size()))),
              (std::vector<std::string>{"p.hdr"}));
    const std::string broken = "{";
    EXPECT_EQ(dependencies("a.json", std::as_bytes(std::span(broken.data(), 1))).error().message,
              "a.json:1:1: unexpected end of input; expected string literal");
}

} // namespace
} // namespace lucent::scene
