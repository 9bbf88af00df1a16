#include "tests/scene/Gltf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace lucent::scene {
namespace {

using test::append;
using test::bytesOf;
using test::glb;
using test::gltf;
using test::kNoFiles;
using test::read;
using test::squareBuffer;
using test::squareGlb;

TEST(Gltf, GltfWithAFileBesideItIsReadInAllIndexWidths) {
    const auto check = [](const Bytes& buffer, int indexType) {
        std::string asked, error;
        const ReadFile files = [&](const std::string& path) -> Result<Bytes> {
            asked = path;
            return buffer;
        };
        const Mesh mesh = read(bytesOf(gltf(buffer, indexType)), error, "m/a.gltf", files);
        EXPECT_EQ(error, "");
        EXPECT_EQ(asked, "m/square.bin");
        EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
        ASSERT_EQ(mesh.positions.size(), 4u);
        EXPECT_EQ(mesh.positions[2], vec3(1, 1, 0));
    };
    check(squareBuffer<std::uint8_t>(), 5121);
    check(squareBuffer<std::uint16_t>(), 5123);
    check(squareBuffer<std::uint32_t>(), 5125);
}

TEST(Gltf, BinaryGltfWithAPictureInsideIsRead) {
    std::string json = gltf(squareBuffer<std::uint16_t>(), 5123, "", "", "");
    json.insert(json.rfind('}'), R"(, "images": [ { "bufferView": 1, "mimeType": "image/png" } ])");
    std::string error;
    EXPECT_EQ(read(glb(squareBuffer<std::uint16_t>(), json), error).indices.size(), 6u);
    EXPECT_EQ(error, "");
}

TEST(Gltf, NodesAreScaledTurnedAndMoved) {
    std::string error;
    // (1, 0, 0) doubled, turned by 90 degrees about z (quaternion 0 0 s s), moved by (0, 0, 5): (0, 2, 5).
    const std::string half = "0.70710678";
    const Mesh placed = read(squareGlb(R"(, "translation": [0,0,5], "scale": [2,2,2], "rotation": [0,0,)" +
                                       half + "," + half + "]"),
                             error);
    ASSERT_EQ(error, "");
    EXPECT_LT(glm::distance(placed.positions[1], vec3(0, 2, 5)), 1e-6);
    const Mesh matrix = read(squareGlb(R"(, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 7,8,9,1])"), error);
    EXPECT_EQ(matrix.positions[1], vec3(8, 8, 9));
    const Mesh mirrored = read(squareGlb(R"(, "scale": [-1,1,1])"), error);
    EXPECT_EQ(mirrored.indices, (std::vector<std::uint32_t>{0, 2, 1, 0, 3, 2}))
        << "a mirror turns triangles round";
}

TEST(Gltf, StripsAndFansBecomeTriangles) {
    std::string error;
    // Corners 0 1 2 0 2 3. Strip: every second triangle is turned round; fan: all share the first corner.
    const vec3 square[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const auto check = [&](const char* mode, std::initializer_list<int> expected) {
        const Mesh mesh = read(squareGlb("", mode), error);
        ASSERT_EQ(mesh.indices.size(), expected.size());
        std::size_t corner = 0;
        for (const int place : expected)
            EXPECT_EQ(mesh.positions[mesh.indices[corner++]], square[place]) << corner;
    };
    check(R"(, "mode": 5)", {0, 1, 2, 1, 0, 2, 2, 0, 2, 0, 3, 2});
    check(R"(, "mode": 6)", {0, 1, 2, 0, 2, 0, 0, 0, 2, 0, 2, 3});
}

TEST(Gltf, SparsePositionsReplaceTheStoredOnes) {
    Bytes buffer = squareBuffer<std::uint16_t>(); // 60 bytes
    append<std::uint16_t>(buffer, {3, 0});        // place 3, and padding
    append<float>(buffer, {5, 6, 7});
    std::string json = gltf(buffer, 5123, "", "", "");
    const std::string sparse =
        R"("sparse": { "count": 1, "indices": { "bufferView": 2, "componentType": 5123 },
                                              "values": { "bufferView": 3 } }, )";
    json.insert(json.find("\"bufferView\": 0"), sparse);
    const std::string views =
        R"(, { "buffer": 0, "byteOffset": 60, "byteLength": 2 }, { "buffer": 0, "byteOffset": 64, "byteLength": 12 })";
    json.insert(json.find(" ],\n        \"buffers\""), views);
    std::string error;
    const Mesh mesh = read(glb(buffer, json), error);
    ASSERT_EQ(error, "");
    EXPECT_EQ(mesh.positions[mesh.indices[5]], vec3(5, 6, 7)); // the second face is flat for itself
    EXPECT_EQ(mesh.positions[mesh.indices[2]], vec3(1, 1, 0));
}

TEST(Gltf, WithoutNormalsFacesAreFlat) {
    // The square, whose fourth corner is lifted: two faces with an edge in common, each with its own normal.
    Bytes lifted = squareBuffer<std::uint16_t>();
    const float high = 1;
    std::memcpy(lifted.data() + 44, &high, sizeof high); // z of (0, 1, 0)
    std::string error;
    const Mesh mesh = read(glb(lifted, gltf(lifted, 5123, "", "", "")), error);
    ASSERT_EQ(error, "");
    ASSERT_EQ(mesh.positions.size(), 6u);
    for (std::size_t corner = 0; corner < 6; ++corner) {
        const vec3 normal = mesh.normals[mesh.indices[corner]];
        const vec3 expected = corner < 3 ? vec3(0, 0, 1) : glm::normalize(vec3(1, -1, 1));
        EXPECT_LT(glm::distance(normal, expected), 1e-6f) << corner;
    }
    EXPECT_EQ(mesh.positions[mesh.indices[0]], mesh.positions[mesh.indices[3]]);
    // In one plane corners at one vertex stay one, as the file has them.
    const Mesh flat = read(squareGlb(), error);
    EXPECT_EQ(flat.positions.size(), 4u);
    EXPECT_EQ(flat.normals, std::vector<vec3>(4, vec3(0, 0, 1)));
}

TEST(Gltf, DamagedGltfIsRefused) {
    const Bytes whole = squareGlb();
    std::string error;
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const Bytes cut(whole.begin(), whole.begin() + std::ptrdiff_t(length));
        if (length >= 4 || length == 0) {
            read(cut, error);
            EXPECT_NE(error, "") << length;
        }
    }
    const auto messageOf = [&](const std::string& from, const std::string& to) {
        std::string json = gltf(squareBuffer<std::uint16_t>(), 5123, "", "", "");
        json.replace(json.find(from), from.size(), to);
        read(glb(squareBuffer<std::uint16_t>(), json), error);
        return error;
    };
    EXPECT_EQ(messageOf("\"count\": 4", "\"count\": 3"),
              "m/a.gltf: has index 3 behind its 3 positions; must be smaller");
    EXPECT_EQ(messageOf("\"count\": 4", "\"count\": 400"),
              "m/a.gltf: has a buffer of 60 bytes that is too short for what points into it");
    EXPECT_EQ(messageOf("\"byteLength\": 60", "\"byteLength\": 0"),
              "m/a.gltf: buffers.0.byteLength is 0; must be at least 1");
    EXPECT_EQ(messageOf("\"asset\":", "\"asset\"="),
              "m/a.gltf:1:10: invalid literal; last read: '\"asset\"='; expected ':'");
    EXPECT_EQ(messageOf("\"mesh\": 0", "\"mesh\": 7"), "m/a.gltf: points to mesh 7, which does not exist");
    EXPECT_EQ(messageOf("\"mesh\": 0", "\"mesh\": 0, \"children\": [0]"),
              "m/a.gltf: has nodes that hold each other; must form a tree");
    EXPECT_EQ(messageOf("\"scene\": 0", "\"extensionsRequired\": [\"KHR_draco_mesh_compression\"]"),
              "m/a.gltf: needs the extension KHR_draco_mesh_compression, which is not read; must do without");
    EXPECT_EQ(messageOf("\"nodes\": [0]", "\"nodes\": []"),
              "m/a.gltf: holds no triangles; must hold at least one");
    read(bytesOf(gltf(squareBuffer<std::uint16_t>(), 5123)), error);
    EXPECT_EQ(error, "m/a.gltf: m/square.bin: cannot be read (none)");
}

} // namespace
} // namespace lucent::scene
