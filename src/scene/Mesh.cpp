#include "scene/Mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace lucent::scene {
namespace {

constexpr std::string_view kMagic = "LUCENTM1";
constexpr std::size_t kHeader = 16; // magic, number of positions, number of indices
static_assert(std::endian::native == std::endian::little, "mesh files are written as they lie in memory");
static_assert(sizeof(vec3) == 12);

// Corner in texels, x to the right and y down from the picture's top left corner; z towards the viewer.
using Corner = dvec3;

// Twice the signed area of (a, b, p), computed in one order of a and b for both triangles at an edge: no
// texel centre falls between them.
double edge(const Corner& a, const Corner& b, double x, double y) {
    const bool swap = b.x < a.x || (b.x == a.x && b.y < a.y);
    const Corner &from = swap ? b : a, &to = swap ? a : b;
    const double area = (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x);
    return swap ? -area : area;
}

// Keeps the nearest depth at every texel centre that the triangle covers, edges included.
void rasterize(const std::array<Corner, 3>& t, std::vector<double>& depth, ivec2 size) {
    const auto [left, right] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [top, bottom] = std::minmax({t[0].y, t[1].y, t[2].y});
    const int x0 = std::max(0, int(std::ceil(left - 0.5))),
              x1 = std::min(size.x - 1, int(std::floor(right - 0.5)));
    const int y0 = std::max(0, int(std::ceil(top - 0.5))),
              y1 = std::min(size.y - 1, int(std::floor(bottom - 0.5)));
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
            const double px = x + 0.5, py = y + 0.5;
            const double a = edge(t[1], t[2], px, py), b = edge(t[2], t[0], px, py),
                         c = edge(t[0], t[1], px, py);
            const bool inside = (a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0); // either side
            const double area = a + b + c;
            if (!inside || area == 0) continue; // seen edge-on it covers nothing
            double& nearest = depth[std::size_t(y) * std::size_t(size.x) + std::size_t(x)];
            nearest = std::max(nearest, (a * t[0].z + b * t[1].z + c * t[2].z) / area);
        }
}

} // namespace

Bytes encodeMesh(const Mesh& mesh) {
    const std::uint32_t counts[] = {std::uint32_t(mesh.positions.size()), std::uint32_t(mesh.indices.size())};
    const std::size_t positionBytes = mesh.positions.size() * sizeof(vec3);
    Bytes bytes(kHeader + positionBytes + mesh.indices.size() * sizeof(std::uint32_t));
    std::memcpy(bytes.data(), kMagic.data(), kMagic.size());
    std::memcpy(bytes.data() + kMagic.size(), counts, sizeof counts);
    std::copy_n(reinterpret_cast<const std::byte*>(mesh.positions.data()), positionBytes,
                bytes.data() + kHeader);
    std::copy_n(reinterpret_cast<const std::byte*>(mesh.indices.data()),
                mesh.indices.size() * sizeof(std::uint32_t), bytes.data() + kHeader + positionBytes);
    return bytes;
}

Result<Mesh> decodeMesh(std::span<const std::byte> bytes, const std::string& name) {
    if (bytes.size() < kHeader || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
        return Error{name + ": is no mesh file; must be glTF 2.0 or start with LUCENTM1"};
    std::uint32_t counts[2];
    std::memcpy(counts, bytes.data() + kMagic.size(), sizeof counts);
    const std::uint64_t needed = kHeader + 12 * std::uint64_t(counts[0]) + 4 * std::uint64_t(counts[1]);
    if (bytes.size() < needed)
        return Error{name + ": the mesh file ends after " + std::to_string(bytes.size()) +
                     " bytes; must have " + std::to_string(needed)};
    if (counts[1] == 0 || counts[1] % 3)
        return Error{name + ": has " + std::to_string(counts[1]) +
                     " indices; must be three a triangle, at least one"};

    Mesh mesh;
    mesh.positions.resize(counts[0]);
    mesh.indices.resize(counts[1]);
    std::copy_n(bytes.data() + kHeader, 12 * mesh.positions.size(),
                reinterpret_cast<std::byte*>(mesh.positions.data()));
    std::copy_n(bytes.data() + kHeader + 12 * mesh.positions.size(), 4 * mesh.indices.size(),
                reinterpret_cast<std::byte*>(mesh.indices.data()));
    for (const std::uint32_t index : mesh.indices)
        if (index >= counts[0])
            return Error{name + ": index " + std::to_string(index) + " points behind the " +
                         std::to_string(counts[0]) + " positions; must be smaller"};
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const vec3 p = mesh.positions[i];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
            return Error{name + ": position " + std::to_string(i) + " is not finite; must be"};
    }
    return mesh;
}

Image depthOfMesh(const Mesh& mesh, vec3 rotation, ivec2 size, float margin, float floorGap) {
    std::vector<Corner> corners;
    corners.reserve(mesh.positions.size());
    const glm::dmat3 turn(rotationFromDegrees(rotation));
    dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
    for (const std::uint32_t index : mesh.indices) { // positions that no triangle uses must not widen the box
        const dvec3 p = turn * dvec3(mesh.positions[index]);
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const dvec2 room = glm::max(dvec2(size) - 2.0 * double(margin) * std::max(size.x, size.y), dvec2(1));
    const dvec2 extent = glm::max(dvec2(high - low), dvec2(1e-300)); // a line or a point takes any scale
    const double texelsPerMetre = std::min({room.x / extent.x, room.y / extent.y, 1e300});
    const dvec2 centre = (dvec2(low) + dvec2(high)) / 2.0;
    for (const vec3& position : mesh.positions) {
        const dvec3 p = turn * dvec3(position);
        const dvec2 offset = (dvec2(p) - centre) * texelsPerMetre;
        corners.emplace_back(size.x / 2.0 + offset.x, size.y / 2.0 - offset.y, p.z);
    }

    constexpr double kNothing = -std::numeric_limits<double>::infinity();
    std::vector<double> depth(std::size_t(size.x) * std::size_t(size.y), kNothing);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        rasterize({corners[mesh.indices[i]], corners[mesh.indices[i + 1]], corners[mesh.indices[i + 2]]},
                  depth, size);

    double nearest = kNothing, farthest = -kNothing;
    for (const double z : depth)
        if (z != kNothing) {
            nearest = std::max(nearest, z);
            farthest = std::min(farthest, z);
        }
    Image heights(size.x, size.y, 1);
    for (std::size_t i = 0; i < depth.size(); ++i) {
        if (depth[i] == kNothing) continue;
        const double part = nearest > farthest ? (depth[i] - farthest) / (nearest - farthest) : 1;
        heights.pixels[i] = float(floorGap + (1 - floorGap) * part);
    }
    return heights;
}

} // namespace lucent::scene
