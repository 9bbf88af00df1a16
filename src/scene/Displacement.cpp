#include "scene/Displacement.h"

#include "base/Text.h"
#include "scene/Keys.h"
#include "scene/Mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace lucent::scene {
namespace {

using std::numbers::pi;
using Corner = std::uint32_t;

// As many as keep a silhouette within some thousandths of a radius of the curve.
constexpr int kAroundSphere = 48, kAroundTorus = 72;

constexpr std::string_view kMethods[] = {"parallax", "linear", "relief", "interval", "quadtree"};

struct Base {
    Mesh mesh;
    std::vector<std::array<vec2, 3>> coordinates; // of each triangle
};

// Angle of a place around the y axis in turns, [0,1), counter-clockwise seen from above.
double turnOf(const vec3& place) {
    const double angle = std::atan2(-double(place.z), double(place.x)) / (2 * pi);
    return angle < 0 ? angle + 1 : angle;
}

// Angles of a triangle's corners as neighbours see them: no two of them are more than half a turn apart.
void unroll(std::array<vec2, 3>& coordinates, int axis) {
    for (std::size_t i = 1; i < 3; ++i) {
        float& turn = coordinates[i][axis];
        turn -= std::round(turn - coordinates[0][axis]);
    }
}

Base withoutCoordinates(Mesh mesh) { return {std::move(mesh), {}}; }

template <class Coordinate>
Base withCoordinates(Mesh mesh, const Coordinate& coordinateOf) {
    Base base = withoutCoordinates(std::move(mesh));
    const std::vector<Corner>& indices = base.mesh.indices;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3)
        base.coordinates.push_back(
            {coordinateOf(indices[i]), coordinateOf(indices[i + 1]), coordinateOf(indices[i + 2])});
    return base;
}

Base baseOf(const Plane& plane) {
    Mesh mesh = meshOf(plane);
    const std::vector<vec3> places = mesh.positions;
    return withCoordinates(std::move(mesh),
                           [&](Corner i) { return vec2(places[i].x, places[i].z) / plane.size + 0.5f; });
}

Base baseOf(const Sphere& sphere) {
    Mesh mesh = meshOf(sphere, kAroundSphere);
    const std::vector<vec3> normals = mesh.normals;
    const auto isPole = [&](Corner i) { return normals[i].x == 0 && normals[i].z == 0; };
    Base base = withCoordinates(std::move(mesh), [&](Corner i) {
        return vec2(turnOf(normals[i]), std::acos(std::clamp(double(normals[i].y), -1.0, 1.0)) / pi);
    });
    for (std::size_t t = 0; t < base.coordinates.size(); ++t) {
        auto& coordinates = base.coordinates[t];
        for (std::size_t i = 0; i < 3; ++i)
            if (isPole(base.mesh.indices[3 * t + i])) { // has every angle: that of the two others' middle
                std::array<vec2, 3> others{coordinates[(i + 1) % 3], coordinates[(i + 2) % 3],
                                           coordinates[(i + 2) % 3]};
                unroll(others, 0);
                coordinates[i].x = 0.5f * (others[0].x + others[1].x);
            }
        unroll(coordinates, 0);
    }
    return base;
}

Base baseOf(const Torus& torus) {
    Mesh mesh = meshOf(torus, kAroundTorus);
    const std::vector<vec3> places = mesh.positions, normals = mesh.normals;
    Base base = withCoordinates(std::move(mesh), [&](Corner i) {
        const double out = std::hypot(double(places[i].x), double(places[i].z)) - double(torus.major);
        const double around = std::atan2(-double(normals[i].y), out) / (2 * pi);
        return vec2(turnOf(places[i]), around < 0 ? around + 1 : around);
    });
    for (auto& coordinates : base.coordinates) {
        unroll(coordinates, 0);
        unroll(coordinates, 1);
    }
    return base;
}

Base baseOf(const MeshShape& shape) {
    Mesh mesh = *shape.mesh;
    if (mesh.normals.empty()) mesh.normals = areaWeightedNormals(mesh.positions, mesh.indices);
    const std::vector<vec2> coordinates = mesh.coordinates;
    return withCoordinates(std::move(mesh), [&](Corner i) { return coordinates[i]; });
}

template <class Shape>
Base baseOf(const Shape&) {
    return {};
} // refused by checkDisplacement()

// Of each vertex the mean normal of all at its place.
std::vector<vec3> sharedNormals(const Mesh& mesh, const std::vector<Corner>& welded) {
    std::vector<vec3> sums(mesh.positions.size(), vec3(0));
    std::map<std::pair<Corner, std::array<float, 3>>, bool> counted; // each normal once a place
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        const vec3& normal = mesh.normals[i];
        if (counted.emplace(std::pair(welded[i], std::array{normal.x, normal.y, normal.z}), true).second)
            sums[welded[i]] += normal;
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const vec3 sum = sums[welded[i]];
        sums[i] = glm::length(sum) > 1e-4f ? glm::normalize(sum) : mesh.normals[i];
    }
    return sums;
}

// The map between copies of itself.
std::shared_ptr<const Image> tiled(const Image& heights) {
    Image wide(heights.width + 2, heights.height + 2, 1);
    for (int y = 0; y < wide.height; ++y)
        for (int x = 0; x < wide.width; ++x)
            *wide.at(x, y) = *heights.at((x + heights.width - 1) % heights.width,
                                         (y + heights.height - 1) % heights.height);
    return std::make_shared<const Image>(std::move(wide));
}

// Whether coordinates find the same place of a tile.
bool areSameTexels(const vec2& a, const vec2& b) {
    const vec2 apart = a - b - glm::round(a - b);
    return glm::length(apart) < 1e-4f;
}

DisplacedBase assembled(const Object& object) {
    const Displacement& displacement = *object.displacement;
    const Base base = std::visit([](const auto& shape) { return baseOf(shape); }, object.shape);
    const Mesh& mesh = base.mesh;
    const std::vector<Corner> welded = weldedVertices(mesh.positions);
    const std::vector<vec3> normals = sharedNormals(mesh, welded);
    DisplacedBase made{.heights = tiled(*displacement.heights)};
    made.highest = *std::max_element(made.heights->pixels.begin(), made.heights->pixels.end());
    // By their ends, where each stands in its direction: coordinates there.
    std::map<std::pair<Corner, Corner>, std::array<vec2, 2>> edges;
    const auto cornersOf = [&](std::size_t t) {
        return std::array{mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]};
    };
    const auto isFlat = [&](const std::array<Corner, 3>& at) { // of no area
        const vec3 a = mesh.positions[at[0]];
        return glm::cross(mesh.positions[at[1]] - a, mesh.positions[at[2]] - a) == vec3(0);
    };
    for (std::size_t t = 0; t < base.coordinates.size(); ++t)
        for (std::size_t i = 0; i < 3; ++i)
            if (const auto at = cornersOf(t); !isFlat(at))
                edges[{welded[at[i]], welded[at[(i + 1) % 3]]}] = {
                    base.coordinates[t][i] * displacement.repeat,
                    base.coordinates[t][(i + 1) % 3] * displacement.repeat};
    for (std::size_t t = 0; t < base.coordinates.size(); ++t) {
        const auto at = cornersOf(t);
        if (isFlat(at)) continue;
        DisplacedTriangle triangle;
        triangle.vertices = at;
        for (std::size_t i = 0; i < 3; ++i) {
            triangle.places[i] = mesh.positions[at[i]];
            triangle.directions[i] = normals[at[i]];
            triangle.coordinates[i] = base.coordinates[t][i] * displacement.repeat;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = (i + 1) % 3;
            const auto beside = edges.find({welded[at[j]], welded[at[i]]});
            made.closed &= beside != edges.end();
            if (beside == edges.end() || !areSameTexels(triangle.coordinates[i], beside->second[1]) ||
                !areSameTexels(triangle.coordinates[j], beside->second[0]))
                triangle.walls |= 1u << i;
        }
        made.triangles.push_back(triangle);
    }
    return made;
}

// What a base depends on.
struct BaseSource {
    Shape shape;
    std::shared_ptr<const Image> heights;
    vec2 repeat;
    bool operator==(const BaseSource&) const = default;
};

double heightAt(const Image& tile, dvec2 coordinate) { // of DisplacedBase::heights
    const dvec2 texels(tile.width - 2, tile.height - 2);
    const dvec2 at = (coordinate - glm::floor(coordinate)) * texels + 0.5;
    const ivec2 low(glm::floor(at));
    const dvec2 f = at - dvec2(low);
    const auto stored = [&](int x, int y) { return double(*tile.at(low.x + x, low.y + y)); };
    return glm::mix(glm::mix(stored(0, 0), stored(1, 0), f.x), glm::mix(stored(0, 1), stored(1, 1), f.x),
                    f.y);
}

} // namespace

std::shared_ptr<const DisplacedBase> baseOf(const Object& object) {
    const Displacement& displacement = *object.displacement;
    return object.kept.of<std::shared_ptr<const DisplacedBase>>(
        BaseSource{object.shape, displacement.heights, displacement.repeat},
        [&] { return std::make_shared<const DisplacedBase>(assembled(object)); });
}

Mesh displacedMesh(const Object& object) {
    const std::shared_ptr<const DisplacedBase> base = baseOf(object);
    const double scale = double(object.displacement->scale);
    const dvec2 texels(base->heights->width - 2, base->heights->height - 2);
    double texelArea = 0;
    for (const DisplacedTriangle& one : base->triangles) {
        const dvec2 first = dvec2(one.coordinates[1] - one.coordinates[0]) * texels,
                    second = dvec2(one.coordinates[2] - one.coordinates[0]) * texels;
        texelArea += 0.5 * std::abs(first.x * second.y - first.y * second.x);
    }
    const double count = std::max(1.0, double(base->triangles.size()));
    const double wanted = std::min(2 * texelArea, double(kMostDisplacedTriangles));
    const int cuts = std::max(1, int(std::ceil(std::sqrt(wanted / count)))); // the same for all: edges meet
    Mesh mesh;
    std::map<std::array<float, 3>, vec3> standing;
    for (const DisplacedTriangle& one : base->triangles) {
        const auto first = std::uint32_t(mesh.positions.size());
        const auto row = [&](int j) { return first + std::uint32_t(j * (2 * cuts + 3 - j) / 2); };
        for (int j = 0; j <= cuts; ++j)
            for (int i = 0; i + j <= cuts; ++i) {
                const dvec3 weights = dvec3(cuts - i - j, i, j) / double(cuts);
                dvec3 place(0), direction(0);
                dvec2 coordinate(0);
                for (int k = 0; k < 3; ++k) {
                    place += weights[k] * dvec3(one.places[std::size_t(k)]);
                    direction += weights[k] * dvec3(one.directions[std::size_t(k)]);
                    coordinate += weights[k] * dvec2(one.coordinates[std::size_t(k)]);
                }
                // At one place of the base stands one vertex, whatever triangle comes first.
                const vec3 lifted(place + scale * heightAt(*base->heights, coordinate) * direction);
                const vec3 foot(place);
                mesh.positions.push_back(
                    standing.emplace(std::array{foot.x, foot.y, foot.z}, lifted).first->second);
                mesh.coordinates.emplace_back(coordinate);
            }
        for (int j = 0; j < cuts; ++j)
            for (int i = 0; i + j < cuts; ++i) {
                const std::uint32_t a = row(j) + std::uint32_t(i), b = row(j + 1) + std::uint32_t(i);
                mesh.indices.insert(mesh.indices.end(), {a, a + 1, b});
                if (i + j + 1 < cuts) mesh.indices.insert(mesh.indices.end(), {a + 1, b + 1, b});
            }
    }
    const std::vector<std::uint32_t> welded = weldedVertices(mesh.positions);
    std::vector<std::uint32_t> shared;
    for (const std::uint32_t index : mesh.indices)
        shared.push_back(welded[index]);
    const std::vector<vec3> normals = areaWeightedNormals(mesh.positions, shared);
    for (const std::uint32_t first : welded)
        mesh.normals.push_back(normals[first]);
    return mesh;
}

Status checkDisplacement(const Object& object) {
    const Displacement& displacement = *object.displacement;
    const auto [lowest, highest] =
        std::minmax_element(displacement.heights->pixels.begin(), displacement.heights->pixels.end());
    if (*lowest < 0 || *highest > 1)
        return Error{"heights lie from " + shortest(*lowest) + " to " + shortest(*highest) +
                     "; must lie from 0 to 1"};
    const auto* file = std::get_if<MeshShape>(&object.shape);
    if (file && file->mesh->coordinates.empty())
        return Error{"heights stand on a mesh without texture coordinates; must stand on one with them"};
    if (file && file->mesh->moves())
        return Error{"heights stand on a mesh that moves; must stand on one that stands still"};
    return Done{};
}

const ParamTable& displacementParams() {
    static const Param params[] = {
        declare(&Displacement::scale, {.id = "scale",
                                       .label = "Height",
                                       .unit = "m",
                                       .min = 0,
                                       .max = kLargest,
                                       .high = 0.3,
                                       .group = Group::Displacement,
                                       .doc = "How far from the surface a height of 1 stands."}),
        declare(&Displacement::repeat, {.id = "repeat",
                                        .label = "Tiles",
                                        .min = kAboveZero,
                                        .max = 1000,
                                        .low = 1,
                                        .high = 16,
                                        .group = Group::Displacement,
                                        .doc = "How often the map of heights lies along u and along v.",
                                        .pair = true}),
        declare(&Displacement::method,
                {.id = "method",
                 .label = "Ray cast",
                 .group = Group::Displacement,
                 .doc = "How an eye ray finds the surface. quadtree skips by a pyramid of the highest and "
                        "lowest heights and is exact. interval (the dissertation's) and relief look at steps "
                        "along the ray, then narrow the step down, by secants or by halves; linear stops at "
                        "the step. They miss what is thinner than a step. parallax only shifts the map.",
                 .choices = kMethods}),
        declare(&Displacement::searchSteps,
                {.id = "searchSteps",
                 .label = "Search steps",
                 .min = 1,
                 .max = 4096,
                 .low = 4,
                 .high = 256,
                 .logarithmic = true,
                 .group = Group::Displacement,
                 .doc = "Steps of linear, relief and interval along a ray from the highest height to the "
                        "surface, or along one tile of the map."}),
        declare(&Displacement::refineSteps,
                {.id = "refineSteps",
                 .label = "Refinement steps",
                 .min = 0,
                 .max = 64,
                 .high = 16,
                 .group = Group::Displacement,
                 .doc = "Most steps in which relief and interval narrow down the place."}),
    };
    static const ParamTable table = tableOf<Displacement>("displacement", params);
    return table;
}

} // namespace lucent::scene
