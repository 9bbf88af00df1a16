#include "tests/scene/Gltf.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lucent::scene {
namespace {

/// A binary glTF in the making: numbers go to its buffer, the rest is written by the test.
class File {
public:
    /// Index of the accessor that holds these numbers.
    template <class T>
    int add(const std::string& type, int width, const std::vector<T>& numbers) {
        constexpr int kType = std::is_same_v<T, float> ? 5126 : std::is_same_v<T, std::uint8_t> ? 5121 : 5123;
        while (buffer_.size() % 4)
            buffer_.push_back(std::byte(0));
        comma(views_) += R"({ "buffer": 0, "byteOffset": )" + std::to_string(buffer_.size()) +
                         R"(, "byteLength": )" + std::to_string(numbers.size() * sizeof(T)) + " }";
        const auto* begin = reinterpret_cast<const std::byte*>(numbers.data());
        buffer_.insert(buffer_.end(), begin, begin + numbers.size() * sizeof(T));
        comma(accessors_) += R"({ "bufferView": )" + std::to_string(count_) + R"(, "componentType": )" +
                             std::to_string(kType) + R"(, "type": ")" + type + R"(", "count": )" +
                             std::to_string(numbers.size() / std::size_t(width)) + " }";
        return count_++;
    }
    std::string scalars(const std::vector<float>& n) { return std::to_string(add("SCALAR", 1, n)); }
    std::string vectors(const std::vector<float>& n) { return std::to_string(add("VEC3", 3, n)); }
    std::string fours(const std::vector<float>& n) { return std::to_string(add("VEC4", 4, n)); }

    /// The mesh of the file with these members, or the message in `error`.
    Mesh read(const std::string& members, std::string& error) const {
        return test::read(test::glb(buffer_, R"({ "asset": { "version": "2.0" }, )" + members +
                                                 R"(, "accessors": [)" + accessors_ +
                                                 R"(], "bufferViews": [)" + views_ +
                                                 R"(], "buffers": [ { "byteLength": )" +
                                                 std::to_string(buffer_.size()) + " } ] }"),
                          error);
    }
    Mesh read(const std::string& members) const {
        std::string error;
        Mesh mesh = read(members, error);
        EXPECT_EQ(error, "");
        return mesh;
    }

private:
    static std::string& comma(std::string& list) { return list += list.empty() ? "" : ", "; }
    Bytes buffer_;
    std::string views_, accessors_;
    int count_ = 0;
};

const std::vector<float> kTriangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};
const float kHalf = std::sqrt(0.5f);

void expectNear(vec3 found, vec3 expected) { // rounding of a few float operations
    EXPECT_LE(glm::distance(found, expected), 2e-6f)
        << found.x << " " << found.y << " " << found.z << " instead of " << expected.x << " " << expected.y
        << " " << expected.z;
}

Mesh at(const Mesh& mesh, float time) { return posed(mesh, poseAt(mesh.rig, time)); }

TEST(GltfMotion, NormalsAreReadAndTurnedByTheirNodes) {
    File file;
    const std::string positions = file.vectors(kTriangle);
    // Turned by 90 degrees about x, and mirrored in x: +y becomes +z, +x becomes -x; length 3 and 0 are
    // mended.
    const std::string normals = file.vectors({0, 3, 0, 1, 0, 0, 0, 0, 0});
    const Mesh mesh = file.read(
        R"("nodes": [ { "mesh": 0, "rotation": [0.70710678, 0, 0, 0.70710678], "scale": [-1, 1, 1] } ],
           "meshes": [ { "primitives": [ { "attributes": { "POSITION": )" +
        positions + R"(, "NORMAL": )" + normals + " } } ] } ]");
    expectNear(mesh.normals[0], {0, 0, 1});
    expectNear(mesh.normals[1], {-1, 0, 0});
    expectNear(mesh.normals[2], {0, -1, 0}); // that of its triangle, +z, turned; a mirror in x keeps it
    EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 2, 1}));
    // The triangle still looks the way of its normal.
    const auto p = [&](int i) { return mesh.positions[mesh.indices[std::size_t(i)]]; };
    EXPECT_GT(glm::dot(glm::cross(p(1) - p(0), p(2) - p(0)), mesh.normals[2]), 0);
}

TEST(GltfMotion, AnimatedNodeIsTheJointOfItsVertices) {
    File file;
    const std::string positions = file.vectors(kTriangle), times = file.scalars({0, 2}),
                      moves = file.vectors({0, 0, 0, 4, 0, 0}),
                      turns = file.fours({0, 0, 0, 1, 0, 0, kHalf, kHalf});
    // Node 0 rises nothing but stands in the scene; node 1 carries node 2, which has the other triangle.
    const Mesh mesh = file.read(
        R"("scenes": [ { "nodes": [2, 0] } ],
           "nodes": [ { "mesh": 0, "translation": [0, 0, 7] }, { "mesh": 0, "translation": [1, 0, 0] },
                      { "children": [1], "scale": [2, 2, 2] } ],
           "meshes": [ { "primitives": [ { "attributes": { "POSITION": )" +
        positions + R"( } } ] } ],
           "animations": [ { "channels": [ { "sampler": 0, "target": { "node": 2, "path": "translation" } },
                                           { "sampler": 1, "target": { "node": 1, "path": "rotation" } } ],
                             "samplers": [ { "input": )" +
        times + R"(, "output": )" + moves + R"( }, { "input": )" + times + R"(, "output": )" + turns +
        R"(, "interpolation": "STEP" } ] } ])");
    ASSERT_TRUE(mesh.moves());
    EXPECT_EQ(mesh.rig.duration, 2);
    ASSERT_EQ(mesh.positions.size(), 6u);
    const auto corner = [&](float time, bool moving) { // (1, 0, 0) of the still or the moving triangle
        const Mesh now = at(mesh, time);
        const bool stillFirst = now.positions[0].z == 7;
        return now.positions[moving == stillFirst ? 4 : 1];
    };
    expectNear(corner(0, false), {1, 0, 7});
    expectNear(corner(1, false), {1, 0, 7});
    expectNear(corner(0, true), {4, 0, 0}); // 2 (1 + 1)
    expectNear(corner(1, true), {6, 0, 0}); // and half of 4; the turn waits for its key
    // Just before the end, still unturned: 2 (1 + 1) + 4 * 0.75.
    expectNear(corner(1.5f, true), {7, 0, 0});
}

// Two bones along x, each 1 long; vertices at 0, 1 and 2, of which the last is the second bone's.
std::string skinned(File& file, const std::string& more) {
    const std::string positions = file.vectors({0, 0, 0, 2, 0, 0, 1, 1, 0});
    const std::string joints =
        std::to_string(file.add<std::uint8_t>("VEC4", 4, {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}));
    const std::string weights = file.fours({1, 0, 0, 0, 2, 0, 0, 0, 0.5f, 0.5f, 0, 0}); // 2 is made 1
    const std::string matrices = std::to_string(file.add<float>(
        "MAT4", 16, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,    //
                     1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1})); // the second bone begins at x = 1
    return R"("scene": 0, "scenes": [ { "nodes": [2, 0] } ],
              "nodes": [ { "children": [1] }, { "translation": [1, 0, 0] )" +
           more + R"( }, { "mesh": 0, "skin": 0, "translation": [50, 60, 70] } ],
              "skins": [ { "joints": [0, 1], "inverseBindMatrices": )" +
           matrices + R"( } ],
              "meshes": [ { "primitives": [ { "attributes": { "POSITION": )" +
           positions + R"(, "JOINTS_0": )" + joints + R"(, "WEIGHTS_0": )" + weights + " } } ] } ]";
}

TEST(GltfMotion, SkinWithoutAnimationStandsInItsRestPose) {
    File file;
    // The second bone stands at 90 degrees. The mesh's own node counts nothing (glTF 2.0, 3.7.3.3).
    const Mesh mesh = file.read(skinned(file, R"(, "rotation": [0, 0, 0.70710678, 0.70710678])"));
    EXPECT_FALSE(mesh.moves());
    EXPECT_TRUE(mesh.joints.empty());
    EXPECT_TRUE(mesh.rig.nodes.empty());
    expectNear(mesh.positions[0], {0, 0, 0});
    expectNear(mesh.positions[1], {1, 1, 0});
    expectNear(mesh.positions[2], {0.5f, 0.5f, 0}); // (1, 1) and (0, 0) half and half
}

TEST(GltfMotion, SkinFollowsItsAnimation) {
    File file;
    const std::string times = file.scalars({0, 1, 2}),
                      turns = file.fours({0, 0, 0, 1, 0, 0, kHalf, kHalf, 0, 0, 0, 1});
    const std::string animation = R"(, "animations": [ { "channels": [ { "sampler": 0, "target":
        { "node": 1, "path": "rotation" } } ], "samplers": [ { "input": )" +
                                  times + R"(, "output": )" + turns + " } ] } ]";
    const Mesh mesh = file.read(skinned(file, "") + animation);
    EXPECT_EQ(mesh.rig.joints.size(), 2u);
    expectNear(at(mesh, 0).positions[1], {2, 0, 0});
    expectNear(at(mesh, 0.5f).positions[1], {1 + kHalf, kHalf, 0});
    expectNear(at(mesh, 1).positions[1], {1, 1, 0});
    expectNear(at(mesh, 3).positions[1], {1, 1, 0}); // the second time round
}

std::string morphed(File& file, const std::string& more) {
    const std::string positions = file.vectors(kTriangle), up = file.vectors({0, 0, 0, 0, 0, 1, 0, 0, 0}),
                      along = file.vectors({2, 0, 0, 2, 0, 0, 2, 0, 0});
    return R"("nodes": [ { "mesh": 0, "translation": [0, 0, 5] } ],
              "meshes": [ { "weights": [1, 0.5], "primitives": [ { "attributes": { "POSITION": )" +
           positions + R"( }, "targets": [ { "POSITION": )" + up + R"( }, { "POSITION": )" + along +
           R"( } ] } ] } ])" + more;
}

TEST(GltfMotion, MorphTargetsStandAtTheirDefaultWeights) {
    File file;
    const Mesh mesh = file.read(morphed(file, ""));
    EXPECT_TRUE(mesh.rig.targets.empty());
    expectNear(mesh.positions[0], {1, 0, 5});
    expectNear(mesh.positions[1], {2, 0, 6});
    // Without normals in the file the displaced triangle gives them: (-1, 0, 1) / sqrt 2.
    expectNear(mesh.normals[0], {-kHalf, 0, kHalf});
}

TEST(GltfMotion, MorphWeightsAreAnimated) {
    File file;
    const std::string times = file.scalars({0, 1}), weights = file.scalars({0, 0, 1, 1});
    const Mesh mesh = file.read(morphed(file, R"(, "animations": [ { "channels": [ { "sampler": 0, "target":
        { "node": 0, "path": "weights" } } ], "samplers": [ { "input": )" +
                                                  times + R"(, "output": )" + weights + " } ] } ]"));
    ASSERT_EQ(mesh.rig.targets.size(), 2u);
    expectNear(at(mesh, 0).positions[1], {1, 0, 5});
    expectNear(at(mesh, 0.5f).positions[1], {2, 0, 5.5f});
    EXPECT_EQ(mesh.rig.channels[0].width(), 2u);
}

TEST(GltfMotion, TwoMeshesKeepTheirOwnTargets) {
    File file;
    const std::string positions = file.vectors(kTriangle), up = file.vectors({0, 0, 1, 0, 0, 1, 0, 0, 1}),
                      times = file.scalars({0, 1}), weights = file.scalars({0, 1});
    const Mesh mesh = file.read(R"("nodes": [ { "mesh": 0 }, { "mesh": 0, "translation": [9, 0, 0] } ],
        "meshes": [ { "primitives": [ { "attributes": { "POSITION": )" +
                                positions + R"( }, "targets": [ { "POSITION": )" + up + R"( } ] } ] } ],
        "animations": [ { "channels": [ { "sampler": 0, "target": { "node": 1, "path": "weights" } } ],
                          "samplers": [ { "input": )" +
                                times + R"(, "output": )" + weights + " } ] } ]");
    const Mesh half = at(mesh, 0.5f);
    ASSERT_EQ(half.positions.size(), 6u);
    expectNear(half.positions[0], {0, 0, 0});
    expectNear(half.positions[3], {9, 0, 0.5f});
}

TEST(GltfMotion, FurtherAnimationsAndThoseOfNothingAreNamed) {
    File file;
    const std::string positions = file.vectors(kTriangle), times = file.scalars({0, 1}),
                      moves = file.vectors({0, 0, 0, 4, 0, 0});
    const std::string sampler = R"("samplers": [ { "input": )" + times + R"(, "output": )" + moves + " } ]";
    testing::internal::CaptureStderr();
    const Mesh mesh = file.read(R"("nodes": [ { "mesh": 0 }, { "camera": 0 } ],
        "cameras": [ { "type": "perspective", "perspective": { "yfov": 1, "znear": 1 } } ],
        "meshes": [ { "primitives": [ { "attributes": { "POSITION": )" +
                                positions + R"( } } ] } ],
        "animations": [ { "channels": [ { "sampler": 0, "target": { "node": 1, "path": "translation" } } ], )" +
                                sampler + R"( }, { "name": "run", "channels": [], )" + sampler + " } ]");
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "warning: m/a.gltf: not read: animations behind the first (\"run\")\n");
    EXPECT_FALSE(mesh.moves()) << "a moving camera moves no vertices";
    EXPECT_TRUE(mesh.joints.empty());
}

TEST(GltfMotion, DamagedRigsAreRefused) {
    File file;
    const std::string times = file.scalars({0, 1}), backwards = file.scalars({1, 0}),
                      moves = file.vectors({0, 0, 0, 4, 0, 0}), one = file.vectors({0, 0, 0});
    const std::string good = skinned(file, "");
    const auto messageOf = [&](std::string members, const std::string& from, const std::string& to) {
        std::string error;
        if (!from.empty()) members.replace(members.find(from), from.size(), to);
        file.read(members, error);
        return error;
    };
    const auto animated = [&](const std::string& input, const std::string& output) {
        return good + R"(, "animations": [ { "channels": [ { "sampler": 0, "target": { "node": 1,
            "path": "translation" } } ], "samplers": [ { "input": )" +
               input + R"(, "output": )" + output + " } ] } ]";
    };
    EXPECT_EQ(messageOf(good, "", ""), "");
    EXPECT_EQ(messageOf(good, R"("joints": [0, 1])", R"("joints": [0, 8])"),
              "m/a.gltf: points to node 8, which does not exist");
    EXPECT_EQ(messageOf(good, R"("joints": [0, 1])", R"("joints": [0])"),
              "m/a.gltf: has joint 1 behind the 1 of its skin; must be smaller");
    EXPECT_EQ(messageOf(good, R"("skin": 0)", R"("skin": 3)"),
              "m/a.gltf: points to skin 3, which does not exist or has no joints");
    EXPECT_EQ(messageOf(good, R"("children": [1])", R"("children": [1, 1])"),
              "m/a.gltf: has node 1 below two others; must form a tree");
    EXPECT_EQ(messageOf(animated(times, moves), "", ""), "");
    EXPECT_EQ(messageOf(animated(times, one), "", ""),
              "m/a.gltf: channel 0 has 3 values at 2 times; must be 6");
    EXPECT_EQ(messageOf(animated(backwards, moves), "", ""),
              "m/a.gltf: channel 0: time 1 is not behind the one before; must be");
    EXPECT_EQ(messageOf(animated(times, times), "", ""),
              "m/a.gltf: has values of an animation of another form or none; must be VEC3");
    EXPECT_EQ(messageOf(animated(times, moves), R"("path": "translation")", R"("path": "weights")"),
              "m/a.gltf: has values of an animation of another form or none; must be SCALAR");
    std::string morphs = animated(times, times); // of a bone
    morphs.replace(morphs.find(R"("path": "translation")"), 21, R"("path": "weights")");
    EXPECT_EQ(messageOf(morphs, "", ""),
              "m/a.gltf: animates 1 morph targets of a node that has 0; must be as many");
    EXPECT_EQ(messageOf(animated(times, moves), R"("node": 1,)", R"("node": 9,)"),
              "m/a.gltf: points to node 9, which does not exist");
    EXPECT_EQ(messageOf(animated(times, moves), R"("translation": [1, 0, 0])",
                        R"("matrix": [1,0,0,0, 1,1,0,0, 0,0,1,0, 0,0,0,1])"),
              "m/a.gltf: node 1 has a matrix that slants or flattens; must scale, turn and move");
}

} // namespace
} // namespace lucent::scene
