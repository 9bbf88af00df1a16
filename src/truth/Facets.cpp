#include "truth/Facets.h"

#include "truth/Interface.h"

#include <algorithm>
#include <cmath>

namespace lucent::truth {

namespace {
constexpr double kPi = std::numbers::pi;
constexpr double kLeastAlpha = 1e-6;
} // namespace

Facets::Facets(const dvec3& normal, const dvec3& viewer, double roughness, double ior)
    : normal_(normal), viewer_(viewer), alpha_(std::max(roughness * roughness, kLeastAlpha)), ior_(ior) {}

bool Facets::isSmooth() const { return alpha_ == kLeastAlpha; }

double Facets::share(const dvec3& toLight) const {
    const double below = glm::dot(normal_, toLight), eye = glm::dot(normal_, viewer_);
    if (below <= 0 || eye <= 0) return 0;
    const dvec3 facet = glm::normalize(toLight + viewer_);
    const double mirrors = reflectance(std::clamp(glm::dot(viewer_, facet), 0.0, 1.0), 1 / ior_);
    return mirrors * spreadOf(facet) * unhidden(below) * unhidden(eye) / (4 * eye);
}

double Facets::density(const dvec3& toLight) const {
    const double eye = glm::dot(normal_, viewer_);
    if (eye <= 0 || glm::dot(normal_, toLight) <= 0) return 0;
    return unhidden(eye) * spreadOf(glm::normalize(toLight + viewer_)) / (4 * eye);
}

/// Seen along the stretched view, facets are the upper half of a ball: an even place on its outline, squeezed
/// into the part that the surface's own side leaves of it.
dvec3 Facets::choose(dvec2 chance) const {
    const dvec3 aside = std::abs(normal_.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 first = glm::normalize(glm::cross(normal_, aside)), second = glm::cross(normal_, first);
    const dvec3 eye(glm::dot(viewer_, first), glm::dot(viewer_, second), glm::dot(viewer_, normal_));

    const dvec3 stretched = glm::normalize(dvec3(alpha_ * eye.x, alpha_ * eye.y, eye.z));
    const double flat = std::hypot(stretched.x, stretched.y);
    const dvec3 x = flat > 0 ? dvec3(-stretched.y, stretched.x, 0) / flat : dvec3(1, 0, 0);
    const dvec3 y = glm::cross(stretched, x);
    const double radius = std::sqrt(chance.x), angle = 2 * kPi * chance.y;
    const double p = radius * std::cos(angle), half = 0.5 * (1 + stretched.z);
    const double q = (1 - half) * std::sqrt(std::max(0.0, 1 - p * p)) + half * radius * std::sin(angle);
    const dvec3 up = p * x + q * y + std::sqrt(std::max(0.0, 1 - p * p - q * q)) * stretched;

    const dvec3 facet =
        glm::normalize(alpha_ * up.x * first + alpha_ * up.y * second + std::max(up.z, 1e-12) * normal_);
    return mirrored(-viewer_, facet);
}

/// Area of facets that face so, of each area of the surface, 1/sr (GGX).
double Facets::spreadOf(const dvec3& facet) const {
    const double cosine = glm::dot(normal_, facet), square = alpha_ * alpha_;
    if (cosine <= 0) return 0;
    const dvec3 sine = glm::cross(normal_, facet); // 1 - cosine² would lose its digits
    const double spread = square * cosine * cosine + glm::dot(sine, sine);
    return square / (kPi * spread * spread);
}

/// Share of the facets that no other hides from a direction.
double Facets::unhidden(double cosine) const {
    const double square = alpha_ * alpha_;
    return 2 * cosine / (cosine + std::sqrt(square + (1 - square) * cosine * cosine));
}

} // namespace lucent::truth
