#include "tests/throughput/Shapes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lucent::throughput {
namespace {

using namespace shapes;

double sumOf(const Rows<float>& rows, std::size_t row) {
    double sum = 0;
    for (std::uint32_t k = rows.starts[row]; k < rows.starts[row + 1]; ++k)
        sum += double(rows.values[k]);
    return sum;
}

// Every dual basis function integrates to 1, and what texels have of the surface is all of it.
void expectWhole(const Surface& surface) {
    double worst = 0, own = 0;
    for (std::size_t v = 0; v < surface.hats.count(); ++v)
        worst = std::max(worst, std::abs(sumOf(surface.duals, v) - 1));
    EXPECT_LT(worst, 2e-4); // places in the atlas are floats
    for (const Texel& texel : surface.texels.list)
        own += double(texel.own);
    EXPECT_NEAR(own / surface.hats.area(), 1, 1e-5);
}

// A box with a needle of a triangle along an edge's middle, triangles far smaller than a texel, vertices that
// no triangle has, and one without an area.
scene::Mesh hardMesh() {
    scene::Mesh mesh = scene::meshOf(scene::Box{{1, 2, 3}}, 4);
    const auto add = [&](vec3 a, vec3 b, vec3 c) {
        for (const vec3& p : {a, b, c}) {
            mesh.indices.push_back(std::uint32_t(mesh.positions.size()));
            mesh.positions.push_back(p);
            mesh.normals.push_back({0, 1, 0});
        }
    };
    add({4, 0, 0}, {5, 0, 0}, {4.5f, 1e-5f, 0});
    add({6, 0, 0}, {6 + 1e-4f, 0, 0}, {6, 1e-4f, 0});
    add({7, 0, 0}, {8, 0, 0}, {7.5f, 0, 0}); // no area
    mesh.positions.push_back({9, 9, 9});     // of no triangle
    mesh.normals.push_back({0, 1, 0});
    return mesh;
}

TEST(Surface, EachDualBasisFunctionIntegratesToOne) {
    for (const int side : {96, 200}) {
        expectWhole(surfaceFrom(scene::meshOf(scene::Sphere{1}, 24), side));
        expectWhole(surfaceFrom(scene::meshOf(scene::Torus{1, 0.4f}, 24), side));
        expectWhole(surfaceFrom(patch(1, 7), side));
    }
    expectWhole(surfaceFrom(scene::meshOf(scene::Sphere{1}, 300), 96)); // many triangles a texel
}

TEST(Surface, BearsNeedlesSpecksAndWhatHasNoArea) {
    const Surface surface = surfaceFrom(hardMesh());
    expectWhole(surface);
    for (const vec3& p : surface.hats.positions) {
        EXPECT_NE(p, vec3(9));
        EXPECT_FALSE(p.x > 6.5f) << "of a triangle without area";
    }
    for (const Texel& texel : surface.texels.list) {
        EXPECT_TRUE(std::isfinite(texel.area) && texel.area >= 0);
        EXPECT_TRUE(std::isfinite(texel.place.weights.x));
        EXPECT_GE(std::min({texel.place.weights.x, texel.place.weights.y, texel.place.weights.z}), -1e-4f);
    }
}

TEST(Surface, DualsFindTheVertexValuesOfLinearLight) {
    const Surface surface = surfaceFrom(patch(1, 8));
    const auto irradiance = lit(surface, [](const vec3& p) { return 2 + p.x - 3 * p.y; });
    for (std::size_t v = 0; v < surface.hats.count(); ++v) {
        double found = 0;
        for (std::uint32_t k = surface.duals.starts[v]; k < surface.duals.starts[v + 1]; ++k)
            found += double(surface.duals.values[k] * irradiance[surface.duals.columns[k]].x);
        const vec3 p = surface.hats.positions[v];
        EXPECT_NEAR(found, 2 + p.x - 3 * p.y, 0.06); // of 4: what is even on a texel of 1/120 is not linear
    }
}

// Places within the border are there, and through space no farther than charts foreshorten them.
TEST(Surface, ChartsHaveBordersInWhichTheSurfaceGoesOn) {
    constexpr int kBorder = 4;
    const Surface surface = surfaceFrom(scene::meshOf(scene::Sphere{1}, 48), 200, kBorder);
    std::size_t missing = 0, far = 0, own = 0;
    for (const Texel& texel : surface.texels.list) {
        if (texel.own == 0) continue;
        ++own;
        const vec3 place = positionAt(surface.hats, texel.place);
        for (int y = -kBorder; y <= kBorder; ++y)
            for (int x = -kBorder; x <= kBorder; ++x) {
                const int index = surface.texels.find(texel.at + ivec2(x, y));
                if (index < 0) {
                    ++missing;
                    continue;
                }
                const vec3 other = positionAt(surface.hats, surface.texels.list[std::size_t(index)].place);
                if (glm::distance(other, place) > 1.25f * glm::length(vec2(x, y)) * surface.texels.size)
                    ++far;
            }
    }
    EXPECT_GT(own, 8000u); // of 40,000
    EXPECT_EQ(missing, 0u);
    EXPECT_LT(far, own / 100); // of 81 pairs each: where three charts meet the surface unfolds two ways
}

// Texels beside each other show places one texel apart, over an edge too, where that is a right angle.
TEST(Surface, FollowsABoxAroundItsEdges) {
    const Surface surface = surfaceFrom(scene::meshOf(scene::Box{{1, 1, 1}}, 3), 128, 4);
    std::size_t wrong = 0, pairs = 0, around = 0;
    for (const Texel& texel : surface.texels.list) {
        const int next = surface.texels.find(texel.at + ivec2(1, 0));
        if (texel.own == 0 || next < 0) continue;
        const Texel& other = surface.texels.list[std::size_t(next)];
        const vec3 a = positionAt(surface.hats, texel.place), b = positionAt(surface.hats, other.place);
        const vec3 toCorner = vec3(0.5f) - glm::abs(a);
        if (std::max({toCorner.x, toCorner.y, toCorner.z}) < 2 * surface.texels.size)
            continue; // faces meet thrice
        ++pairs;
        around += other.own == 0;
        const float way = glm::distance(a, b) / surface.texels.size;
        if (way < 0.7f || way > 1.01f) ++wrong;
    }
    EXPECT_GT(pairs, 5000u);
    EXPECT_GT(around, 50u);
    EXPECT_EQ(wrong, 0u);
}

} // namespace
} // namespace lucent::throughput
