// Triangles by number: each has its last corner to itself, and knows what lies beyond its edges.
#include "views/Triangles.h"

#include <gtest/gtest.h>

#include <set>

namespace lucent::views {
namespace {

using Triangle = TriangleTable::Triangle;
constexpr std::uint32_t kNone = TriangleTable::kNone;

const scene::Mesh kMeshes[] = {scene::meshOf(scene::Sphere{1}, 32), scene::meshOf(scene::Torus{1, 0.4f}, 24),
                               scene::meshOf(scene::Box{vec3(1)}), scene::meshOf(scene::Plane{{1, 2}}, 5),
                               scene::meshOf(scene::Cylinder{.radius = 1, .height = 2}, 12)};

// Two triangles of a square in the plane z = 0, which share the edge from (1, 0) to (0, 1).
scene::Mesh square() { return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {0, 1, 2, 2, 1, 3}}; }

vec3 placeOf(const scene::Mesh& mesh, const TriangleTable& table, std::uint32_t corner) {
    return mesh.positions[table.sources[corner]];
}

TEST(TriangleTable, EveryTriangleHasItsLastCornerToItself) {
    for (const scene::Mesh& mesh : kMeshes) {
        const TriangleTable table = tableOf(mesh);
        ASSERT_EQ(table.indices.size(), mesh.indices.size());
        ASSERT_EQ(table.sources.size(), table.triangles.size());
        std::set<std::uint32_t> last;
        for (std::size_t i = 0; i < table.indices.size(); i += 3) {
            const std::uint32_t* corner = &table.indices[i];
            EXPECT_TRUE(last.insert(corner[2]).second);
            EXPECT_EQ(table.triangles[corner[2]].corners, (std::array{corner[0], corner[1]}));
            // The same triangle in the same sense, from whichever corner on.
            std::array<std::uint32_t, 3> same{table.sources[corner[0]], table.sources[corner[1]],
                                              table.sources[corner[2]]};
            const auto first = std::find(same.begin(), same.end(), mesh.indices[i]);
            ASSERT_NE(first, same.end());
            std::rotate(same.begin(), first, same.end());
            EXPECT_TRUE(std::equal(same.begin(), same.end(), &mesh.indices[i]));
        }
        for (std::uint32_t i = 0; i < table.triangles.size(); ++i)
            if (last.count(i) == 0) {
                EXPECT_EQ(table.triangles[i].corners, Triangle().corners);
                EXPECT_EQ(table.triangles[i].across, Triangle().across);
            }
    }
}

TEST(TriangleTable, VerticesAreCopiedOnlyWhereThereAreTooFew) {
    // A box has 24 for 12 triangles, a square 4 for 2.
    EXPECT_EQ(tableOf(scene::meshOf(scene::Box{vec3(1)})).sources.size(), 24u);
    EXPECT_EQ(tableOf(square()).sources.size(), 4u);
    // A closed mesh of genus 0 has 2 V - 4 triangles (Euler): every one needs a corner, so there are V - 4
    // copies at least. Taking the first free corner wastes some: measured 1 %.
    const scene::Mesh sphere = scene::meshOf(scene::Sphere{1}, 64);
    const std::size_t triangles = sphere.indices.size() / 3, corners = tableOf(sphere).sources.size();
    ASSERT_EQ(triangles, 2 * sphere.positions.size() - 4);
    EXPECT_GE(corners, triangles);
    EXPECT_LE(double(corners), 1.05 * double(triangles));
}

TEST(TriangleTable, NeighboursShareAnEdgeTheOtherWayRound) {
    for (const scene::Mesh& mesh : kMeshes) {
        const TriangleTable table = tableOf(mesh);
        std::size_t open = 0;
        for (std::size_t i = 0; i < table.indices.size(); i += 3)
            for (std::size_t side = 0; side < 3; ++side) {
                const std::uint32_t number = table.indices[i + 2];
                const std::uint32_t next = table.triangles[number].across[side];
                if (next == kNone) {
                    ++open;
                    continue;
                }
                const vec3 from = placeOf(mesh, table, table.indices[i + side]),
                           to = placeOf(mesh, table, table.indices[i + (side + 1) % 3]);
                const Triangle& other = table.triangles[next];
                const std::array<vec3, 3> corners{placeOf(mesh, table, other.corners[0]),
                                                  placeOf(mesh, table, other.corners[1]),
                                                  placeOf(mesh, table, next)};
                std::size_t back = 0;
                while (back < 3 && other.across[back] != number)
                    ++back;
                ASSERT_LT(back, 3u);
                EXPECT_EQ(corners[back], to);
                EXPECT_EQ(corners[(back + 1) % 3], from);
            }
        // Sharp edges with vertices of their own on each side, as a box has, are none to the walk.
        EXPECT_EQ(open, scene::openEdges(mesh));
    }
}

TEST(TriangleTable, AnOpenMeshEndsAtItsBorder) {
    const TriangleTable table = tableOf(square());
    const std::uint32_t a = table.indices[2], b = table.indices[5];
    EXPECT_EQ(std::count(table.triangles[a].across.begin(), table.triangles[a].across.end(), kNone), 2);
    EXPECT_EQ(std::count(table.triangles[a].across.begin(), table.triangles[a].across.end(), b), 1);
    EXPECT_EQ(std::count(table.triangles[b].across.begin(), table.triangles[b].across.end(), a), 1);
}

TEST(TriangleTable, TrianglesThatLieTheOtherWayRoundAreNoNeighbours) {
    scene::Mesh mesh = square();
    std::swap(mesh.indices[3], mesh.indices[4]);
    const TriangleTable table = tableOf(mesh);
    for (const Triangle& triangle : table.triangles)
        EXPECT_EQ(triangle.across, Triangle().across);
}

TEST(TriangleTable, TrianglesWithoutAreaStandAside) {
    scene::Mesh mesh = square();
    const TriangleTable plain = tableOf(mesh);
    mesh.indices.insert(mesh.indices.begin(), {1, 2, 1, 2, 2, 2});
    const TriangleTable table = tableOf(mesh);
    for (std::size_t i = 0; i < 2; ++i)
        EXPECT_EQ(table.triangles[table.indices[3 * i + 2]].across, Triangle().across);
    const std::uint32_t a = table.indices[8], b = table.indices[11];
    EXPECT_EQ(std::count(table.triangles[a].across.begin(), table.triangles[a].across.end(), b), 1);
    EXPECT_EQ(std::count(table.triangles[b].across.begin(), table.triangles[b].across.end(), a), 1);
}

} // namespace
} // namespace lucent::views
