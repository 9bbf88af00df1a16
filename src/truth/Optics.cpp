#include "truth/Optics.h"

#include "scene/Mesh.h"
#include "scene/Water.h"
#include "truth/Intersection.h"
#include "truth/Textured.h"
#include "truth/Torus.h"

#include <algorithm>
#include <cmath>

namespace lucent::truth {

namespace {
constexpr double kTwoPi = 2 * std::numbers::pi;
const Box kEndless{dvec3(-std::numeric_limits<double>::infinity()),
                   dvec3(std::numeric_limits<double>::infinity())};

/// Directions across a surface go by a derivative, normals by this multiple of its inverse transpose, which
/// exists for flat derivatives as well.
dvec3 moveNormal(const glm::dmat3& derivative, const dvec3& normal) {
    const glm::dmat3 cofactors(glm::cross(derivative[1], derivative[2]),
                               glm::cross(derivative[2], derivative[0]),
                               glm::cross(derivative[0], derivative[1]));
    const dvec3 moved = cofactors * normal;
    const double length = glm::length(moved);
    if (!(length > 0)) return normal;
    return (glm::determinant(derivative) < 0 ? -1.0 : 1.0) * moved / length;
}

/// Normals of the triangles around each vertex, by area; +y for a vertex without any.
std::vector<dvec3> normalsOf(const std::vector<dvec3>& positions, const std::vector<std::uint32_t>& indices) {
    std::vector<dvec3> normals(positions.size(), dvec3(0));
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const dvec3 corner = positions[indices[i]];
        const dvec3 across =
            glm::cross(positions[indices[i + 1]] - corner, positions[indices[i + 2]] - corner);
        for (std::size_t k = i; k < i + 3; ++k)
            normals[indices[k]] += across;
    }
    for (dvec3& normal : normals) {
        const double length = glm::length(normal);
        normal = length > 0 ? normal / length : dvec3(0, 1, 0);
    }
    return normals;
}

Triangles trianglesOf(const scene::Mesh& mesh) {
    Triangles triangles;
    triangles.positions.assign(mesh.positions.begin(), mesh.positions.end());
    triangles.indices = mesh.indices;
    if (mesh.normals.empty())
        triangles.normals = normalsOf(triangles.positions, triangles.indices);
    else
        triangles.normals.assign(mesh.normals.begin(), mesh.normals.end());
    for (dvec3& normal : triangles.normals)
        normal = glm::normalize(normal);
    return triangles;
}

void morph(Triangles& triangles, const scene::Rig& rig, const std::vector<float>& weights) {
    for (std::size_t t = 0; t < weights.size(); ++t) {
        const scene::MorphTarget& target = rig.targets[t];
        for (std::size_t i = 0; i < target.positions.size(); ++i)
            triangles.positions[i] += double(weights[t]) * dvec3(target.positions[i]);
        for (std::size_t i = 0; i < target.normals.size(); ++i)
            triangles.normals[i] += double(weights[t]) * dvec3(target.normals[i]);
    }
    for (dvec3& normal : triangles.normals)
        normal = glm::normalize(normal);
}

void skin(Triangles& triangles, const scene::Mesh& mesh, const std::vector<mat4>& joints) {
    for (std::size_t i = 0; i < mesh.joints.size(); ++i) {
        glm::dmat4 moved(0);
        for (int k = 0; k < 4; ++k)
            moved += double(mesh.jointWeights[i][k]) * glm::dmat4(joints[mesh.joints[i][std::size_t(k)]]);
        triangles.positions[i] = dvec3(moved * glm::dvec4(triangles.positions[i], 1));
        triangles.normals[i] = moveNormal(glm::dmat3(moved), triangles.normals[i]);
    }
}

/// p + amplitude sin(2 pi (d . p / wavelength - t / period)): its derivative is 1 + (2 pi / wavelength)
/// cos(...) amplitude d^T.
void wave(Triangles& triangles, const scene::Wave& wave, double time) {
    const dvec3 amplitude(wave.amplitude), direction = glm::normalize(dvec3(wave.direction));
    const double perMetre = kTwoPi / double(wave.wavelength);
    for (std::size_t i = 0; i < triangles.positions.size(); ++i) {
        dvec3& place = triangles.positions[i];
        const double angle = perMetre * glm::dot(direction, place) - kTwoPi * time / double(wave.period);
        const glm::dmat3 derivative =
            glm::dmat3(1) + perMetre * std::cos(angle) * glm::outerProduct(amplitude, direction);
        triangles.normals[i] = moveNormal(derivative, triangles.normals[i]);
        place += amplitude * std::sin(angle);
    }
}

Triangles moved(const scene::MeshShape& shape, double time) {
    const scene::Mesh& mesh = *shape.mesh;
    Triangles triangles = trianglesOf(mesh);
    const scene::Pose pose = poseAt(mesh.rig, float(time));
    if (!pose.weights.empty()) morph(triangles, mesh.rig, pose.weights);
    if (!pose.joints.empty()) skin(triangles, mesh, pose.joints);
    return triangles;
}

/// What it begins as is known everywhere, and where nothing stirs it stays so.
Shape waterOf(const scene::Water& water, const Placement& placement, double time) {
    const bool stirred = water.amplitude > 0 || water.dropInterval > 0;
    if (time > 0 && stirred) return Waves{placement, std::make_shared<Basin>(water, time)};
    const dvec2 along = glm::normalize(dvec2(water.direction));
    return Ripple{.placement = placement,
                  .half = 0.5 * dvec2(water.size),
                  .wave = kTwoPi / double(water.wavelength) * along,
                  .amplitude = double(water.amplitude)};
}

bool isFlat(const scene::Object& object) {
    const auto* mesh = std::get_if<scene::MeshShape>(&object.shape);
    return mesh && mesh->flatNormals;
}

Triangles inWorld(Triangles triangles, const Placement& placement) {
    for (dvec3& position : triangles.positions)
        position = placement.pointInWorld(position);
    for (dvec3& normal : triangles.normals)
        normal = placement.directionInWorld(normal);
    return triangles;
}

/// Chooses what an object is made of, in its own space.
struct TrianglesOf {
    double time;
    bool waved;
    int cells() const { return waved ? Optics::kWavedCells : 1; }

    Triangles operator()(const scene::MeshShape& mesh) const { return moved(mesh, time); }
    Triangles operator()(const scene::Plane& plane) const { return trianglesOf(meshOf(plane, cells())); }
    Triangles operator()(const scene::Box& box) const { return trianglesOf(meshOf(box, cells())); }
    Triangles operator()(const scene::Sphere& sphere) const { return trianglesOf(meshOf(sphere)); }
    Triangles operator()(const scene::Torus& torus) const { return trianglesOf(meshOf(torus)); }
    Triangles operator()(const scene::Cylinder& cylinder) const { return trianglesOf(meshOf(cylinder)); }
    Triangles operator()(const scene::Water&) const { return {}; }
    Triangles operator()(const scene::HeightField& field) const { return trianglesOf(meshOf(field)); }
};

/// Solid angle of a triangle seen from the origin, above 0 where its front looks away from there (van
/// Oosterom, Strackee 1983).
double solidAngle(const dvec3& a, const dvec3& b, const dvec3& c) {
    const double x = glm::length(a), y = glm::length(b), z = glm::length(c);
    const double across = glm::dot(a, glm::cross(b, c));
    const double along = x * y * z + glm::dot(a, b) * z + glm::dot(a, c) * y + glm::dot(b, c) * x;
    return 2 * std::atan2(across, along);
}

bool contains(const Sphere& sphere, const dvec3& place) {
    return glm::distance(place, sphere.center) < sphere.radius;
}
bool contains(const Torus& torus, const dvec3& place) {
    const dvec3 out = place - torus.center;
    const double height = glm::dot(out, torus.axis);
    return std::hypot(glm::length(out - height * torus.axis) - torus.major, height) < torus.minor;
}
bool contains(const Ripple& ripple, const dvec3& place) {
    const dvec3 local = ripple.placement.pointFromWorld(place);
    const dvec2 at(local.x, local.z);
    return std::abs(at.x) < ripple.half.x && std::abs(at.y) < ripple.half.y &&
           local.y < ripple.amplitude * std::sin(glm::dot(ripple.wave, at));
}
bool contains(const Waves& waves, const dvec3& place) {
    const dvec3 local = waves.placement.pointFromWorld(place);
    const dvec2 at(local.x, local.z);
    return glm::all(glm::lessThan(glm::abs(at), waves.basin->half())) && local.y < waves.basin->at(at).height;
}
bool contains(const Triangles& triangles, const dvec3& place) {
    double sum = 0;
    const auto corner = [&](std::size_t i) { return triangles.positions[triangles.indices[i]] - place; };
    for (std::size_t i = 0; i + 2 < triangles.indices.size(); i += 3)
        sum += solidAngle(corner(i), corner(i + 1), corner(i + 2));
    return sum > kTwoPi;
}
bool contains(const FieldBlock&, const dvec3&) { return false; } // never clear
bool contains(const Displaced&, const dvec3&) { return false; }
} // namespace

void Media::enter(int object) {
    const auto place = std::lower_bound(inside_.begin(), inside_.end(), object);
    if (place == inside_.end() || *place != object) inside_.insert(place, object);
}

void Media::leave(int object) {
    const auto place = std::lower_bound(inside_.begin(), inside_.end(), object);
    if (place != inside_.end() && *place == object) inside_.erase(place);
}

double iorOf(const scene::Clear& material, int channel) {
    const double ior = double(material.ior);
    if (material.dispersion == 0 || channel == 1) return ior;
    const auto inverseSquare = [](double nanometres) { return 1 / (nanometres * nanometres); };
    const double red = inverseSquare(656.3), green = inverseSquare(587.6), blue = inverseSquare(486.1);
    const double spread = (ior - 1) * double(material.dispersion) / 20; // n_F - n_C
    return ior + spread * ((channel == 0 ? red : blue) - green) / (blue - red);
}

Shape surfaceOf(const scene::Object& object, double time) {
    const Placement placement(object.transform);
    const bool waved = object.wave.amplitude != vec3(0);
    if (object.displacement) return inWorld(trianglesOf(*scene::meshOf(object)), placement);
    if (const auto* water = std::get_if<scene::Water>(&object.shape)) return waterOf(*water, placement, time);
    if (const auto* sphere = std::get_if<scene::Sphere>(&object.shape); sphere && !waved)
        return Sphere{placement.translate, double(sphere->radius) * placement.scale};
    if (const auto* torus = std::get_if<scene::Torus>(&object.shape); torus && !waved)
        return Torus{placement.translate, placement.directionInWorld({0, 1, 0}),
                     double(torus->major) * placement.scale, double(torus->minor) * placement.scale};
    Triangles triangles = std::visit(TrianglesOf{time, waved}, object.shape);
    if (waved) wave(triangles, object.wave, time);
    if (isFlat(object)) triangles.normals.clear();
    triangles.opacity = opacityOf(object);
    return inWorld(std::move(triangles), placement);
}

Result<Optics> Optics::create(const scene::Scene& scene) {
    std::vector<Shape> shapes;
    std::vector<bool> hidden;
    for (const scene::Object& object : scene.objects) {
        const auto* water = std::get_if<scene::Water>(&object.shape);
        if (const double work = water ? Basin::work(*water, double(scene.view.time)) : 0;
            work > scene::kMostWaterWork)
            return scene::waterTooFarAhead(object.name, scene.view.time, work);
        hidden.push_back(!object.visible);
        if (object.isField())
            shapes.push_back(
                FieldBlock{std::make_shared<Field>(object.field()), Placement(object.transform)});
        else if (object.isDisplaced())
            shapes.push_back(Displaced{std::make_shared<DisplacedBody>(object)});
        else
            shapes.push_back(surfaceOf(object, double(scene.view.time)));
    }
    Result<RayScene> rays = RayScene::create(std::move(shapes), hidden);
    if (!rays) return rays.error();
    return Optics(scene, std::move(*rays));
}

Optics::Optics(const scene::Scene& scene, RayScene rays) : scene_(&scene), rays_(std::move(rays)) {
    for (int i = 0; i < int(scene.objects.size()); ++i) {
        const scene::Textures* textures = scene::texturesOf(object(i));
        hasBlended_ |= textures && textures->isBlended();
        if (isOpaque(i)) continue;
        optical_.push_back(i);
        const bool isMesh = std::holds_alternative<Triangles>(rays_.shape(i));
        boxes_.push_back(isMesh ? boxOf(rays_.shape(i)) : kEndless);
        if (!object(i).material.isRefractive()) continue;
        disperses_ |= object(i).material.clear().dispersion > 0;
        const bool one = object(i).material.clear().ior == 1; // whatever its dispersion
        hasIndexOfOne_ |= one;
        bendsNothing_ &= one;
    }
}

bool Optics::isOpaque(int number) const {
    const scene::Object& known = object(number);
    return !known.material.isRefractive() && !known.material.isMirror();
}

double Optics::ior(int medium, int channel) const {
    return medium == Media::kVacuum ? 1 : iorOf(object(medium).material.clear(), channel);
}

dvec3 Optics::absorption(int medium) const {
    if (medium == Media::kVacuum) return dvec3(0);
    const scene::Material& material = object(medium).material;
    if (material.isScattering()) return dvec3(material.translucent().absorption);
    return material.isRefractive() ? dvec3(material.clear().absorption) : dvec3(0);
}

Media Optics::mediaAt(const dvec3& place, bool hitsHidden) const {
    Media media;
    for (std::size_t i = 0; i < optical_.size(); ++i) {
        const int number = optical_[i];
        if (!object(number).material.isRefractive() || (!object(number).visible && !hitsHidden)) continue;
        if (!boxes_[i].holds(place)) continue;
        if (std::visit([&](const auto& shape) { return contains(shape, place); }, rays_.shape(number)))
            media.enter(number);
    }
    return media;
}

} // namespace lucent::truth
