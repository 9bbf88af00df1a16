#include "truth/Textured.h"

#include "scene/Mesh.h"
#include "truth/Intersection.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lucent::truth {
namespace {

/// The texel that stands for one beyond the edges.
int wrapped(double at, int size, scene::Wrap wrap) {
    if (wrap == scene::Wrap::Clamp) return int(std::clamp(at, 0.0, double(size - 1)));
    const double period = wrap == scene::Wrap::Mirror ? 2.0 * size : size;
    const double rest = std::fmod(at, period), inside = rest < 0 ? rest + period : rest; // exact, however far
    return int(inside < size ? inside : period - 1 - inside);
}

/// Places on textures by both sets of coordinates.
struct Coordinates {
    dvec2 first{0}, second{0};
    dvec2 of(const scene::TextureUse& use) const { return use.second ? second : first; }
};

glm::dvec4 sample(const scene::Mesh& mesh, const scene::TextureUse& use, const Coordinates& coordinates) {
    if (use.image < 0) return glm::dvec4(1);
    const scene::TextureImage& image = *mesh.images[std::size_t(use.image)];
    const dvec2 at = coordinates.of(use) * dvec2(image.size) - 0.5, base = glm::floor(at), f = at - base;
    const auto texel = [&](double x, double y) {
        return glm::dvec4(image.texel(
            {wrapped(base.x + x, image.size.x, use.u), wrapped(base.y + y, image.size.y, use.v)}));
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), f.x), glm::mix(texel(0, 1), texel(1, 1), f.x), f.y);
}

Coordinates coordinatesOf(const scene::Mesh& mesh, std::uint32_t vertex) {
    const bool hasSecond = !mesh.secondCoordinates.empty();
    return {dvec2(mesh.coordinates[vertex]), hasSecond ? dvec2(mesh.secondCoordinates[vertex]) : dvec2(0)};
}

Coordinates mixed(const Coordinates& a, const Coordinates& b, const Coordinates& c, const dvec3& weights) {
    return {weights.x * a.first + weights.y * b.first + weights.z * c.first,
            weights.x * a.second + weights.y * b.second + weights.z * c.second};
}

/// The triangle of a hit, or the one below it, with its places on textures.
struct Corners {
    dvec3 a, b, c;
    Coordinates at[3];
    dvec3 colors[3] = {dvec3(1), dvec3(1), dvec3(1)};

    Corners(const std::array<dvec3, 3>& places, const scene::Mesh& mesh, const std::uint32_t* index)
        : a(places[0]), b(places[1]), c(places[2]) {
        for (int i = 0; i < 3 && !mesh.coordinates.empty(); ++i)
            at[i] = coordinatesOf(mesh, index[i]);
        for (int i = 0; i < 3 && !mesh.colors.empty(); ++i)
            colors[i] = dvec3(mesh.colors[index[i]]);
    }
    Coordinates coordinatesAt(const dvec3& weights) const { return mixed(at[0], at[1], at[2], weights); }
    dvec3 colorAt(const dvec3& weights) const {
        return weights.x * colors[0] + weights.y * colors[1] + weights.z * colors[2];
    }
    /// How places change with u and with v; nothing where they do not change with both.
    std::optional<std::pair<dvec3, dvec3>> tangents(const scene::TextureUse& use) const {
        const dvec2 first = at[1].of(use) - at[0].of(use), second = at[2].of(use) - at[0].of(use);
        const double area = first.x * second.y - first.y * second.x;
        if (area == 0) return {};
        return std::pair(((b - a) * second.y - (c - a) * first.y) / area,
                         ((c - a) * first.x - (b - a) * second.x) / area);
    }
};

dvec3 turned(const dvec3& normal, const Corners& corners, const scene::TextureUse& use, const dvec3& stored) {
    const auto tangents = corners.tangents(use);
    if (!tangents) return normal;
    const auto& [alongU, alongV] = *tangents;
    const dvec3 tangent = glm::normalize(alongU - glm::dot(normal, alongU) * normal);
    dvec3 up = glm::cross(normal, tangent);
    if (glm::dot(up, alongV) > 0) up = -up;
    return glm::normalize(stored.x * tangent + stored.y * up + stored.z * normal);
}

/// Where a hit is on its triangle: corners, and their weights.
std::pair<Corners, dvec3> placeOf(const Shape& shape, const scene::Mesh& mesh, const Hit& hit) {
    const auto part = unsigned(hit.triangle);
    if (const auto* displaced = std::get_if<Displaced>(&shape)) {
        const DisplacedBody& body = *displaced->body;
        return {Corners(body.placesOf(part), mesh, body.verticesOf(part).data()),
                body.weightsAt(part, hit.position)};
    }
    const auto& triangles = std::get<Triangles>(shape);
    const std::uint32_t* index = &triangles.indices[3 * std::size_t(part)];
    const std::array places{triangles.positions[index[0]], triangles.positions[index[1]],
                            triangles.positions[index[2]]};
    return {Corners(places, mesh, index), nearestWeights(places[0], places[1], places[2], hit.position)};
}

} // namespace

std::optional<Textured> texturedAt(const Optics& optics, const Hit& hit) {
    const scene::Object& object = optics.object(hit.shape);
    const scene::Textures* textures = scene::texturesOf(object);
    if (!textures || hit.triangle < 0) return {};
    const scene::Mesh& mesh = *std::get<scene::MeshShape>(object.shape).mesh;
    const auto [corners, weights] = placeOf(optics.rays().shape(hit.shape), mesh, hit);
    const Coordinates coordinate = corners.coordinatesAt(weights);
    Textured textured{object.material, hit};
    scene::Material& material = textured.material;
    material.diffuse *= vec3(sample(mesh, textures->color, coordinate));
    if (textures->vertexColors) material.diffuse *= vec3(corners.colorAt(weights));
    material.base *= vec3(sample(mesh, textures->emission, coordinate));
    if (auto* glossy = std::get_if<scene::Glossy>(&material.kind)) {
        const dvec3 facets(sample(mesh, textures->roughness, coordinate));
        glossy->roughness *= float(facets.g);
        glossy->metallic *= float(facets.b);
    }
    if (textures->normal.image >= 0) {
        const double scale = double(textures->normalScale);
        const dvec3 stored =
            (2.0 * dvec3(sample(mesh, textures->normal, coordinate)) - 1.0) * dvec3(scale, scale, 1);
        textured.hit.smoothNormal = turned(hit.smoothNormal, corners, textures->normal, stored);
    }
    return textured;
}

std::function<double(unsigned, const dvec3&)> opacityOf(const scene::Object& object) {
    const scene::Textures* textures = scene::texturesOf(object);
    if (!textures || !textures->hasHoles()) return {};
    const scene::Mesh* mesh = std::get<scene::MeshShape>(object.shape).mesh.get();
    return [mesh, textures](unsigned triangle, const dvec3& weights) {
        if (textures->color.image < 0) return textures->opacity(1);
        const std::uint32_t* index = &mesh->indices[3 * std::size_t(triangle)];
        const Coordinates at = mixed(coordinatesOf(*mesh, index[0]), coordinatesOf(*mesh, index[1]),
                                     coordinatesOf(*mesh, index[2]), weights);
        return textures->opacity(sample(*mesh, textures->color, at).a);
    };
}

} // namespace lucent::truth
