#include "scene/CoarseMesh.h"
#include "scene/Mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace lucent::scene {
namespace {

// A grid of squares over [-1, 1]^2 with heights from a function; each square is two triangles.
template <class Height>
Mesh gridMesh(int squares, Height height) {
    Mesh mesh;
    for (int y = 0; y <= squares; ++y)
        for (int x = 0; x <= squares; ++x) {
            const float px = 2 * float(x) / float(squares) - 1, py = 2 * float(y) / float(squares) - 1;
            mesh.positions.emplace_back(px, py, height(px, py));
        }
    for (int y = 0; y < squares; ++y)
        for (int x = 0; x < squares; ++x) {
            const auto a = std::uint32_t(y * (squares + 1) + x), b = a + 1,
                       c = a + std::uint32_t(squares) + 1;
            mesh.indices.insert(mesh.indices.end(), {a, b, c + 1, a, c + 1, c});
        }
    return mesh;
}

TEST(MeshDepth, TiltedPlaneIsExactAtTexelCentres) {
    // z = 2x + y over [-1, 1]^2 in 8 x 8 texels without margin: centres at x = -7/8 ... 7/8. z runs from
    // -3 * 7/8 to 3 * 7/8 over the centres, which become the floor gap 0.2 and 1.
    const Mesh mesh = gridMesh(3, [](float x, float y) { return 2 * x + y; });
    const Image image = depthOfMesh(mesh, vec3(0), {8, 8}, 0, 0.2f);
    for (int row = 0; row < 8; ++row)
        for (int column = 0; column < 8; ++column) {
            const double x = -1 + (column + 0.5) / 4, y = 1 - (row + 0.5) / 4;
            const double part = (2 * x + y + 2.625) / 5.25;
            EXPECT_NEAR(*image.at(column, row), 0.2 + 0.8 * part, 1e-6) << column << " " << row;
        }
}

TEST(MeshDepth, SphereIsRoundUpToItsFacets) {
    // A sphere of 512 x 256 facets: the facets lie at most 1 - cos(pi/512) (1 - sagitta) = 4e-5 inside it.
    Mesh mesh;
    constexpr int kColumns = 512, kRows = 256;
    for (int j = 0; j <= kRows; ++j)
        for (int i = 0; i <= kColumns; ++i) {
            const double a = 2 * M_PI * i / kColumns, b = M_PI * j / kRows;
            mesh.positions.emplace_back(std::sin(b) * std::cos(a), std::cos(b), std::sin(b) * std::sin(a));
        }
    for (int j = 0; j < kRows; ++j)
        for (int i = 0; i < kColumns; ++i) {
            const auto a = std::uint32_t(j * (kColumns + 1) + i), c = a + kColumns + 1;
            mesh.indices.insert(mesh.indices.end(), {a, a + 1, c + 1, a, c + 1, c});
        }
    const Image image = depthOfMesh(mesh, vec3(20, 30, 40), {64, 64}, 0, 0); // turning changes nothing
    // Heights are affine in z: fit through the two ends that the picture holds, then compare all.
    const auto zAt = [](int x, int y) {
        const double px = (x + 0.5) / 32 - 1, py = (y + 0.5) / 32 - 1;
        return 1 - px * px - py * py;
    };
    double lowest = 1, highest = 0;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
            if (zAt(x, y) > 1e-3) {
                lowest = std::min(lowest, std::sqrt(zAt(x, y)));
                highest = std::max(highest, std::sqrt(zAt(x, y)));
            }
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            if (zAt(x, y) < -1e-3) {
                EXPECT_EQ(*image.at(x, y), 0.0f) << x << " " << y;
            }
            if (zAt(x, y) > 0.02) { // dz of a facet error e is e / z: at the rim it grows
                EXPECT_NEAR(*image.at(x, y), (std::sqrt(zAt(x, y)) - lowest) / (highest - lowest), 2e-3);
            }
        }
}

TEST(MeshDepth, NoCentreFallsBetweenTriangles) {
    // Vertices lie exactly on texel centres and on lines between them: a crack would leave background 0.
    const Mesh mesh = gridMesh(64, [](float x, float y) { return std::sin(9 * x) * std::cos(7 * y); });
    for (const float angle : {0.0f, 45.0f, 17.0f}) {
        const Image image = depthOfMesh(mesh, {0, 0, angle}, {129, 129}, 0, 0.5f);
        for (int y = 40; y < 89; ++y) // inside the square whatever the angle
            for (int x = 40; x < 89; ++x)
                EXPECT_GE(*image.at(x, y), 0.5f) << angle << ": " << x << " " << y;
    }
}

TEST(MeshDepth, MarginIsAPartOfTheLargerSide) {
    const Mesh mesh = gridMesh(1, [](float, float) { return 0.0f; });
    const Image image = depthOfMesh(mesh, vec3(0), {40, 20}, 0.1f, 0.12f);
    // 0.1 * 40 = 4 texels stay free at each side: the square takes 12 x 12 texels in the middle. A plane seen
    // from straight above has one depth, which is 1.
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 40; ++x)
            EXPECT_EQ(*image.at(x, y), x >= 14 && x < 26 && y >= 4 && y < 16 ? 1.0f : 0.0f);
}

TEST(MeshDepth, RotationTurnsTheMeshBeforeItIsSeen) {
    // A wedge, high at +x. Turned by 90 degrees about z it is high at +y: the top row.
    const Mesh mesh = gridMesh(1, [](float x, float) { return x; });
    const Image straight = depthOfMesh(mesh, vec3(0), {8, 8}, 0, 0),
                turned = depthOfMesh(mesh, {0, 0, 90}, {8, 8}, 0, 0);
    EXPECT_NEAR(*straight.at(7, 3), 1, 1e-6);
    EXPECT_NEAR(*turned.at(3, 0), 1, 1e-6);
    EXPECT_NEAR(*turned.at(3, 7), 0, 1e-6);
}

TEST(MeshDepth, NearerSurfaceHidesTheFartherOne) {
    // Two crossing wedges: what is seen is |x|.
    Mesh mesh = gridMesh(1, [](float x, float) { return x; });
    const Mesh other = gridMesh(1, [](float x, float) { return -x; });
    for (const std::uint32_t index : other.indices)
        mesh.indices.push_back(index + 4);
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    const Image image = depthOfMesh(mesh, vec3(0), {8, 8}, 0, 0);
    for (int x = 0; x < 8; ++x) // |x| at centres: 1/8 is 0, 7/8 is 1
        EXPECT_NEAR(*image.at(x, 4), (std::abs(-1 + (x + 0.5) / 4) - 0.125) / 0.75, 1e-6);
}

TEST(MeshDepth, MovingMeshStandsAsAtTimeZero) {
    // A wedge that its only joint turns by 90 degrees about z: high at +y, the top row.
    Mesh mesh = gridMesh(1, [](float x, float) { return x; });
    mesh.joints.assign(4, {0, 0, 0, 0});
    mesh.jointWeights.assign(4, {1, 0, 0, 0});
    const float half = std::sqrt(0.5f);
    mesh.rig.nodes = {{-1, {}, {half, 0, 0, half}, vec3(1)}};
    mesh.rig.joints = {0};
    mesh.rig.jointFromMesh = {mat4(1)};
    const Image image = depthOfMesh(mesh, vec3(0), {8, 8}, 0, 0);
    EXPECT_NEAR(*image.at(3, 0), 1, 1e-6);
    EXPECT_NEAR(*image.at(3, 7), 0, 1e-6);
}

// --- with fewer triangles

double areaOf(const Mesh& mesh) {
    double area = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const auto at = [&](std::size_t k) { return dvec3(mesh.positions[mesh.indices[i + k]]); };
        area += glm::length(glm::cross(at(1) - at(0), at(2) - at(0))) / 2;
    }
    return area;
}

TEST(CoarseMesh, ASphereStaysOneByTheSameBounds) {
    const Mesh fine = meshOf(Sphere{.radius = 0.5f}, 256), coarse = coarseMesh(fine, 32);
    EXPECT_LT(coarse.indices.size(), fine.indices.size() / 4);
    EXPECT_NEAR(areaOf(coarse) / areaOf(fine), 1, 0.01); // planes a thirtieth wide, and cells where it ends
    vec3 low(1e30f), high(-1e30f);
    for (std::size_t i = 0; i < coarse.positions.size(); ++i) {
        low = glm::min(low, coarse.positions[i]);
        high = glm::max(high, coarse.positions[i]);
        EXPECT_NEAR(glm::length(coarse.normals[i]), 1, 1e-5);
        EXPECT_GT(glm::dot(coarse.normals[i], coarse.positions[i]), 0.49f) << "outwards";
    }
    EXPECT_EQ(low, vec3(-0.5f));
    EXPECT_EQ(high, vec3(0.5f));
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::size_t i = 0; i < coarse.indices.size(); ++i)
        edges.insert({coarse.indices[i], coarse.indices[i % 3 == 2 ? i - 2 : i + 1]});
    for (const auto& [from, to] : edges)
        EXPECT_TRUE(edges.contains({to, from})) << "a hole";
}

TEST(CoarseMesh, ShapesHaveFewerTriangles) {
    const auto meshes = [](const Shape& shape, const auto& change) {
        Scene scene;
        Object& object = scene.objects.emplace_back();
        object.shape = shape;
        change(object);
        const auto fine = meshOf(object);
        coarsen(scene, 64);
        return std::pair(fine, meshOf(scene.objects[0]));
    };
    const auto leave = [](Object&) {};
    for (const Shape& shape : {Shape(Sphere{}), Shape(Torus{}), Shape(Cylinder{}), Shape(Water{})}) {
        const auto [fine, coarse] = meshes(shape, leave);
        EXPECT_LE(coarse->indices.size(), fine->indices.size() / 4) << shape.index();
        EXPECT_NEAR(areaOf(*coarse) / areaOf(*fine), 1, 0.02) << shape.index();
    }
    const auto [flat, asFlat] = meshes(Plane{}, leave);
    HeightField field;
    auto heights = std::make_shared<Image>(256, 128, 1);
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 256; ++x)
            *heights->at(x, y) = 0.5f + 0.4f * std::sin(0.05f * float(x + y));
    field.heights = heights;
    const auto [body, roughBody] = meshes(field, [](Object& one) { one.material.kind = Clear{}; });
    EXPECT_LT(roughBody->indices.size(), body->indices.size() / 3);
    EXPECT_NEAR(areaOf(*roughBody) / areaOf(*body), 1, 0.02);
    EXPECT_EQ(flat, asFlat) << "it is made once";
    const auto [pond, asPond] = meshes(Water{.cells = 32}, leave);
    EXPECT_EQ(pond, asPond);
    auto low = std::make_shared<Image>(64, 64, 1);
    field.heights = low;
    const auto [tile, asTile] = meshes(field, [](Object& one) { one.material.kind = Clear{}; });
    EXPECT_EQ(tile, asTile);
    const auto [baked, asBaked] = meshes(Sphere{}, [](Object& one) { // whose light goes by its vertices
        Translucent inside;
        inside.precomputed = true;
        one.material.kind = inside;
    });
    EXPECT_EQ(baked, asBaked);
    const auto [bent, bentLess] = meshes(Plane{}, [](Object& one) { one.wave.amplitude = vec3(0, 0.1f, 0); });
    EXPECT_EQ(bentLess->indices.size(), 64u * 64 * 6);
    EXPECT_GT(bent->indices.size(), bentLess->indices.size());
    // What is clear bends light as a ball of its size does.
    const auto [ball, roughBall] = meshes(Sphere{}, [](Object& one) { one.material.kind = Clear{}; });
    EXPECT_LT(roughBall->indices.size(), ball->indices.size());
    EXPECT_NEAR(areaOf(*roughBall) / areaOf(*ball), 1, 0.003);
}

TEST(CoarseMesh, OnlyWhatNothingElseGoesByIsMadeCoarse) {
    const auto fine = std::make_shared<Mesh>(meshOf(Sphere{.radius = 0.5f}, 256));
    const auto trianglesOf = [&](const auto& change) {
        Scene scene;
        Object& object = scene.objects.emplace_back();
        object.shape.emplace<MeshShape>().mesh = fine;
        object.material.kind = Clear{};
        change(object);
        coarsen(scene, 32);
        return std::get<MeshShape>(scene.objects[0].shape).mesh->indices.size();
    };
    EXPECT_LT(trianglesOf([](Object&) {}), fine->indices.size() / 4);
    EXPECT_EQ(trianglesOf([](Object& one) { one.material.kind = Translucent{}; }), fine->indices.size());
    EXPECT_EQ(trianglesOf([](Object& one) { one.displacement.emplace(); }), fine->indices.size());
    EXPECT_EQ(trianglesOf([](Object& one) { std::get<MeshShape>(one.shape).flatNormals = true; }),
              fine->indices.size());
    auto textured = std::make_shared<Mesh>(*fine);
    textured->coordinates.resize(textured->positions.size());
    EXPECT_EQ(trianglesOf([&](Object& one) { std::get<MeshShape>(one.shape).mesh = textured; }),
              fine->indices.size());
}

} // namespace
} // namespace lucent::scene
