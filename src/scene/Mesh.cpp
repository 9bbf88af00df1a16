#include "scene/Mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace lucent::scene {
namespace {

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

std::vector<std::uint32_t> weldedVertices(std::span<const vec3> positions) {
    std::vector<std::uint32_t> order(positions.size()), placeOf(order.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
        const vec3 &p = positions[a], &q = positions[b];
        return std::tie(p.x, p.y, p.z) < std::tie(q.x, q.y, q.z);
    };
    std::stable_sort(order.begin(), order.end(), before);
    for (std::size_t i = 0; i < order.size(); ++i)
        placeOf[order[i]] = i > 0 && !before(order[i - 1], order[i]) ? placeOf[order[i - 1]] : order[i];
    return placeOf;
}

std::size_t openEdges(const Mesh& mesh) {
    const std::vector<std::uint32_t> placeOf = weldedVertices(mesh.positions);
    struct Side {
        std::uint32_t low, high;
        int way; // +1 from low to high
        auto ends() const { return std::tie(low, high); }
    };
    std::vector<Side> sides;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        for (std::size_t c = 0; c < 3; ++c) {
            const std::uint32_t a = placeOf[mesh.indices[i + c]], b = placeOf[mesh.indices[i + (c + 1) % 3]];
            if (a != b) sides.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
        }
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) { return a.ends() < b.ends(); });
    std::size_t open = 0;
    for (std::size_t i = 0; i < sides.size();) {
        int sum = 0; // neighbours walk their common edge in opposite ways
        const Side edge = sides[i];
        for (; i < sides.size() && sides[i].ends() == edge.ends(); ++i)
            sum += sides[i].way;
        open += std::size_t(std::abs(sum));
    }
    return open;
}

Image depthOfMesh(const Mesh& source, vec3 rotation, ivec2 size, float margin, float floorGap) {
    const Mesh moved = source.joints.empty() ? Mesh() : posed(source, poseAt(source.rig, 0));
    const Mesh& mesh = source.joints.empty() ? source : moved;
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
