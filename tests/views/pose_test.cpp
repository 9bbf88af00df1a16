// Vertices that the GPU moves, against scene::posed() and closed forms.
#include "tests/support/Gl.h"
#include "tests/support/Vertices.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lucent::views {
namespace {

using scene::Channel;

scene::Object objectOf(scene::Mesh mesh) {
    scene::MeshShape shape;
    shape.mesh = std::make_shared<const scene::Mesh>(std::move(mesh));
    scene::Object object;
    object.shape = shape;
    return object;
}

// A ball of more vertices than a row of texels holds.
scene::Mesh ball() { return scene::meshOf(scene::Sphere{0.5f}, 96); }

// Two joints that turn, move and scale; weights that change from pole to pole.
void addJoints(scene::Mesh& mesh) {
    for (const vec3& p : mesh.positions) {
        mesh.joints.push_back({0, 1, 2, 0});
        mesh.jointWeights.push_back({0.5f - p.y, (0.5f + p.y) * 0.75f, (0.5f + p.y) * 0.25f, 0});
    }
    scene::Rig& rig = mesh.rig;
    rig.nodes = {{}, {.parent = 0, .translate = {0, 0.2f, 0}}, {.parent = 1, .scale = {-1.2f, 0.5f, 1}}};
    rig.joints = {0, 1, 2};
    rig.jointFromMesh = {mat4(1), glm::translate(mat4(1), vec3(0, -0.2f, 0)), mat4(1)};
    Channel turn;
    turn.node = 1;
    turn.path = Channel::Path::Rotation;
    turn.times = {0, 2};
    turn.values = {0, 0, 0, 1, 0.6f, 0, 0, 0.8f};
    rig.channels.push_back(turn);
    rig.duration = 2;
}

// Three targets, the middle one never used, the last one without normals.
void addTargets(scene::Mesh& mesh) {
    scene::Rig& rig = mesh.rig;
    rig.targets.resize(3);
    for (const vec3& p : mesh.positions) {
        rig.targets[0].positions.push_back({0.3f * p.y * p.y, 0.1f, 0});
        rig.targets[0].normals.push_back({0.2f, -0.6f * p.x, 0});
        rig.targets[1].positions.push_back({9, 9, 9});
        rig.targets[2].positions.push_back({0, 0, std::sin(5 * p.x)});
    }
    rig.weights = {0, 0, 0.25f};
    Channel weights;
    weights.path = Channel::Path::Weights;
    weights.times = {0, 1};
    weights.values = {0, 1};
    rig.channels.push_back(weights);
    rig.duration = 2;
}

struct PoseTest : support::GlTest {
    support::Vertices move(const scene::Object& object, float time) {
        scene::Scene scene;
        scene.objects = {object};
        return support::verticesAt(*context, scene, time);
    }

    // Single precision on both sides, sums in another order: 1.8e-7 measured on llvmpipe.
    void expectPosed(const scene::Mesh& mesh, float time) {
        const scene::Mesh expected = scene::posed(mesh, scene::poseAt(mesh.rig, time));
        const support::Vertices found = move(objectOf(mesh), time);
        EXPECT_EQ(found.passes, 1);
        expectNear(found.positions, expected.positions, 1e-6f, time);
        expectNear(found.normals, expected.normals, 1e-6f, time);
    }

    static void expectNear(const std::vector<vec3>& found, const std::vector<vec3>& expected, float tolerance,
                           float time) {
        ASSERT_EQ(found.size(), expected.size());
        float worst = 0;
        for (std::size_t i = 0; i < found.size(); ++i)
            worst = std::max(worst, glm::distance(found[i], expected[i]));
        EXPECT_LE(worst, tolerance) << "at " << time << " s";
    }
};

constexpr float kTimes[] = {0, 0.31f, 1, 1.9f, 7.25f}; // the last one in the fourth round

TEST_F(PoseTest, JointsMoveVerticesAsTheReferenceDoes) {
    scene::Mesh mesh = ball();
    addJoints(mesh);
    for (const float time : kTimes)
        expectPosed(mesh, time);
}

TEST_F(PoseTest, MorphTargetsMoveVerticesAsTheReferenceDoes) {
    scene::Mesh mesh = ball();
    addTargets(mesh);
    for (const float time : kTimes)
        expectPosed(mesh, time);
}

TEST_F(PoseTest, TargetsComeBeforeJoints) {
    scene::Mesh mesh = ball();
    addTargets(mesh);
    addJoints(mesh);
    for (const float time : kTimes)
        expectPosed(mesh, time);
}

TEST_F(PoseTest, FlatJointsKeepTheirNormals) {
    // The middle joint is flattened along y: a sheet, whose normals have an inverse transpose no more.
    scene::Mesh mesh = ball();
    addJoints(mesh);
    mesh.rig.nodes[1].scale = {1, 0, 1};
    expectPosed(mesh, 0.5f);
}

// --- waves

scene::Wave ripple() {
    return {.amplitude = {0.02f, 0.05f, -0.03f}, .direction = {1, 2, -2}, .wavelength = 0.4f, .period = 0.7f};
}

// p + a sin(2 pi (d . p / wavelength - t / period)), in double precision.
dvec3 waved(const scene::Wave& wave, const dvec3& p, double time) {
    const double turn = glm::dot(glm::normalize(dvec3(wave.direction)), p) / double(wave.wavelength) -
                        time / double(wave.period);
    return p + dvec3(wave.amplitude) * std::sin(2 * std::numbers::pi * turn);
}

TEST_F(PoseTest, AWaveIsItsClosedForm) {
    scene::Object object = objectOf(ball());
    object.wave = ripple();
    for (const float time : {0.0f, 0.2f, 35.1f}) {
        const support::Vertices found = move(object, time);
        std::vector<vec3> expected;
        for (const vec3& p : meshOf(object)->positions)
            expected.push_back(waved(object.wave, p, time));
        EXPECT_EQ(found.passes, 1);
        expectNear(found.positions, expected, 1e-6f, time); // 35.1 s are 50 periods: 3e-6 of a turn in float
    }
}

TEST_F(PoseTest, NormalsOfAWaveStandOnWhatItBends) {
    // Two directions across the sphere at each vertex, moved by a central difference: the normal must stand
    // on both. Differences over 1e-4 m are off by (2 pi 1e-4 / 0.4)^2 / 6 = 4e-7.
    scene::Object object = objectOf(ball());
    object.wave = ripple();
    const support::Vertices found = move(object, 0.2f);
    const std::vector<vec3>& at = meshOf(object)->positions;
    const std::vector<vec3>& normals = meshOf(object)->normals;
    double worst = 0, largestTurn = 0;
    for (std::size_t i = 0; i < at.size(); ++i) {
        const dvec3 n(normals[i]);
        const dvec3 u = glm::normalize(glm::cross(n, std::abs(n.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0)));
        for (const dvec3& across : {u, glm::cross(n, u)}) {
            const dvec3 moved = waved(object.wave, dvec3(at[i]) + 1e-4 * across, 0.2f) -
                                waved(object.wave, dvec3(at[i]) - 1e-4 * across, 0.2f);
            worst = std::max(worst, std::abs(glm::dot(glm::normalize(moved), dvec3(found.normals[i]))));
        }
        largestTurn = std::max(largestTurn, 1 - glm::dot(n, dvec3(found.normals[i])));
    }
    EXPECT_LE(worst, 1e-5);
    EXPECT_GT(largestTurn, 0.1); // the wave does turn normals
}

TEST_F(PoseTest, AWaveRunsThroughWhatARigHasMoved) {
    scene::Mesh mesh = ball();
    addJoints(mesh);
    scene::Object object = objectOf(mesh);
    object.wave = ripple();
    const support::Vertices found = move(object, 1.1f);
    std::vector<vec3> expected = scene::posed(mesh, scene::poseAt(mesh.rig, 1.1f)).positions;
    for (vec3& p : expected)
        p = waved(object.wave, p, 1.1f);
    EXPECT_EQ(found.passes, 1);
    expectNear(found.positions, expected, 1e-6f, 1.1f);
}

// --- flat normals

TEST_F(PoseTest, FlatTrianglesHaveTheirOwnNormalsStillAndMoving) {
    scene::Mesh mesh = ball();
    addJoints(mesh);
    for (const bool moving : {true, false}) {
        if (!moving) {
            mesh.rig = {};
            mesh.joints.clear();
            mesh.jointWeights.clear();
        }
        scene::Object object = objectOf(mesh);
        std::get<scene::MeshShape>(object.shape).flatNormals = true;
        if (moving) object.wave = ripple();
        const support::Vertices found = move(object, 0.6f);
        EXPECT_EQ(found.passes, moving ? 2 : 0);
        ASSERT_EQ(found.positions.size(), mesh.indices.size());
        for (std::size_t i = 0; i < found.positions.size(); i += 3) {
            const dvec3 a(found.positions[i]), b(found.positions[i + 1]), c(found.positions[i + 2]);
            const dvec3 across = glm::cross(b - a, c - a);
            // Sides of 1e-3 m and more, known to 6e-8 m: an angle of 1e-4.
            if (glm::length(across) < 1e-6) continue;
            for (std::size_t k = i; k < i + 3; ++k)
                EXPECT_LE(glm::distance(glm::normalize(across), dvec3(found.normals[k])), 1e-4);
        }
    }
}

// --- only what is needed

TEST_F(PoseTest, WhatDoesNotMoveIsNotDrawn) {
    ImageCache images(*context);
    scene::Scene scene;
    scene.objects = {objectOf(ball())};
    const Drawables drawn = *drawablesOf(scene, images);
    EXPECT_EQ(move(scene.objects[0], 0.5f).passes, 0);
    EXPECT_EQ(drawn[0]->mesh()->textures->pose(), nullptr);
}

TEST_F(PoseTest, ARigThatStandsIsPosedOnce) {
    // One joint, two metres up, and no animation.
    scene::Mesh mesh = ball();
    mesh.joints.assign(mesh.positions.size(), {0, 0, 0, 0});
    mesh.jointWeights.assign(mesh.positions.size(), {1, 0, 0, 0});
    mesh.rig.nodes = {{.translate = {0, 2, 0}}};
    mesh.rig.joints = {0};
    mesh.rig.jointFromMesh = {mat4(1)};
    const support::Vertices found = move(objectOf(mesh), 3);
    EXPECT_EQ(found.passes, 0);
    expectNear(found.positions, scene::posed(mesh, scene::poseAt(mesh.rig, 0)).positions, 1e-6f, 3);
}

TEST_F(PoseTest, BytesCountWhatTheRigNeeds) {
    const auto bytesOf = [&](const scene::Mesh& mesh) {
        ImageCache images(*context);
        scene::Scene scene;
        scene.objects = {objectOf(mesh)};
        EXPECT_TRUE(drawablesOf(scene, images).ok());
        EXPECT_EQ(images.bytes(), context->device().textureBytes() + context->device().indexBytes());
        return images.bytes();
    };
    scene::Mesh mesh = ball();
    const std::size_t rows = (mesh.positions.size() + 2047) / 2048, texels = 2048 * rows;
    const std::size_t still = bytesOf(mesh);
    EXPECT_EQ(still, 2 * 16 * texels + 4 * mesh.indices.size());
    // Two of three targets are used: two images each, and two weights.
    scene::Mesh morphed = mesh;
    addTargets(morphed);
    EXPECT_EQ(bytesOf(morphed) - still, 4 * 16 * texels + 2 * 4);
    // Four joint numbers of 16 bits, four weights of 32, three matrices.
    scene::Mesh skinned = mesh;
    addJoints(skinned);
    EXPECT_EQ(bytesOf(skinned) - still, (8 + 16) * texels + 3 * 64);
}

} // namespace
} // namespace lucent::views
