#include "truth/Interface.h"

#include <cmath>

namespace lucent::truth {

namespace {
/// Squared cosine of the refracted angle; below 0 beyond the critical angle.
double squaredCosine(double cosine, double relative) {
    return 1 - relative * relative * (1 - cosine) * (1 + cosine);
}
} // namespace

dvec3 mirrored(const dvec3& direction, const dvec3& normal) {
    return glm::normalize(direction - 2 * glm::dot(direction, normal) * normal);
}

std::optional<dvec3> refracted(const dvec3& direction, const dvec3& normal, double relative) {
    if (relative == 1) return direction;
    const double cosine = -glm::dot(direction, normal);
    const double square = squaredCosine(cosine, relative);
    if (square < 0) return {};
    return glm::normalize(relative * direction + (relative * cosine - std::sqrt(square)) * normal);
}

double reflectance(double cosine, double relative) {
    if (relative == 1) return 0;
    const double square = squaredCosine(cosine, relative);
    if (square <= 0) return 1;
    const double other = std::sqrt(square);
    const double across = (relative * cosine - other) / (relative * cosine + other);
    const double along = (cosine - relative * other) / (cosine + relative * other);
    return 0.5 * (across * across + along * along);
}

} // namespace lucent::truth
