#include "views/Prisms.h"

#include <algorithm>

namespace lucent::views {

namespace {
constexpr int kTexelsPerTriangle = 8, kTrianglesPerRow = 256;
} // namespace

ivec2 Prisms::sizeFor(std::size_t triangles) {
    return {kTexelsPerTriangle * kTrianglesPerRow,
            std::max(1, int((triangles + kTrianglesPerRow - 1) / kTrianglesPerRow))};
}

namespace {

std::vector<vec4> texelsOf(const scene::DisplacedBase& base, ivec2 size) {
    std::vector<vec4> texels(std::size_t(size.x) * std::size_t(size.y), vec4(0));
    for (std::size_t t = 0; t < base.triangles.size(); ++t) {
        const scene::DisplacedTriangle& triangle = base.triangles[t];
        vec4* out = &texels[kTexelsPerTriangle * t];
        // Whole tiles aside coordinates are small, so that floats tell texels apart.
        const vec2 tile = glm::floor(triangle.coordinates[0]);
        for (std::size_t i = 0; i < 3; ++i) {
            const vec2 at = triangle.coordinates[i] - tile;
            out[i] = vec4(triangle.places[i], at.x);
            out[3 + i] = vec4(triangle.directions[i], at.y);
        }
        const auto& [a, b, c] = triangle.vertices; // floats tell 16 million apart
        out[6] = vec4(triangle.walls, a, b, c);
    }
    return texels;
}

// Floor, ceiling and two triangles for each side; corners as in displaced.vert.
std::vector<std::uint32_t> hullsOf(std::size_t triangles) {
    constexpr std::uint32_t kHull[] = {0, 2, 1, 3, 4, 5, 0, 1, 4, 0, 4, 3,
                                       1, 2, 5, 1, 5, 4, 2, 0, 3, 2, 3, 5};
    std::vector<std::uint32_t> indices;
    for (std::uint32_t t = 0; t < triangles; ++t)
        for (const std::uint32_t corner : kHull)
            indices.push_back(6 * t + corner);
    return indices;
}

} // namespace

Prisms::Prisms(gl::Device& device, const scene::DisplacedBase& base)
    : texels(device, {.size = sizeFor(base.triangles.size()), .format = graph::Format::RGBA32F},
             "views.prisms"),
      hulls(device, hullsOf(base.triangles.size()), "views.hulls") {
    device.upload(texels.handle(), 0, texelsOf(base, texels.desc().size));
}

} // namespace lucent::views
