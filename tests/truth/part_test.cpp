#include "truth/Part.h"

#include "scene/Mesh.h"
#include "tests/truth/fields.h"
#include "truth/Random.h"

#include <gtest/gtest.h>

namespace lucent::truth {
namespace {

Facts someFacts() {
    return {.scene = "a \"scene\".json",
            .fingerprint = "0123456789abcdef",
            .size = {5, 7},
            .aov = "color",
            .estimator = "relief",
            .seed = 4294967295,
            .samples = 256,
            .directions = 4096,
            .exposure = 0.1f};
}

Picture somePicture() {
    Picture picture({5, 7});
    Random random(1, 2, 3);
    for (Image* image : {&picture.values, &picture.errors})
        for (float& value : image->pixels)
            value = float(random.next());
    return picture;
}

/// One tile of a picture, as solving it alone would give.
Part partOf(const Picture& picture, const Tile& tile) {
    Part part{someFacts(), tile, Picture({5, tile.rows(7)})};
    for (int row = 0; row < tile.rows(7); ++row) {
        std::copy_n(picture.values.at(0, tile.row(row)), 5 * 4, part.rows.values.at(0, row));
        std::copy_n(picture.errors.at(0, tile.row(row)), 5 * 3, part.rows.errors.at(0, row));
    }
    return part;
}

struct Tiles {
    std::vector<Part> parts;
    std::vector<std::string> names;
};
Tiles tilesOf(const Picture& picture, int count) {
    Tiles tiles;
    for (int index = count - 1; index >= 0; --index) { // any order will do
        const Bytes bytes = encodePart(partOf(picture, {index, count}));
        Result<Part> part = decodePart(bytes, "part");
        EXPECT_TRUE(part.ok());
        tiles.parts.push_back(*part);
        tiles.names.push_back(std::to_string(index + 1) + ".tile");
    }
    return tiles;
}

std::string refusal(const Tiles& tiles) {
    const auto merged = merge(tiles.parts, tiles.names);
    return merged ? "accepted" : merged.error().message;
}

TEST(Part, TilesThroughFilesAreThePictureBitByBit) {
    const Picture picture = somePicture();
    for (const int count : {1, 2, 3, 7}) {
        const Tiles tiles = tilesOf(picture, count);
        const auto merged = merge(tiles.parts, tiles.names);
        ASSERT_TRUE(merged.ok());
        EXPECT_EQ(merged->values.pixels, picture.values.pixels);
        EXPECT_EQ(merged->errors.pixels, picture.errors.pixels);
        EXPECT_EQ(merged->standardError(), picture.standardError());
        const Facts& facts = tiles.parts[0].facts;
        EXPECT_EQ(facts.scene, "a \"scene\".json");
        EXPECT_EQ(facts.seed, 4294967295u);
        EXPECT_EQ(facts.exposure, 0.1f);
    }
}

TEST(Part, PartsThatDoNotBelongTogetherAreRefused) {
    const Picture picture = somePicture();
    Tiles tiles = tilesOf(picture, 3);
    const auto with = [&](const std::function<void(Part&)>& change) {
        Tiles changed = tiles;
        change(changed.parts[1]);
        return refusal(changed);
    };
    EXPECT_EQ(with([](Part& part) { part.facts.seed = 2; }),
              "2.tile: the seed is 2; must be 4294967295 as in 3.tile");
    EXPECT_EQ(with([](Part& part) { part.facts.fingerprint = "x"; }),
              "2.tile: the scene's fingerprint is x; must be 0123456789abcdef as in 3.tile");
    EXPECT_EQ(with([](Part& part) { part.facts.aov = "d"; }),
              "2.tile: the AOV is d; must be color as in 3.tile");
    EXPECT_EQ(with([](Part& part) {
                  part.facts.size = {7, 5};
              }),
              "2.tile: the size is 7x5; must be 5x7 as in 3.tile");
    EXPECT_EQ(with([](Part& part) { part.facts.estimator = "lambert"; }),
              "2.tile: the estimator is lambert; must be relief as in 3.tile");
    EXPECT_EQ(with([](Part& part) { part.facts.samples = 1; }),
              "2.tile: the number of samples is 1; must be 256 as in 3.tile");
    EXPECT_EQ(with([](Part& part) { part.tile.count = 2; }),
              "2.tile: the number of parts is 2; must be 3 as in 3.tile");
    EXPECT_EQ(with([](Part& part) { part.tile.index = 2; }),
              "2.tile: is part 3 of 3, as 3.tile is; must be given once");
    tiles.parts.resize(1);
    tiles.names.resize(1);
    EXPECT_EQ(refusal(tiles), "3.tile: is part 3 of 3 and these are missing: 1, 2; must be given all 3");
}

TEST(Part, OtherFilesAndBrokenPartsAreRefused) {
    const auto complaint = [](const Bytes& bytes) {
        const auto part = decodePart(bytes, "a.tile");
        return part ? "accepted" : part.error().message;
    };
    const Bytes whole = encodePart(partOf(somePicture(), {0, 2}));
    const std::string size = std::to_string(whole.size());
    EXPECT_EQ(complaint({whole.begin(), whole.end() - 1}),
              "a.tile: has " + std::to_string(whole.size() - 1) + " bytes; must have " + size);
    EXPECT_EQ(complaint({}), "a.tile: is no part of a truth; must be a file that lucent truth --tile wrote");
    EXPECT_EQ(complaint({whole.begin() + 1, whole.end()}),
              "a.tile: is no part of a truth; must be a file that lucent truth --tile wrote");
    EXPECT_EQ(complaint({whole.begin(), whole.begin() + 40}),
              "a.tile: the header of the part is damaged; must be as lucent truth --tile wrote it");
    const auto replaced = [&](const std::string& from, const std::string& to) {
        std::string text(reinterpret_cast<const char*>(whole.data()), whole.size());
        text.replace(text.find(from), from.size(), to);
        const auto bytes = std::as_bytes(std::span(text));
        return Bytes(bytes.begin(), bytes.end());
    };
    // Same length: the number in the first line stays right.
    for (const auto& [from, to] : {std::pair{"\"part\": 1", "\"part\": 9"},
                                   {"\"part\": 1", "\"qart\": 1"},
                                   {"\"seed\": 4294967295", "\"seed\": -294967295"},
                                   {"\"width\": 5", "\"width\": 0"}})
        EXPECT_EQ(complaint(replaced(from, to)),
                  "a.tile: the header of the part is damaged; must be as lucent truth --tile wrote it");
    EXPECT_EQ(
        complaint(replaced("\"seed\": 4294967295", "\"seed\": 4294967294")),
        "a.tile: has another checksum than its first line says; must be as lucent truth --tile wrote it");
}

TEST(Fingerprint, ChangesWithEveryTexelAndParameter) {
    scene::Scene scene;
    scene::Object object;
    object.name = "field";
    object.shape = test::shapeOf(4, 4, 1, 0.1f, [](int, int) { return 0.5f; });
    scene.objects.push_back(object);
    const std::string before = fingerprint(scene);
    EXPECT_EQ(before.size(), 16u);
    EXPECT_EQ(fingerprint(scene), before);
    scene::Scene deeper = scene;
    deeper.objects[0].material.relief().depth += 1e-6f;
    EXPECT_NE(fingerprint(deeper), before);
    scene::Scene bumped = scene;
    bumped.objects[0].shape =
        test::shapeOf(4, 4, 1, 0.1f, [](int x, int y) { return x == 3 && y == 3 ? 0.50001f : 0.5f; });
    EXPECT_NE(fingerprint(bumped), before);
}

TEST(Fingerprint, ChangesWithTheTrianglesOfAMesh) {
    scene::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.indices = {0, 1, 2};
    const auto of = [](const scene::Mesh& mesh) {
        scene::MeshShape shape;
        shape.source = "mesh.glb";
        shape.mesh = std::make_shared<scene::Mesh>(mesh);
        scene::Scene scene;
        scene.objects.resize(1);
        scene.objects[0].shape = shape;
        return fingerprint(scene);
    };
    const std::string before = of(mesh);
    EXPECT_EQ(of(mesh), before);
    mesh.positions[1].x += 1e-6f;
    EXPECT_NE(of(mesh), before);
}

} // namespace
} // namespace lucent::truth
