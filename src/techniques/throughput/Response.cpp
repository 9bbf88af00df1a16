#include "techniques/throughput/Response.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lucent::throughput {

namespace {

constexpr auto kShape = diffusion::Shape::Dipole;

// a + b r² + c r⁴ with the value, slope and bend of a function at r = cut.
dvec3 evenPolynomial(double value, double slope, double bend, double cut) {
    const double c = (bend - slope / cut) / (8 * cut * cut);
    const double b = (slope - 4 * c * cut * cut * cut) / (2 * cut);
    return {value - b * cut * cut - c * cut * cut * cut * cut, b, c};
}

// R_d of poles and its first two derivatives over r: each pole leaves w k(d), d² = r² + z².
dvec3 derivativesAt(const diffusion::Profile& profile, double r) {
    const double step = 1e-4 * r;
    const double before = profile.at(r - step), here = profile.at(r), after = profile.at(r + step);
    return {here, (after - before) / (2 * step), (after - 2 * here + before) / (step * step)};
}

// The near part of a colour's profile, or its share.
std::vector<double> nearOf(const diffusion::Profile& profile, double cut, std::size_t count, bool isShare) {
    std::vector<double> values(count, 0);
    if (profile.total() == 0) return values;
    const dvec3 at = derivativesAt(profile, cut);
    const dvec3 even = evenPolynomial(at.x, at.y, at.z, cut);
    for (std::size_t i = 0; i + 1 < count; ++i) { // the last one is 0 by its definition
        const double u = double(i) / double(count - 1), r = cut * u * u;
        const double whole = profile.at(r);
        const double far = even.x + even.y * r * r + even.z * r * r * r * r;
        values[i] = isShare ? 1 - far / whole : whole - far;
    }
    return values;
}

} // namespace

Response::Response(const Medium& medium, double extent, double cut) : medium_(medium), cut_(cut) {
    constexpr double kTableError = 1e-4;
    constexpr std::size_t kNearEntries = 512;
    for (diffusion::Medium& color : medium_.colors)
        color.above.clear();
    const std::array<diffusion::Profile, 3> profiles = diffusion::profilesOf(medium_.colors, kShape, 0);
    whole_ = diffusion::tableOf(profiles, extent, kTableError, false);
    finest_ = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < 3; ++c) {
        const diffusion::Medium& color = medium_.colors[c];
        if (color.extinction() == 0) continue;
        finest_ = std::min(finest_, profiles[c].depth());
        if (color.albedo() > 0) poles_[c] = diffusion::polesOf(color, 0, kTableError);
    }
    if (cut == 0) return;
    near_ = {cut, std::vector<vec3>(kNearEntries, vec3(0)), 0};
    for (int c = 0; c < 3; ++c) {
        const std::vector<double> values =
            nearOf(profiles[std::size_t(c)], cut, kNearEntries, medium_.geometry == DipoleGeometry::Offset);
        for (std::size_t i = 0; i < values.size(); ++i)
            near_.values[i][c] = float(values[i]);
    }
}

vec3 Response::offsetProfile(const vec3& away, const vec3& normal) const {
    vec3 sum(0);
    const double square = glm::dot(dvec3(away), dvec3(away)), up = glm::dot(dvec3(away), dvec3(normal));
    for (int c = 0; c < 3; ++c)
        for (const diffusion::Pole& pole : poles_[std::size_t(c)]) {
            const double d2 = square + pole.depth * (2 * up + pole.depth);
            const double d = std::sqrt(std::max(d2, pole.depth * pole.depth));
            sum[c] += float(pole.weight * diffusion::kernel(medium_.colors[std::size_t(c)], d));
        }
    return sum;
}

vec3 Response::whole(const vec3& from, const vec3& normal, const vec3& to) const {
    const vec3 away = to - from;
    if (medium_.geometry == DipoleGeometry::Offset) return offsetProfile(away, normal);
    return diffusion::valueAt(whole_, double(glm::length(away)));
}

vec3 Response::near(const vec3& from, const vec3& normal, const vec3& to) const {
    const vec3 away = to - from;
    const double r = double(glm::length(away));
    if (!(r < cut_)) return vec3(0);
    const vec3 part = diffusion::valueAt(near_, r);
    return medium_.geometry == DipoleGeometry::Offset ? part * offsetProfile(away, normal) : part;
}

vec3 Response::far(const vec3& from, const vec3& normal, const vec3& to) const {
    return whole(from, normal, to) - near(from, normal, to);
}

vec3 Response::total() const {
    vec3 total;
    for (int c = 0; c < 3; ++c)
        total[c] = float(diffusion::totalReflectance(medium_.colors[std::size_t(c)], kShape, 0));
    return total;
}

} // namespace lucent::throughput
