#include "scene/Atlas.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace lucent::scene {
namespace {

std::shared_ptr<const Mesh> share(Mesh mesh) { return std::make_shared<const Mesh>(std::move(mesh)); }

std::shared_ptr<const Atlas> laidOut(const std::shared_ptr<const Mesh>& mesh, int side) {
    const auto atlas = atlasOf(*mesh, side);
    EXPECT_TRUE(atlas) << atlas.error().message;
    return *atlas;
}

// Charts as numbers of the triangles: those that share vertices of the atlas.
std::vector<std::size_t> chartsOf(const Atlas& atlas) {
    std::vector<std::size_t> parent(atlas.places.size());
    for (std::size_t i = 0; i < parent.size(); ++i)
        parent[i] = i;
    const auto find = [&](std::size_t i) {
        while (parent[i] != i)
            i = parent[i] = parent[parent[i]];
        return i;
    };
    const std::vector<std::uint32_t>& corners = atlas.mesh->indices;
    for (std::size_t i = 0; i < corners.size(); ++i)
        parent[find(corners[i])] = find(corners[i - i % 3]);
    std::vector<std::size_t> charts;
    for (std::size_t i = 0; i < corners.size(); i += 3)
        charts.push_back(find(corners[i]));
    return charts;
}

std::size_t chartCount(const Atlas& atlas) {
    const std::vector<std::size_t> charts = chartsOf(atlas);
    return std::set(charts.begin(), charts.end()).size();
}

std::array<dvec2, 3> placesOf(const Atlas& atlas, std::size_t triangle) {
    std::array<dvec2, 3> places;
    for (std::size_t i = 0; i < 3; ++i)
        places[i] = dvec2(atlas.places[atlas.mesh->indices[3 * triangle + i]]);
    return places;
}

double twiceArea(const dvec2& a, const dvec2& b, const dvec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// A place is inside by more than rounding.
bool contains(const std::array<dvec2, 3>& t, const dvec2& p) {
    const double area = twiceArea(t[0], t[1], t[2]), least = 1e-3 * std::abs(area);
    const double sign = area < 0 ? -1 : 1;
    return sign * twiceArea(t[0], t[1], p) > least && sign * twiceArea(t[1], t[2], p) > least &&
           sign * twiceArea(t[2], t[0], p) > least;
}

double distanceToSegment(const dvec2& a, const dvec2& b, const dvec2& p) {
    const dvec2 way = b - a;
    const double length = glm::dot(way, way);
    const double t = length > 0 ? glm::clamp(glm::dot(p - a, way) / length, 0.0, 1.0) : 0.0;
    return glm::length(p - a - t * way);
}

// Each texel's middle lies in one triangle at most, and what bilinear reading of one chart takes is no
// other's.
void expectNoTwoMeet(const Atlas& atlas) {
    const int side = atlas.side;
    std::vector<int> owner(std::size_t(side * side), -1);
    std::vector<std::size_t> reader(owner.size(), ~std::size_t(0));
    const std::vector<std::size_t> charts = chartsOf(atlas);
    std::size_t twice = 0, crossed = 0, outside = 0;
    for (std::size_t t = 0; t < charts.size(); ++t) {
        const auto places = placesOf(atlas, t);
        if (std::abs(twiceArea(places[0], places[1], places[2])) < 1e-6) continue; // shows nothing
        const dvec2 low = glm::min(glm::min(places[0], places[1]), places[2]),
                    high = glm::max(glm::max(places[0], places[1]), places[2]);
        for (int y = int(low.y - 1); y <= int(high.y + 1); ++y)
            for (int x = int(low.x - 1); x <= int(high.x + 1); ++x) {
                const dvec2 middle(x + 0.5, y + 0.5);
                const bool inside = contains(places, middle);
                double away = inside ? 0 : 1e30;
                for (std::size_t i = 0; i < 3; ++i)
                    away = std::min(away, distanceToSegment(places[i], places[(i + 1) % 3], middle));
                if (away >= 0.999) continue; // not read by all places of it: along an axis at most a texel
                if (x < 0 || y < 0 || x >= side || y >= side) {
                    ++outside;
                    continue;
                }
                const std::size_t index = std::size_t(y * side + x);
                if (reader[index] != ~std::size_t(0) && reader[index] != charts[t]) ++crossed;
                reader[index] = charts[t];
                if (inside && std::exchange(owner[index], int(t)) != -1) ++twice;
            }
    }
    EXPECT_EQ(twice, 0u) << "texels with two triangles";
    EXPECT_EQ(crossed, 0u) << "texels that two charts read";
    EXPECT_EQ(outside, 0u) << "texels outside the picture";
}

// A chart looks along an axis i that its triangles face by 60 degrees or less; it shows |n_i| of their areas.
void expectOneScale(const Atlas& atlas) {
    const auto normalOf = [&](std::size_t t) { // twice as long as the triangle is large
        const auto at = [&](std::size_t i) {
            return dvec3(atlas.mesh->positions[atlas.mesh->indices[3 * t + i]]);
        };
        return glm::cross(at(1) - at(0), at(2) - at(0));
    };
    const auto texelsOf = [&](std::size_t t) {
        const auto [a, b, c] = placesOf(atlas, t);
        return std::abs(twiceArea(a, b, c));
    };
    const std::size_t count = atlas.mesh->indices.size() / 3;
    double scale = 0; // texels a square metre, of triangles that face their axis
    for (std::size_t t = 0; t < count; ++t)
        if (const double area = glm::length(normalOf(t)); area > 0 && texelsOf(t) > 0.1)
            scale = std::max(scale, texelsOf(t) / area);
    std::size_t wrong = 0;
    for (std::size_t t = 0; t < count; ++t) {
        const dvec3 normal = normalOf(t);
        bool right = texelsOf(t) < 0.1; // places are floats
        for (int i = 0; i < 3; ++i)
            right = right || (std::abs(normal[i]) > 0.499 * glm::length(normal) &&
                              std::abs(texelsOf(t) / (scale * std::abs(normal[i])) - 1) < 0.01);
        wrong += !right;
    }
    EXPECT_EQ(wrong, 0u) << "of " << count << " triangles";
}

TEST(Atlas, PlaneIsOneChartThatFillsThePicture) {
    const auto mesh = share(meshOf(Plane{{3, 3}}, 4));
    const auto atlas = laidOut(mesh, 100);
    EXPECT_EQ(chartCount(*atlas), 1u);
    EXPECT_EQ(atlas->mesh->indices, mesh->indices); // nothing is parted
    for (std::size_t i = 0; i < mesh->positions.size(); ++i) {
        const vec3 p = mesh->positions[i]; // seen from above: x to the right, z down, a texel around
        EXPECT_NEAR(atlas->places[i].x, 1 + 98 * (p.x + 1.5f) / 3, 1e-3);
        EXPECT_NEAR(atlas->places[i].y, 1 + 98 * (p.z + 1.5f) / 3, 1e-3);
    }
}

TEST(Atlas, ChartsOfShapesNeverMeet) {
    const std::pair<const char*, Mesh> shapes[] = {
        {"sphere", meshOf(Sphere{1}, 48)},        {"torus", meshOf(Torus{1, 0.4f}, 48)},
        {"horn", meshOf(Torus{1, 1}, 48)},        {"box", meshOf(Box{{1, 2, 3}}, 3)},
        {"cylinder", meshOf(Cylinder{1, 2}, 32)}, {"ring", meshOf(Cylinder{1, 0.2f, true}, 32)}};
    for (const auto& [name, mesh] : shapes)
        for (const int side : {64, 201}) {
            SCOPED_TRACE(std::string(name) + " on " + std::to_string(side));
            const auto atlas = laidOut(share(mesh), side);
            expectNoTwoMeet(*atlas);
            expectOneScale(*atlas);
            EXPECT_LE(chartCount(*atlas), 24u);
        }
}

TEST(Atlas, KeepsTrianglesNormalsAndRig) {
    Mesh mesh = meshOf(Sphere{0.5f}, 16);
    const std::size_t count = mesh.positions.size();
    for (std::size_t i = 0; i < count; ++i) {
        mesh.joints.push_back({std::uint16_t(i), 0, 0, 0});
        mesh.jointWeights.push_back({1, 0, 0, float(i)});
    }
    mesh.rig.targets.push_back({mesh.positions, mesh.normals});
    const auto source = share(mesh);
    const auto atlas = laidOut(source, 64);
    const Mesh& parted = *atlas->mesh;
    ASSERT_EQ(parted.indices.size(), mesh.indices.size());
    ASSERT_GT(parted.positions.size(), count);
    for (const std::size_t size :
         {parted.normals.size(), parted.joints.size(), parted.jointWeights.size(),
          parted.rig.targets[0].positions.size(), parted.rig.targets[0].normals.size(), atlas->places.size()})
        EXPECT_EQ(size, parted.positions.size());
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint32_t a = mesh.indices[i], b = parted.indices[i];
        ASSERT_EQ(mesh.positions[a], parted.positions[b]);
        ASSERT_EQ(mesh.normals[a], parted.normals[b]);
        ASSERT_EQ(mesh.joints[a], parted.joints[b]);
        ASSERT_EQ(mesh.jointWeights[a], parted.jointWeights[b]);
        ASSERT_EQ(mesh.rig.targets[0].positions[a], parted.rig.targets[0].positions[b]);
    }
    EXPECT_EQ(laidOut(share(mesh), 64)->places, atlas->places);
}

TEST(Atlas, IsMadeOnceForAnObjectAndItsCopiesAndGoesWithThem) {
    std::weak_ptr<const Atlas> made;
    {
        Object copy;
        {
            Object object;
            object.shape = Box{};
            copy = object;
            made = *atlasOf(object, 64);
            EXPECT_EQ(*atlasOf(object, 64), made.lock());
            EXPECT_NE(*atlasOf(object, 128), made.lock());
        }
        EXPECT_EQ(*atlasOf(copy, 64), made.lock());
        copy.shape = Box{{1, 2, 3}};
        EXPECT_NE(*atlasOf(copy, 64), made.lock());
    }
    EXPECT_TRUE(made.expired());
}

// A ribbon that winds up around y twice, as steep as charts bear, so that it lies over itself seen from
// above.
TEST(Atlas, PartsWhatLiesOverItself) {
    Mesh ramp;
    constexpr int kSteps = 64;
    for (int i = 0; i <= kSteps; ++i) {
        const float turn = 4 * kPi * float(i) / kSteps, height = float(i) / kSteps;
        for (const float radius : {0.5f, 1.0f})
            ramp.positions.push_back({radius * std::cos(turn), height, -radius * std::sin(turn)});
    }
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const std::uint32_t a = 2 * i;
        ramp.indices.insert(ramp.indices.end(), {a, a + 1, a + 3, a, a + 3, a + 2});
    }
    const auto atlas = laidOut(share(ramp), 64);
    EXPECT_GE(chartCount(*atlas), 2u);
    EXPECT_LE(chartCount(*atlas), 8u);
    expectNoTwoMeet(*atlas);
}

TEST(Atlas, BearsTrianglesWithoutAreaAndSeveralComponents) {
    Mesh mesh = meshOf(Box{{1, 1, 1}});
    const auto add = [&](vec3 a, vec3 b, vec3 c) {
        for (const vec3& p : {a, b, c}) {
            mesh.indices.push_back(std::uint32_t(mesh.positions.size()));
            mesh.positions.push_back(p);
            mesh.normals.push_back({0, 1, 0});
        }
    };
    add({0, 3, 0}, {0, 3, 0}, {0, 3, 0});                          // a point
    add({0, 4, 0}, {1, 4, 0}, {0.3f, 4, 0});                       // a line
    add({-0.5f, 0.5f, 0.5f}, {0.5f, 0.5f, 0.5f}, {0, 0.5f, 0.5f}); // on an edge of the box
    add({5, 0, 0}, {6, 0, 0}, {5, 0, -1});                         // apart
    const auto atlas = laidOut(share(mesh), 64);
    expectNoTwoMeet(*atlas);
    for (const vec2& place : atlas->places) {
        EXPECT_TRUE(place.x >= 0 && place.x <= 64 && place.y >= 0 && place.y <= 64);
    }
}

// Charts across the mean of their normals, and free texels around each.
TEST(Atlas, FittedChartsFaceTheirTrianglesWithinTheirAngleAndKeepTheirBorders) {
    const double cosine = std::cos(glm::radians(30.0));
    const Mesh mesh = meshOf(Sphere{1}, 48);
    const auto found = atlasOf(mesh, Charting{.side = 256, .cosine = cosine, .border = 4, .fitted = true});
    ASSERT_TRUE(found) << found.error().message;
    const Atlas& atlas = **found;
    expectNoTwoMeet(atlas);
    EXPECT_LE(chartCount(atlas), 30u); // caps of 30 degrees hold 1/15 of a sphere
    const std::vector<std::size_t> charts = chartsOf(atlas);
    std::vector<std::size_t> owner(256 * 256, ~std::size_t(0));
    std::size_t shrunk = 0, crowded = 0;
    for (std::size_t t = 0; t < charts.size(); ++t) {
        const auto places = placesOf(atlas, t);
        const auto at = [&](std::size_t i) {
            return dvec3(atlas.mesh->positions[atlas.mesh->indices[3 * t + i]]);
        };
        const double area = glm::length(glm::cross(at(1) - at(0), at(2) - at(0))) * atlas.scale * atlas.scale;
        if (std::abs(twiceArea(places[0], places[1], places[2])) < (cosine - 1e-3) * area) ++shrunk;
        for (const dvec2& place : places)
            for (int y = -4; y <= 4; ++y)
                for (int x = -4; x <= 4; ++x) {
                    const ivec2 texel = ivec2(place) + ivec2(x, y);
                    if (texel.x < 0 || texel.y < 0 || texel.x >= 256 || texel.y >= 256) {
                        ++crowded;
                        continue;
                    }
                    if (x * x + y * y > 12) continue;
                    std::size_t& known = owner[std::size_t(texel.y * 256 + texel.x)];
                    if (known != ~std::size_t(0) && known != charts[t]) ++crowded;
                    known = charts[t];
                }
    }
    EXPECT_EQ(shrunk, 0u);
    EXPECT_EQ(crowded, 0u);
}

TEST(Atlas, FittedChartsAreTurnedToTheSmallestBox) {
    Mesh plank = meshOf(Plane{{4, 0.5f}}, 4);
    for (vec3& p : plank.positions) // turned by 30 degrees in its plane
        p = {0.8660254f * p.x - 0.5f * p.z, 0, 0.5f * p.x + 0.8660254f * p.z};
    const auto atlas = atlasOf(plank, Charting{.side = 128, .cosine = 0.9, .border = 2, .fitted = true});
    ASSERT_TRUE(atlas);
    EXPECT_NEAR((*atlas)->scale, 124.0 / 4, 0.1); // it fills the picture from side to side
}

TEST(Atlas, SaysWhenThePictureIsTooSmall) {
    Mesh mesh;
    for (int i = 0; i < 40; ++i) {
        const auto first = std::uint32_t(mesh.positions.size());
        for (const vec3& p : {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)})
            mesh.positions.push_back(p + vec3(0, 0, float(i)));
        mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2});
    }
    const auto atlas = atlasOf(mesh, 16); // 25 boxes of 3 x 3
    ASSERT_FALSE(atlas);
    EXPECT_EQ(atlas.error().message,
              "the mesh falls into 40 charts, too many for a picture of 16 texels a side; must be larger");
}

} // namespace
} // namespace lucent::scene
