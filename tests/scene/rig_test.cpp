#include "scene/Mesh.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lucent::scene {
namespace {

Channel channelOf(int node, Channel::Path path, Channel::Interpolation interpolation,
                  std::vector<float> times, std::vector<float> values) {
    Channel channel;
    channel.node = node;
    channel.path = path;
    channel.interpolation = interpolation;
    channel.times = std::move(times);
    channel.values = std::move(values);
    return channel;
}

// One node that is its only joint, moved by one channel.
Rig oneNode(Channel channel) {
    Rig rig;
    rig.nodes = {Node{}};
    rig.joints = {0};
    rig.jointFromMesh = {mat4(1)};
    rig.duration = channel.times.back();
    rig.channels = {std::move(channel)};
    return rig;
}

vec3 moved(const Rig& rig, float time, vec3 p) { return vec3(poseAt(rig, time).joints[0] * vec4(p, 1)); }

void expectNear(vec3 found, vec3 expected, float tolerance = 1e-6f) { // rounding of a few float operations
    EXPECT_LE(glm::distance(found, expected), tolerance)
        << found.x << " " << found.y << " " << found.z << " instead of " << expected.x << " " << expected.y
        << " " << expected.z;
}

using Path = Channel::Path;
using Interpolation = Channel::Interpolation;
const float kHalf = std::sqrt(0.5f);

TEST(Rig, LinearKeysMoveEvenly) {
    const Rig rig =
        oneNode(channelOf(0, Path::Translation, Interpolation::Linear, {1, 3}, {0, 0, 0, 4, 8, 0}));
    expectNear(moved(rig, 0, {}), {0, 0, 0}); // before the first key: its value
    expectNear(moved(rig, 1.5f, {}), {1, 2, 0});
    expectNear(moved(rig, 2.5f, {}), {3, 6, 0});
}

TEST(Rig, StepKeysJump) {
    const Rig rig =
        oneNode(channelOf(0, Path::Scale, Interpolation::Step, {0, 1, 2}, {1, 1, 1, 2, 2, 2, 3, 3, 3}));
    expectNear(moved(rig, 0.999f, {1, 0, 0}), {1, 0, 0});
    expectNear(moved(rig, 1, {1, 0, 0}), {2, 0, 0});
    expectNear(moved(rig, 1.999f, {1, 0, 0}), {2, 0, 0});
}

TEST(Rig, RotationsTurnEvenlyTheShorterWay) {
    // From none to 90 degrees about z; half-way that is 45 degrees. The second key is written as its
    // negative, which means the same rotation: 45 degrees as well, and not 225.
    for (const float sign : {1.0f, -1.0f}) {
        const Rig rig = oneNode(channelOf(0, Path::Rotation, Interpolation::Linear, {0, 2},
                                          {0, 0, 0, 1, 0, 0, sign * kHalf, sign * kHalf}));
        expectNear(moved(rig, 1, {1, 0, 0}), {kHalf, kHalf, 0});
        // A third of the way is 30 degrees; mixing the numbers would give 29.05.
        expectNear(moved(rig, 2.0f / 3, {1, 0, 0}), {std::sqrt(0.75f), 0.5f, 0});
    }
}

TEST(Rig, CubicSplinesPassTheirKeysWithTheirTangents) {
    // Keys 1 and 2 two seconds apart, tangents out 3 and in 0. At the middle: 1/2 * 1 + 2 * 1/8 * 3 + 1/2 * 2
    // - 2 * 1/8 * 0 = 2.25 (glTF 2.0, appendix C.5).
    const Rig rig = oneNode(channelOf(0, Path::Translation, Interpolation::CubicSpline, {0, 2},
                                      {9, 0, 0, 1, 0, 0, 3, 0, 0, 0, 0, 0, 2, 0, 0, 9, 0, 0}));
    expectNear(moved(rig, 0, {}), {1, 0, 0});
    expectNear(moved(rig, 1, {}), {2.25f, 0, 0});
    // Close behind the first key the slope is its tangent out: 3 a second, up to terms of 0.001^2.
    expectNear(moved(rig, 0.001f, {}), {1.003f, 0, 0}, 1e-5f);
}

TEST(Rig, CubicRotationsAreMadeUnitAgain) {
    // Without tangents the middle is the mean of (0, 0, 0, 1) and (0, 0, s, s), which points to 45 degrees.
    const Rig rig =
        oneNode(channelOf(0, Path::Rotation, Interpolation::CubicSpline, {0, 1},
                          {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, kHalf, kHalf, 0, 0, 0, 0}));
    expectNear(moved(rig, 0.5f, {1, 0, 0}), {kHalf, kHalf, 0});
}

TEST(Rig, AnimationBeginsAgainAfterItsDuration) {
    const Rig rig =
        oneNode(channelOf(0, Path::Translation, Interpolation::Linear, {0, 2}, {0, 0, 0, 2, 0, 0}));
    expectNear(moved(rig, 2.5f, {}), {0.5f, 0, 0});
    expectNear(moved(rig, 2, {}), {0, 0, 0});
    expectNear(moved(rig, -0.5f, {}), {1.5f, 0, 0});
}

// Two bones along x, the second from 1 to 2: its joint turns by 90 degrees about z within a second.
Mesh arm() {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0.5f, 0}};
    mesh.indices = {0, 1, 3, 1, 2, 3};
    mesh.normals.assign(4, {0, 1, 0});
    mesh.joints = {{0, 0, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 0}, {0, 1, 0, 0}};
    mesh.jointWeights = {{1, 0, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 0}, {0.5f, 0.5f, 0, 0}};
    Rig& rig = mesh.rig;
    rig.nodes = {Node{}, Node{0, {1, 0, 0}}};
    rig.joints = {0, 1};
    rig.jointFromMesh = {mat4(1), glm::translate(mat4(1), vec3(-1, 0, 0))};
    rig.channels = {
        channelOf(1, Path::Rotation, Interpolation::Linear, {0, 1}, {0, 0, 0, 1, 0, 0, kHalf, kHalf})};
    rig.duration = 1;
    return mesh;
}

TEST(Rig, ArmBendsByARightAngle) {
    Mesh mesh = arm();
    mesh.rig.duration = 2; // the last key holds
    const Mesh bent = posed(mesh, poseAt(mesh.rig, 1.5f));
    expectNear(bent.positions[0], {0, 0, 0});
    expectNear(bent.positions[1], {1, 0, 0}); // the elbow stays
    expectNear(bent.positions[2], {1, 1, 0}); // the hand rises
    expectNear(bent.normals[2], {-1, 0, 0});  // and its normal turns with it
    // Half of the first bone, where it stays at (1, 0.5), and half of the second, which brings it to (0.5,
    // 0).
    expectNear(bent.positions[3], {0.75f, 0.25f, 0});
    // (0, 1) and (-1, 0) half and half.
    expectNear(bent.normals[3], {-kHalf, kHalf, 0});
    EXPECT_TRUE(bent.rig.nodes.empty());
}

TEST(Rig, ParentsCarryTheirChildren) {
    Mesh mesh = arm();
    mesh.rig.nodes[0].translate = {0, 0, 5};
    mesh.rig.nodes[0].scale = vec3(2);
    const Mesh carried = posed(mesh, poseAt(mesh.rig, 0));
    expectNear(carried.positions[2], {4, 0, 5});
}

TEST(Rig, MorphTargetsAddUpByTheirWeights) {
    Mesh mesh;
    mesh.positions = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.indices = {0, 1, 2};
    mesh.normals.assign(3, {0, 0, 1});
    mesh.rig.targets = {{{{2, 0, 0}, {}, {}}, {{1, 0, -1}, {}, {}}}, {{{0, 4, 0}, {}, {}}, {}}};
    mesh.rig.weights = {0, 0.25f};
    mesh.rig.channels = {channelOf(0, Path::Weights, Interpolation::Linear, {0, 2}, {0, 1})};
    mesh.rig.duration = 2;
    EXPECT_EQ(poseAt(mesh.rig, 1).weights, (std::vector<float>{0.5f, 0.25f}));
    const Mesh half = posed(mesh, poseAt(mesh.rig, 1));
    expectNear(half.positions[0], {2, 1, 0}); // 1 + 0.5 * 2; 0.25 * 4
    expectNear(half.positions[1], {0, 1, 0});
    expectNear(half.normals[0], {kHalf, 0, kHalf}); // (0.5, 0, 0.5) made unit
    mesh.rig.channels[0].firstTarget = 1;
    EXPECT_EQ(poseAt(mesh.rig, 1).weights, (std::vector<float>{0, 0.5f}));
}

TEST(Rig, NormalsGoByTheInverseTranspose) {
    // A slope of 45 degrees in x and y, stretched to twice its length in x: its normal is (1, 2) / sqrt(5).
    Mesh mesh;
    mesh.positions = {{1, 0, 0}, {0, 1, 0}, {0, 1, 1}};
    mesh.indices = {0, 1, 2};
    mesh.normals.assign(3, {kHalf, kHalf, 0});
    mesh.joints.assign(3, {0, 0, 0, 0});
    mesh.jointWeights.assign(3, {1, 0, 0, 0});
    const Mesh stretched = posed(mesh, {{glm::scale(mat4(1), vec3(2, 1, 1))}, {}});
    expectNear(stretched.normals[0], vec3(1, 2, 0) / std::sqrt(5.0f));
    const Mesh mirrored = posed(mesh, {{glm::scale(mat4(1), vec3(-1, 1, 1))}, {}});
    expectNear(mirrored.normals[0], {-kHalf, kHalf, 0});
    const Mesh flattened = posed(mesh, {{glm::scale(mat4(1), vec3(1, 0, 1))}, {}}); // into the plane y = 0
    expectNear(flattened.normals[0], {0, 1, 0});
}

TEST(Normals, LargeTrianglesWeighMore) {
    // A triangle of area 2 that faces +z and one of area 1/2 that faces +x share the vertices 0 and 1.
    const std::vector<vec3> positions = {{0, 0, 0}, {0, 1, 0}, {-4, 0, 0}, {0, 0, 1}, {9, 9, 9}};
    const std::vector<std::uint32_t> indices = {0, 1, 2, 0, 1, 3, 0, 0, 1};
    const std::vector<vec3> normals = areaWeightedNormals(positions, indices);
    expectNear(normals[0], vec3(1, 0, 4) / std::sqrt(17.0f)); // twice the areas: 4 along z, 1 along x
    expectNear(normals[2], {0, 0, 1});
    expectNear(normals[3], {1, 0, 0});
    expectNear(normals[4], {0, 1, 0}); // of no triangle
}

} // namespace
} // namespace lucent::scene
