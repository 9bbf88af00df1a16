#include "scene/Mesh.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <tuple>

namespace lucent::scene {
namespace {

constexpr double kNoDepth = -std::numeric_limits<double>::infinity();

// As DepthMaking has them.
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
//
// @return  texels of its box
std::size_t rasterize(const std::array<Corner, 3>& t, std::vector<double>& depth, ivec2 size) {
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
    return std::size_t(std::max(x1 - x0 + 1, 0)) * std::size_t(std::max(y1 - y0 + 1, 0));
}

// Of equal places equal: 0 is -0.
std::size_t hashOf(const vec3& place) {
    std::uint64_t bits = 0;
    for (int i = 0; i < 3; ++i) {
        const float value = place[i] + 0.0f;
        std::uint32_t part;
        std::memcpy(&part, &value, sizeof part);
        bits = (bits ^ part) * 0x9e3779b97f4a7c15u;
        bits ^= bits >> 32;
    }
    return std::size_t(bits);
}

} // namespace

std::vector<std::uint32_t> weldedVertices(std::span<const vec3> positions) {
    // Open addressing: at most half of the slots are taken.
    constexpr std::uint32_t kFree = ~0u;
    const std::size_t mask = std::bit_ceil(2 * positions.size() + 2) - 1;
    std::vector<std::uint32_t> slots(mask + 1, kFree), placeOf(positions.size());
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        std::size_t slot = hashOf(positions[i]) & mask;
        while (slots[slot] != kFree && positions[slots[slot]] != positions[i])
            slot = (slot + 1) & mask;
        if (slots[slot] == kFree) slots[slot] = i;
        placeOf[i] = slots[slot];
    }
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

DepthMaking::DepthMaking(const Mesh& source, vec3 rotation, ivec2 size, float margin, float floorGap)
    : size_(size), floorGap_(floorGap), indices_(source.indices),
      depth_(std::size_t(size.x) * std::size_t(size.y), kNoDepth) {
    const Mesh moved = source.joints.empty() ? Mesh() : posed(source, poseAt(source.rig, 0));
    const Mesh& mesh = source.joints.empty() ? source : moved;
    corners_.reserve(mesh.positions.size());
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
        corners_.emplace_back(size.x / 2.0 + offset.x, size.y / 2.0 - offset.y, p.z);
    }
}

std::optional<Image> DepthMaking::advance() {
    constexpr std::size_t kTriangles = 10'000; // and so many texels: some milliseconds
    std::size_t texels = 0;
    for (std::size_t i = 0; i < kTriangles && texels < kTriangles && next_ + 2 < indices_.size();
         ++i, next_ += 3)
        texels += rasterize(
            {corners_[indices_[next_]], corners_[indices_[next_ + 1]], corners_[indices_[next_ + 2]]}, depth_,
            size_);
    if (next_ + 2 < indices_.size()) return std::nullopt;

    double nearest = kNoDepth, farthest = -kNoDepth;
    for (const double z : depth_)
        if (z != kNoDepth) {
            nearest = std::max(nearest, z);
            farthest = std::min(farthest, z);
        }
    Image heights(size_.x, size_.y, 1);
    for (std::size_t i = 0; i < depth_.size(); ++i) {
        if (depth_[i] == kNoDepth) continue;
        const double part = nearest > farthest ? (depth_[i] - farthest) / (nearest - farthest) : 1;
        heights.pixels[i] = float(floorGap_ + (1 - floorGap_) * part);
    }
    return heights;
}

Image depthOfMesh(const Mesh& mesh, vec3 rotation, ivec2 size, float margin, float floorGap) {
    DepthMaking making(mesh, rotation, size, margin, floorGap);
    for (;;)
        if (std::optional<Image> made = making.advance()) return std::move(*made);
}

} // namespace lucent::scene
