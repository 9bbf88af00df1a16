#pragma once
/// Bodies and light for the tests of the bake.

#include "scene/Mesh.h"
#include "techniques/throughput/Response.h"
#include "techniques/throughput/Surface.h"

#include <gtest/gtest.h>

#include <functional>

namespace lucent::throughput::shapes {

/// Absorbs so much that light reaches a few millimetres only: 20 / sigma_tr is 17 mm. z_r is 0.42 mm.
inline diffusion::Medium mediumOf(double scattering, double absorption) {
    diffusion::Medium medium;
    medium.scattering = scattering;
    medium.absorption = absorption;
    return medium;
}
inline Medium dense(DipoleGeometry geometry = DipoleGeometry::Planar) {
    return {{mediumOf(2190, 200), mediumOf(2620, 200), mediumOf(3000, 200)}, geometry};
}
/// Coefficients of Jensen et al. 2001.
inline Medium marble(DipoleGeometry geometry = DipoleGeometry::Planar) {
    return {{mediumOf(2190, 2.1), mediumOf(2620, 4.1), mediumOf(3000, 7.1)}, geometry};
}

/// In the xy plane, facing +z.
inline scene::Mesh patch(float size, int cells) {
    scene::Mesh mesh;
    for (int y = 0; y <= cells; ++y)
        for (int x = 0; x <= cells; ++x)
            mesh.positions.push_back(
                {size * (float(x) / float(cells) - 0.5f), size * (float(y) / float(cells) - 0.5f), 0});
    const auto at = [&](int x, int y) { return std::uint32_t(y * (cells + 1) + x); };
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x)
            mesh.indices.insert(mesh.indices.end(), {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y),
                                                     at(x + 1, y + 1), at(x, y + 1)});
    mesh.normals.assign(mesh.positions.size(), {0, 0, 1});
    return mesh;
}

/// Irradiance of texels by their places.
inline std::vector<vec3> lit(const Surface& surface, const std::function<float(const vec3&)>& light) {
    std::vector<vec3> irradiance;
    for (const Texel& texel : surface.texels.list)
        irradiance.push_back(vec3(light(positionAt(surface.hats, texel.place))));
    return irradiance;
}

inline Surface surfaceFrom(const scene::Mesh& mesh, int side = 128, int border = 4, float scale = 1) {
    Surface laid;
    Stages stages;
    addSurface(stages, std::make_shared<scene::Mesh>(mesh), scale, side, border,
               [&](Result<Surface> surface) -> Status {
                   if (!surface) return surface.error();
                   laid = std::move(*surface);
                   return Done{};
               });
    const Status done = stages.finish();
    EXPECT_TRUE(done) << done.error().message;
    return laid;
}

/// The vertex that is nearest to a place.
inline std::size_t vertexAt(const Hats& hats, const vec3& place) {
    std::size_t best = 0;
    for (std::size_t i = 0; i < hats.count(); ++i)
        if (glm::distance(hats.positions[i], place) < glm::distance(hats.positions[best], place)) best = i;
    return best;
}

} // namespace lucent::throughput::shapes
