#include "scene/Mesh.h"

#include "scene/Displacement.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace lucent::scene {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int kWavedCells = 128; // along an edge that a wave bends
// Once around something clear, whose layers are drawn anew with every step of the eye: caustics misplace no
// more than half a percent of a ball's light, in half the time that drawing as many as matt light needs
// takes.
constexpr int kClearSphere = 160, kClearTorus = 240;

// Once around what only casts a shadow: each of hundreds of light samples draws it.
constexpr int kShadowSphere = 128, kShadowTorus = 192;

// Where what light does inside is worked out once, the work grows with the square of the vertices, and
// between them light from far inside is linear: once around, and along an edge.
constexpr int kBakedSphere = 120, kBakedTorus = 160, kBakedCells = 24;

bool isWaved(const Object& object) { return object.wave.amplitude != vec3(0); }

bool isClear(const Object& object) { return object.material.isRefractive() && !isWaved(object); }

// Triangles with corners on a surface lie inside it: on the mean by a twelfth of the squared angle between
// corners, of each radius. Clear things stand that much outside: light that goes through a sphere leaves in a
// direction that is a sixth as far off.
float outside(double angle) { return 1 + float(angle * angle / 12); }

// The way from pole to pole adds its own; around, circles are smaller than the equator, on the mean by two
// thirds of their squares.
Mesh clearMesh(const Sphere& sphere, int segments) {
    const double angle = 2 * pi / segments;
    const float radius = sphere.radius * outside(angle * std::sqrt(1 + 2.0 / 3));
    return meshOf(Sphere{radius}, segments);
}

Mesh clearMesh(const Torus& torus, int segments) {
    const double around = 2 * pi / segments;
    const double across = around * double(torus.major) / double(torus.minor);
    return meshOf(Torus{torus.major * outside(around), torus.minor * outside(across)}, segments);
}

Mesh bakedMesh(const Shape& shape) {
    if (const auto* plane = std::get_if<Plane>(&shape)) return meshOf(*plane, kBakedCells);
    if (const auto* box = std::get_if<Box>(&shape)) return meshOf(*box, kBakedCells);
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return meshOf(*sphere, kBakedSphere);
    if (const auto* torus = std::get_if<Torus>(&shape)) return meshOf(*torus, kBakedTorus);
    if (const auto* field = std::get_if<HeightField>(&shape)) return meshOf(*field);
    return meshOf(std::get<Cylinder>(shape), kBakedSphere);
}

Mesh generated(const Object& object) {
    const Shape& shape = object.shape;
    if (isPrecomputed(object)) return bakedMesh(shape);
    const auto atMost = [&](int cells) {
        return object.mostCells > 0 ? std::min(cells, object.mostCells) : cells;
    };
    const int cells = isWaved(object) ? atMost(kWavedCells) : 1;
    const bool clear = isClear(object);
    if (const auto* plane = std::get_if<Plane>(&shape)) return meshOf(*plane, cells);
    if (const auto* box = std::get_if<Box>(&shape)) return meshOf(*box, cells);
    if (const auto* sphere = std::get_if<Sphere>(&shape))
        return clear ? clearMesh(*sphere, atMost(kClearSphere)) : meshOf(*sphere, atMost(kSphereSegments));
    if (const auto* torus = std::get_if<Torus>(&shape))
        return clear ? clearMesh(*torus, atMost(kClearTorus)) : meshOf(*torus, atMost(kTorusSegments));
    if (const auto* water = std::get_if<Water>(&shape)) return meshOf(*water, object.mostCells);
    if (const auto* field = std::get_if<HeightField>(&shape)) return meshOf(*field);
    return meshOf(std::get<Cylinder>(shape), atMost(kSphereSegments));
}

template <class Value>
std::vector<Value> perCorner(const std::vector<Value>& values, const std::vector<std::uint32_t>& corners) {
    std::vector<Value> list;
    if (values.empty()) return list;
    for (const std::uint32_t corner : corners)
        list.push_back(values[corner]);
    return list;
}

// Each triangle with three vertices of its own, which share its normal.
Mesh flattened(const Mesh& mesh) {
    Mesh flat{.positions = perCorner(mesh.positions, mesh.indices),
              .indices = std::vector<std::uint32_t>(mesh.indices.size()),
              .joints = perCorner(mesh.joints, mesh.indices),
              .jointWeights = perCorner(mesh.jointWeights, mesh.indices),
              .coordinates = perCorner(mesh.coordinates, mesh.indices),
              .secondCoordinates = perCorner(mesh.secondCoordinates, mesh.indices),
              .colors = perCorner(mesh.colors, mesh.indices),
              .rig = mesh.rig,
              .parts = mesh.parts,
              .images = mesh.images};
    std::iota(flat.indices.begin(), flat.indices.end(), 0u);
    for (MorphTarget& target : flat.rig.targets)
        target = {perCorner(target.positions, mesh.indices), {}};
    flat.normals = areaWeightedNormals(flat.positions, flat.indices);
    return flat;
}

// What a mesh of an object depends on.
struct Source {
    Shape shape;
    bool isWaved, isClear, isPrecomputed;
    std::optional<Displacement> displacement;
    int mostCells;
    bool operator==(const Source&) const = default;
};

struct ShadowSource {
    Shape shape;
    bool operator==(const ShadowSource&) const = default;
};

} // namespace

std::shared_ptr<const Mesh> meshOf(const Object& object) {
    const auto* file = std::get_if<MeshShape>(&object.shape);
    if (file && !file->flatNormals && !object.displacement) return file->mesh;
    return object.kept.of<std::shared_ptr<const Mesh>>(
        Source{object.shape, isWaved(object), isClear(object), isPrecomputed(object), object.displacement,
               object.mostCells},
        [&] {
            if (object.displacement) return std::make_shared<const Mesh>(displacedMesh(object));
            return std::make_shared<const Mesh>(file ? flattened(*file->mesh) : generated(object));
        });
}

std::shared_ptr<const Mesh> shadowMeshOf(const Object& object) {
    const Material& material = object.material;
    if (material.isRefractive() || isWaved(object) || isPrecomputed(object) || object.displacement ||
        object.mostCells > 0)
        return meshOf(object);
    const auto made = [&](auto shape, int segments) {
        const auto make = [&] { return std::make_shared<const Mesh>(meshOf(shape, segments)); };
        return object.kept.of<std::shared_ptr<const Mesh>>(ShadowSource{object.shape}, make);
    };
    if (const auto* sphere = std::get_if<Sphere>(&object.shape)) return made(*sphere, kShadowSphere);
    if (const auto* torus = std::get_if<Torus>(&object.shape)) return made(*torus, kShadowTorus);
    if (const auto* cylinder = std::get_if<Cylinder>(&object.shape)) return made(*cylinder, kShadowSphere);
    return meshOf(object);
}

bool showsTextures(const Material& material) {
    return std::holds_alternative<Matt>(material.kind) || std::holds_alternative<Glossy>(material.kind);
}

const Textures* texturesOf(const Object& object) {
    const auto* file = std::get_if<MeshShape>(&object.shape);
    if (!file || !file->textured || file->mesh->parts.size() != 1) return nullptr;
    const Textures& textures = file->mesh->parts.front().textures;
    return showsTextures(object.material) && textures.any() ? &textures : nullptr;
}

} // namespace lucent::scene
