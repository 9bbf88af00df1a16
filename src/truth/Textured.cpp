#include "truth/Textured.h"

#include "scene/Mesh.h"
#include "truth/Intersection.h"

#include <algorithm>
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

dvec3 sample(const scene::Mesh& mesh, const scene::TextureUse& use, dvec2 coordinate) {
    if (use.image < 0) return dvec3(1);
    const scene::TextureImage& image = *mesh.images[std::size_t(use.image)];
    const dvec2 at = coordinate * dvec2(image.size) - 0.5, base = glm::floor(at), f = at - base;
    const auto texel = [&](double x, double y) {
        return dvec3(image.texel(
            {wrapped(base.x + x, image.size.x, use.u), wrapped(base.y + y, image.size.y, use.v)}));
    };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), f.x), glm::mix(texel(0, 1), texel(1, 1), f.x), f.y);
}

/// A triangle with its places on textures.
struct Corners {
    dvec3 a, b, c;
    dvec2 at{0}, bt{0}, ct{0};
    dvec3 colors[3] = {dvec3(1), dvec3(1), dvec3(1)};

    Corners(const Triangles& triangles, const scene::Mesh& mesh, int triangle) {
        const std::uint32_t* index = &triangles.indices[3 * std::size_t(triangle)];
        a = triangles.positions[index[0]];
        b = triangles.positions[index[1]];
        c = triangles.positions[index[2]];
        if (!mesh.coordinates.empty()) {
            at = dvec2(mesh.coordinates[index[0]]);
            bt = dvec2(mesh.coordinates[index[1]]);
            ct = dvec2(mesh.coordinates[index[2]]);
        }
        for (int i = 0; i < 3 && !mesh.colors.empty(); ++i)
            colors[i] = dvec3(mesh.colors[index[i]]);
    }
    dvec2 coordinateAt(const dvec3& weights) const {
        return weights.x * at + weights.y * bt + weights.z * ct;
    }
    dvec3 colorAt(const dvec3& weights) const {
        return weights.x * colors[0] + weights.y * colors[1] + weights.z * colors[2];
    }
    /// How places change with u and with v; nothing where they do not change with both.
    std::optional<std::pair<dvec3, dvec3>> tangents() const {
        const dvec2 first = bt - at, second = ct - at;
        const double area = first.x * second.y - first.y * second.x;
        if (area == 0) return {};
        return std::pair(((b - a) * second.y - (c - a) * first.y) / area,
                         ((c - a) * first.x - (b - a) * second.x) / area);
    }
};

dvec3 turned(const dvec3& normal, const Corners& corners, const dvec3& stored) {
    const auto tangents = corners.tangents();
    if (!tangents) return normal;
    const auto& [alongU, alongV] = *tangents;
    const dvec3 tangent = glm::normalize(alongU - glm::dot(normal, alongU) * normal);
    dvec3 up = glm::cross(normal, tangent);
    if (glm::dot(up, alongV) > 0) up = -up;
    return glm::normalize(stored.x * tangent + stored.y * up + stored.z * normal);
}

} // namespace

std::optional<Textured> texturedAt(const Optics& optics, const Hit& hit) {
    const scene::Object& object = optics.object(hit.shape);
    const scene::Textures* textures = scene::texturesOf(object);
    if (!textures || hit.triangle < 0) return {};
    const scene::Mesh& mesh = *std::get<scene::MeshShape>(object.shape).mesh;
    const Corners corners(std::get<Triangles>(optics.rays().shape(hit.shape)), mesh, hit.triangle);
    const dvec3 weights = nearestWeights(corners.a, corners.b, corners.c, hit.position);
    const dvec2 coordinate = corners.coordinateAt(weights);
    Textured textured{object.material, hit};
    scene::Material& material = textured.material;
    material.diffuse *= vec3(sample(mesh, textures->color, coordinate));
    if (textures->vertexColors) material.diffuse *= vec3(corners.colorAt(weights));
    material.base *= vec3(sample(mesh, textures->emission, coordinate));
    if (auto* glossy = std::get_if<scene::Glossy>(&material.kind)) {
        const dvec3 facets = sample(mesh, textures->roughness, coordinate);
        glossy->roughness *= float(facets.g);
        glossy->metallic *= float(facets.b);
    }
    if (textures->normal.image >= 0) {
        const double scale = double(textures->normalScale);
        const dvec3 stored =
            (2.0 * sample(mesh, textures->normal, coordinate) - 1.0) * dvec3(scale, scale, 1);
        textured.hit.smoothNormal = turned(hit.smoothNormal, corners, stored);
    }
    return textured;
}

} // namespace lucent::truth
