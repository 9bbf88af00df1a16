#include "techniques/refract/bench/DepthNormals.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace lucent::refract {

namespace glsl {
using glm::cross, glm::normalize, glm::vec3;
#include "shaders/lib/depth_normal.glsl"
} // namespace glsl

namespace {

constexpr double kDistance = 3; // of the eye from the middle of a ball of 1 m

// Depths of a ball as the pixels of a picture see it.
class Ball {
public:
    Ball(int size, int slices)
        : size_(size), slices_(slices), pixel_(2 * std::tan(std::numbers::pi / 8) / size) {}

    // Along right, up and forward, from the eye.
    std::optional<vec3> place(ivec2 pixel) const {
        const dvec3 ray = rayOf(pixel);
        const std::optional<double> exact = depthOf(ray);
        if (!exact) return std::nullopt;
        return vec3(ray * sliced(*exact));
    }
    dvec3 normal(ivec2 pixel) const {
        const dvec3 ray = rayOf(pixel);
        return ray * *depthOf(ray) - dvec3(0, 0, kDistance);
    }

private:
    // One metre deep.
    dvec3 rayOf(ivec2 pixel) const {
        const dvec2 p = pixel_ * (dvec2(pixel) + 0.5 - 0.5 * size_);
        return {p.x, p.y, 1};
    }
    static std::optional<double> depthOf(const dvec3& ray) {
        // |ray z - (0, 0, d)| = 1
        const double a = glm::dot(ray, ray), root = kDistance * kDistance - a * (kDistance * kDistance - 1);
        if (root < 0) return std::nullopt;
        return (kDistance - std::sqrt(root)) / a;
    }
    double sliced(double depth) const {
        if (slices_ == 0) return depth;
        const double nearest = kDistance - 1, farthest = kDistance - 1 / kDistance; // the outline
        const double slice = (farthest - nearest) / (slices_ - 1);
        return nearest + slice * std::round((depth - nearest) / slice);
    }

    int size_, slices_;
    double pixel_; // m, a metre deep
};

vec3 normalAt(const Ball& ball, ivec2 pixel, DepthNormals method, bool& atOutline) {
    const vec3 middle = *ball.place(pixel);
    const auto beside = [&](ivec2 offset) {
        const std::optional<vec3> place = ball.place(pixel + offset);
        return place ? *place : middle;
    };
    for (const ivec2 offset : {ivec2(2, 0), ivec2(-2, 0), ivec2(0, 2), ivec2(0, -2)})
        atOutline = atOutline || !ball.place(pixel + offset);
    if (method == DepthNormals::Neighbours) {
        vec3 ring[8];
        ivec2 offset(1, 0);
        for (vec3& place : ring) {
            place = beside(offset);
            offset = glm::clamp(offset + ivec2(-offset.y, offset.x), ivec2(-1), ivec2(1));
        }
        return glsl::normalFromFan(middle, ring);
    }
    const int d = method == DepthNormals::Delta1 ? 1 : 2;
    return glsl::normalFromDifferences(beside({-d, 0}), beside({d, 0}), beside({0, -d}), beside({0, d}));
}

double at(std::vector<double>& values, double share) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1, std::size_t(share * double(values.size())))];
}

} // namespace

NormalErrors errorsOf(DepthNormals method, int size, int slices) {
    const Ball ball(size, slices);
    std::vector<double> all, outline;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            if (!ball.place({x, y})) continue;
            bool atOutline = false;
            const dvec3 found(normalAt(ball, {x, y}, method, atOutline));
            const dvec3 exact = glm::normalize(ball.normal({x, y}));
            const double degrees = std::atan2(glm::length(glm::cross(found, exact)), glm::dot(found, exact)) *
                                   180 / std::numbers::pi;
            all.push_back(degrees);
            if (atOutline) outline.push_back(degrees);
        }
    return {at(all, 0.5), at(all, 0.95), at(outline, 0.5)};
}

} // namespace lucent::refract
