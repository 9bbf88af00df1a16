#include "scene/Mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>
#include <tuple>

namespace lucent::scene {
namespace {

using std::numbers::pi;

dvec3 cornerOf(const Mesh& mesh, std::size_t i) { return dvec3(mesh.positions[mesh.indices[i]]); }

double areaOf(const Mesh& mesh) {
    double area = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        area += glm::length(glm::cross(cornerOf(mesh, i + 1) - cornerOf(mesh, i),
                                       cornerOf(mesh, i + 2) - cornerOf(mesh, i))) /
                2;
    return area;
}

// Of a closed mesh whose triangles are counter-clockwise seen from outside.
double volumeOf(const Mesh& mesh) {
    double volume = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        volume += glm::dot(cornerOf(mesh, i), glm::cross(cornerOf(mesh, i + 1), cornerOf(mesh, i + 2))) / 6;
    return volume;
}

// Vertices - edges + triangles, vertices at the same place counted once; every edge lies beside two
// triangles.
int eulerOf(const Mesh& mesh) {
    std::set<std::tuple<float, float, float>> places;
    for (const std::uint32_t index : mesh.indices)
        places.insert({mesh.positions[index].x, mesh.positions[index].y, mesh.positions[index].z});
    const int triangles = int(mesh.indices.size() / 3);
    return int(places.size()) - 3 * triangles / 2 + triangles;
}

// Every triangle has an area and looks the way of its vertices' normals, which are unit.
void expectSoundTriangles(const Mesh& mesh) {
    ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
    for (const vec3& normal : mesh.normals)
        ASSERT_NEAR(glm::length(normal), 1, 1e-6);
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const dvec3 out =
            glm::cross(cornerOf(mesh, i + 1) - cornerOf(mesh, i), cornerOf(mesh, i + 2) - cornerOf(mesh, i));
        ASSERT_GT(glm::length(out), 0) << i;
        for (std::size_t corner = i; corner < i + 3; ++corner)
            ASSERT_GT(glm::dot(out, dvec3(mesh.normals[mesh.indices[corner]])), 0) << corner;
    }
}

TEST(Shapes, PlaneFacesUp) {
    const Mesh mesh = meshOf(Plane{{3, 2}});
    expectSoundTriangles(mesh);
    EXPECT_EQ(mesh.positions.size(), 4u);
    EXPECT_EQ(mesh.normals[0], vec3(0, 1, 0));
    EXPECT_EQ(areaOf(mesh), 6);
    EXPECT_EQ(openEdges(mesh), 4u);
    const Mesh cells = meshOf(Plane{{3, 2}}, 5);
    expectSoundTriangles(cells);
    EXPECT_EQ(cells.indices.size(), 3 * 2 * 25u);
    EXPECT_NEAR(areaOf(cells), 6, 1e-6);
    EXPECT_EQ(openEdges(cells), 20u);
}

TEST(Shapes, BoxIsClosedWithSharpEdges) {
    const Mesh mesh = meshOf(Box{{1, 2, 3}});
    expectSoundTriangles(mesh);
    EXPECT_EQ(mesh.positions.size(), 24u);
    EXPECT_EQ(openEdges(mesh), 0u);
    EXPECT_EQ(eulerOf(mesh), 2);
    EXPECT_EQ(areaOf(mesh), 22); // 2 (1 * 2 + 2 * 3 + 3 * 1)
    EXPECT_EQ(volumeOf(mesh), 6);
    for (std::size_t i = 0; i < 24; ++i) { // corners, each with the normal of its own face
        EXPECT_EQ(glm::abs(mesh.positions[i]), vec3(0.5f, 1, 1.5f));
        EXPECT_GT(glm::dot(mesh.normals[i], mesh.positions[i]), 0);
    }
}

TEST(Shapes, BoxOfManyCellsHasNoCracks) {
    const Mesh mesh = meshOf(Box{{0.1f, 0.7f, 1.3f}}, 7);
    expectSoundTriangles(mesh);
    EXPECT_EQ(openEdges(mesh), 0u);
    EXPECT_EQ(eulerOf(mesh), 2);
    EXPECT_NEAR(volumeOf(mesh), 0.1 * 0.7 * 1.3, 1e-8);
}

TEST(Shapes, SphereIsClosedAndRound) {
    for (const int segments : {3, 4, 7, 64}) {
        const Mesh mesh = meshOf(Sphere{0.3f}, segments);
        expectSoundTriangles(mesh);
        EXPECT_EQ(openEdges(mesh), 0u) << segments;
        EXPECT_EQ(eulerOf(mesh), 2) << segments;
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            // Each coordinate is rounded by 1.5e-8 at most, the radius itself by 1.2e-8.
            EXPECT_NEAR(glm::length(dvec3(mesh.positions[i])), 0.3, 4e-8);
            EXPECT_LE(glm::distance(mesh.normals[i] * 0.3f, mesh.positions[i]), 1e-7f);
        }
    }
    // n segments and n/2 rings: area and volume are too small by parts of order (pi/n)^2 = 1.5e-4.
    const Mesh mesh = meshOf(Sphere{0.3f});
    EXPECT_NEAR(areaOf(mesh) / (4 * pi * 0.09), 1, 2e-4);
    EXPECT_NEAR(volumeOf(mesh) / (4.0 / 3 * pi * 0.027), 1, 3e-4);
    EXPECT_LT(volumeOf(mesh), 4.0 / 3 * pi * 0.027);
    // Extremes of all axes are there: the bounding box is exact.
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-0.3f, 0.3f})
            EXPECT_TRUE(std::any_of(mesh.positions.begin(), mesh.positions.end(),
                                    [&](const vec3& p) { return p[axis] == side; }));
}

TEST(Shapes, TorusIsClosedWithAHole) {
    for (const Torus torus : {Torus{1, 0.25f}, Torus{1, 0.01f}, Torus{0.5f, 0.4f}}) {
        const Mesh mesh = meshOf(torus, 96);
        expectSoundTriangles(mesh);
        EXPECT_EQ(openEdges(mesh), 0u);
        EXPECT_EQ(eulerOf(mesh), 0);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const vec3 p = mesh.positions[i];
            const vec3 centre = glm::normalize(vec3(p.x, 0, p.z)) * torus.major;
            EXPECT_NEAR(glm::distance(p, centre), torus.minor, 2e-7);
            EXPECT_LE(glm::distance(mesh.normals[i] * torus.minor, p - centre), 3e-7f);
        }
    }
    // Areas of the n-gons that stand for circles of 384 and 96 steps: parts of (pi/96)^2 = 1.1e-3 are
    // missing.
    const Mesh mesh = meshOf(Torus{});
    EXPECT_EQ(mesh.positions.size(), 384u * 96);
    EXPECT_NEAR(areaOf(mesh) / (4 * pi * pi * 0.25), 1, 1e-3);
    EXPECT_NEAR(volumeOf(mesh) / (2 * pi * pi * 0.0625), 1, 1e-3);
}

TEST(Shapes, TorusThatTouchesItselfHasNoTriangleWithoutArea) {
    const Mesh mesh = meshOf(Torus{0.5f, 0.5f}, 64);
    expectSoundTriangles(mesh);
    EXPECT_EQ(openEdges(mesh), 0u);
    EXPECT_NEAR(volumeOf(mesh) / (2 * pi * pi * 0.125), 1, 6e-3); // (pi/64)^2 = 2.4e-3 for each circle
}

TEST(Shapes, CylinderIsClosedWithSharpRims) {
    const Mesh mesh = meshOf(Cylinder{0.5f, 1, false}, 32);
    expectSoundTriangles(mesh);
    EXPECT_EQ(openEdges(mesh), 0u);
    EXPECT_EQ(eulerOf(mesh), 2);
    const double lid = 32 * 0.25 * std::sin(2 * pi / 32) / 2, side = 32 * std::sin(pi / 32);
    EXPECT_NEAR(volumeOf(mesh), lid, 1e-7); // rounding of the positions
    EXPECT_NEAR(areaOf(mesh), 2 * lid + side, 1e-6);
    // 10 rows of squares on the side: 32 / pi = 10.2 for a height of one diameter.
    EXPECT_EQ(mesh.positions.size(), 32u * 11 + 2 * 33);
}

TEST(Shapes, OpenCylinderIsABandThatFacesOutwards) {
    const Mesh mesh = meshOf(Cylinder{0.5f, 0.1f, true}, 64);
    expectSoundTriangles(mesh);
    EXPECT_EQ(openEdges(mesh), 2 * 64u);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const vec3 p = mesh.positions[i];
        EXPECT_NEAR(glm::length(vec2(p.x, p.z)), 0.5, 6e-8);
        EXPECT_LE(glm::distance(mesh.normals[i] * 0.5f, vec3(p.x, 0, p.z)), 1e-7f);
        EXPECT_LE(std::abs(p.y), 0.05f);
    }
    EXPECT_NEAR(areaOf(mesh), 0.1 * 64 * std::sin(pi / 64), 1e-6);
}

TEST(Shapes, OpenEdgesAreFoundAndFlippedTrianglesToo) {
    Mesh mesh = meshOf(Box{});
    std::swap(mesh.indices[1], mesh.indices[2]); // its three edges run the way of their neighbours: 2 each
    EXPECT_EQ(openEdges(mesh), 6u);
    mesh = meshOf(Box{});
    mesh.indices.resize(mesh.indices.size() - 3);
    EXPECT_EQ(openEdges(mesh), 3u);
}

HeightField fieldOf(ivec2 size, const std::function<float(int, int)>& height) {
    auto map = std::make_shared<Image>(size.x, size.y, 1);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            *map->at(x, y) = height(x, y);
    HeightField field;
    field.width = 2;
    field.heightScale = 0.5f;
    field.heights = std::move(map);
    return field;
}

TEST(Shapes, TheBodyOfAHeightFieldIsClosedAndHoldsWhatLiesUnderItsHeights) {
    const Mesh flat = meshOf(fieldOf({4, 2}, [](int, int) { return 0.8f; }));
    expectSoundTriangles(flat);
    EXPECT_EQ(openEdges(flat), 0u);
    EXPECT_NEAR(volumeOf(flat), 2 * 1 * 0.4, 1e-6);
    // A ramp along x is level in the outer half texels: the mean of its heights stays.
    const Mesh ramp = meshOf(fieldOf({8, 4}, [](int x, int) { return 0.2f + 0.1f * float(x); }));
    EXPECT_EQ(openEdges(ramp), 0u);
    EXPECT_NEAR(volumeOf(ramp), 2 * 1 * 0.5 * 0.55, 1e-6);
    EXPECT_NEAR(glm::length(ramp.normals[25] - glm::normalize(vec3(-0.2f, 0, 1))), 0, 1e-6); // 0.05 over 0.25
    // Below 0 the bottom goes along.
    EXPECT_NEAR(volumeOf(meshOf(fieldOf({4, 4}, [](int x, int) { return x < 2 ? -1.0f : 1.0f; }))),
                2 * 2 * 0.5 * 1, 1e-6);
}

TEST(Shapes, WhereHeightsTouchTheirBottomTheBodyHasNone) {
    // One texel of 16 stands up: a frustum over four cells, each a quarter of a texel's height on the mean.
    const Mesh bump = meshOf(fieldOf({5, 5}, [](int x, int y) { return x == 2 && y == 2 ? 1.0f : 0.0f; }));
    EXPECT_EQ(openEdges(bump), 0u);
    EXPECT_EQ(bump.indices.size(), 3 * 2 * 6u); // of each cell the triangles that have the texel, twice
    // A hole that the loader has dug, and one in a map of alpha that is solid.
    HeightField field =
        fieldOf({6, 6}, [](int x, int y) { return x / 2 == 1 && y / 2 == 1 ? -12.0f : 1.0f; });
    auto alpha = std::make_shared<Image>(3, 3, 1);
    std::fill(alpha->pixels.begin(), alpha->pixels.end(), 1.0f);
    *alpha->at(1, 1) = 0;
    field.alpha = alpha;
    field.alphaIsSolid = false;
    const Mesh ring = meshOf(field);
    EXPECT_EQ(openEdges(ring), 0u);
    for (const vec3& place : ring.positions)
        EXPECT_GE(place.z, 0);
    EXPECT_NEAR(volumeOf(ring), 2 * 2 * 0.5 * 32 / 36, 1e-6);
}

TEST(Shapes, PartKeepsItsTrianglesWithTheirVertices) {
    Mesh mesh = meshOf(Box{});
    mesh.joints.assign(24, {0, 0, 0, 0});
    mesh.jointWeights.assign(24, {1, 0, 0, 0});
    mesh.rig.nodes = {Node{}};
    mesh.rig.joints = {0};
    mesh.rig.jointFromMesh = {mat4(1)};
    mesh.rig.targets = {{mesh.positions, mesh.normals}};
    mesh.rig.weights = {0.5f};
    mesh.rig.duration = 3;
    Material glass;
    glass.kind = Clear{};
    mesh.parts = {{"stone", 0, 30, {}}, {"glass", 30, 6, glass}};
    const Mesh part = partOf(mesh, mesh.parts[1]);
    ASSERT_EQ(part.positions.size(), 4u);
    ASSERT_EQ(part.indices.size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(part.positions[part.indices[i]], mesh.positions[mesh.indices[30 + i]]);
        EXPECT_EQ(part.rig.targets[0].normals[part.indices[i]], mesh.normals[mesh.indices[30 + i]]);
    }
    EXPECT_EQ(part.parts[0].values.clear().transmission, 1);
    const Result<Mesh> sound = decodeMesh(encodeMesh(part), "part"); // every list fits the others
    EXPECT_TRUE(sound) << sound.error().message;
    EXPECT_TRUE(part.moves());
}

} // namespace
} // namespace lucent::scene
