#include "scene/Mesh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace lucent::scene {
namespace {

constexpr double pi = std::numbers::pi;
constexpr int kWavedCells = 128; // along an edge that a wave bends
// Once around something clear, whose layers are drawn anew with every step of the eye: caustics misplace no
// more than half a percent of a ball's light, in half the time that drawing 256 and 384 takes. Matt light
// needs those.
constexpr int kClearSphere = 160, kClearTorus = 240;

bool isWaved(const Object& object) { return object.wave.amplitude != vec3(0); }

bool isClear(const Object& object) { return object.material.isRefractive() && !isWaved(object); }

// Triangles with corners on a surface lie inside it: on the mean by a twelfth of the squared angle between
// corners, of each radius. Clear things stand that much outside: light that goes through a sphere leaves in a
// direction that is a sixth as far off.
float outside(double angle) { return 1 + float(angle * angle / 12); }

// The way from pole to pole adds its own; around, circles are smaller than the equator, on the mean by two
// thirds of their squares.
Mesh clearMesh(const Sphere& sphere) {
    const double angle = 2 * pi / kClearSphere;
    const float radius = sphere.radius * outside(angle * std::sqrt(1 + 2.0 / 3));
    return meshOf(Sphere{radius}, kClearSphere);
}

Mesh clearMesh(const Torus& torus) {
    const double around = 2 * pi / kClearTorus;
    const double across = around * double(torus.major) / double(torus.minor);
    return meshOf(Torus{torus.major * outside(around), torus.minor * outside(across)}, kClearTorus);
}

Mesh generated(const Object& object) {
    const Shape& shape = object.shape;
    const int cells = isWaved(object) ? kWavedCells : 1;
    if (const auto* plane = std::get_if<Plane>(&shape)) return meshOf(*plane, cells);
    if (const auto* box = std::get_if<Box>(&shape)) return meshOf(*box, cells);
    if (const auto* sphere = std::get_if<Sphere>(&shape))
        return isClear(object) ? clearMesh(*sphere) : meshOf(*sphere);
    if (const auto* torus = std::get_if<Torus>(&shape))
        return isClear(object) ? clearMesh(*torus) : meshOf(*torus);
    if (const auto* water = std::get_if<Water>(&shape)) return meshOf(*water);
    return meshOf(std::get<Cylinder>(shape));
}

// The numbers that a generated mesh depends on.
std::vector<float> numbersOf(const Object& object) {
    const Shape& shape = object.shape;
    std::vector<float> list{float(shape.index()), float(isWaved(object)), float(isClear(object))};
    const auto add = [&](auto... values) { (list.push_back(float(values)), ...); };
    if (const auto* plane = std::get_if<Plane>(&shape)) add(plane->size.x, plane->size.y);
    if (const auto* box = std::get_if<Box>(&shape)) add(box->size.x, box->size.y, box->size.z);
    if (const auto* sphere = std::get_if<Sphere>(&shape)) add(sphere->radius);
    if (const auto* torus = std::get_if<Torus>(&shape)) add(torus->major, torus->minor);
    if (const auto* c = std::get_if<Cylinder>(&shape)) add(c->radius, c->height, c->open);
    if (const auto* water = std::get_if<Water>(&shape)) add(water->size.x, water->size.y, water->cells);
    return list;
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
              .rig = mesh.rig};
    std::iota(flat.indices.begin(), flat.indices.end(), 0u);
    for (MorphTarget& target : flat.rig.targets)
        target = {perCorner(target.positions, mesh.indices), {}};
    flat.normals = areaWeightedNormals(flat.positions, flat.indices);
    return flat;
}

// Made once for each of the last few meshes.
std::shared_ptr<const Mesh> flatMeshOf(const std::shared_ptr<const Mesh>& mesh) {
    struct Made {
        std::weak_ptr<const Mesh> from;
        std::shared_ptr<const Mesh> flat;
    };
    constexpr std::size_t kKept = 8;
    static std::vector<Made> made;
    std::erase_if(made, [](const Made& one) { return one.from.expired(); });
    for (const Made& one : made)
        if (one.from.lock() == mesh) return one.flat;
    if (made.size() == kKept) made.erase(made.begin());
    made.push_back({mesh, std::make_shared<const Mesh>(flattened(*mesh))});
    return made.back().flat;
}

} // namespace

std::shared_ptr<const Mesh> meshOf(const Object& object) {
    if (const auto* file = std::get_if<MeshShape>(&object.shape))
        return file->flatNormals ? flatMeshOf(file->mesh) : file->mesh;
    struct Made {
        std::vector<float> numbers;
        std::shared_ptr<const Mesh> mesh;
    };
    constexpr std::size_t kKept = 32;
    static std::vector<Made> made;
    std::vector<float> numbers = numbersOf(object);
    const auto found =
        std::find_if(made.begin(), made.end(), [&](const Made& one) { return one.numbers == numbers; });
    if (found != made.end()) return found->mesh;
    if (made.size() == kKept) made.erase(made.begin());
    made.push_back({std::move(numbers), std::make_shared<const Mesh>(generated(object))});
    return made.back().mesh;
}

} // namespace lucent::scene
