#include "truth/Torus.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace lucent::truth {

namespace {
/// Value of a polynomial, coefficients from the constant up.
double valueAt(std::span<const double> polynomial, double x) {
    double value = 0;
    for (std::size_t i = polynomial.size(); i-- > 0;)
        value = value * x + polynomial[i];
    return value;
}

/// The root between two points of different sign; Newton's steps that leave the bracket become bisections.
double rootBetween(std::span<const double> polynomial, std::span<const double> derivative, double low,
                   double high) {
    const bool rising = valueAt(polynomial, low) < 0;
    double x = 0.5 * (low + high);
    for (int step = 0; step < 200 && low < x && x < high; ++step) {
        const double value = valueAt(polynomial, x);
        if (value == 0) break;
        ((value < 0) == rising ? low : high) = x;
        const double next = x - value / valueAt(derivative, x);
        x = low < next && next < high ? next : 0.5 * (low + high);
    }
    return x;
}

struct Roots {
    std::array<double, 4> at{};
    int count = 0;
};

/// All roots of odd multiplicity within [low, high], ascending: between neighbouring roots of its derivative
/// a polynomial is monotonic.
Roots rootsWithin(std::span<const double> polynomial, double low, double high) {
    Roots roots;
    if (polynomial.size() < 2) return roots;
    std::array<double, 4> derivative{};
    for (std::size_t i = 1; i < polynomial.size(); ++i)
        derivative[i - 1] = double(i) * polynomial[i];
    const std::span<const double> slope(derivative.data(), polynomial.size() - 1);
    const Roots turns = rootsWithin(slope, low, high);
    double from = low;
    for (int i = 0; i <= turns.count; ++i) {
        const double to = i < turns.count ? turns.at[std::size_t(i)] : high;
        if ((valueAt(polynomial, from) < 0) != (valueAt(polynomial, to) < 0))
            roots.at[std::size_t(roots.count++)] = rootBetween(polynomial, slope, from, to);
        from = to;
    }
    return roots;
}

/// Signed distance to the torus (to its outer sheet) and its gradient.
double distanceTo(const dvec3& point, double major, double minor) {
    return std::hypot(std::hypot(point.x, point.y) - major, point.z) - minor;
}
} // namespace

dvec3 torusNormal(const dvec3& point, double major) {
    const double radius = std::hypot(point.x, point.y);
    const dvec3 ring = radius > 0 ? dvec3(point.x, point.y, 0) * (major / radius) : dvec3(major, 0, 0);
    return glm::normalize(point - ring);
}

TorusHits torusHits(const dvec3& origin, const dvec3& direction, double major, double minor) {
    // In units of the torus, from the point of the line that is nearest to its centre.
    const double size = major + minor;
    const double foot = -glm::dot(origin, direction);
    const dvec3 nearest = (origin + foot * direction) / size;
    const double ring = major / size, tube = minor / size;
    TorusHits hits;
    const double room = 1 - glm::dot(nearest, nearest); // of the sphere around the torus
    if (!(room > 0)) return hits;
    const double half =
        std::sqrt(room) + 0.1; // both ends clearly outside: the outer circle lies on that sphere

    // (|p|² + R² - r²)² = 4 R² (x² + y²) with p = nearest + s direction and nearest . direction = 0.
    const double k = glm::dot(nearest, nearest) + (ring - tube) * (ring + tube);
    const double a = glm::dot(dvec2(direction), dvec2(direction));
    const double b = glm::dot(dvec2(nearest), dvec2(direction));
    const double c = glm::dot(dvec2(nearest), dvec2(nearest));
    const double fourRing = 4 * ring * ring;
    const std::array<double, 5> quartic{k * k - fourRing * c, -2 * fourRing * b, 2 * k - fourRing * a, 0, 1};

    const Roots roots = rootsWithin(quartic, -half, half);
    for (int i = 0; i < roots.count; ++i) {
        double s = roots.at[std::size_t(i)];
        for (int step = 0; step < 2 && tube <= ring; ++step) {
            const dvec3 point = nearest + s * direction;
            const double speed = glm::dot(torusNormal(point, ring), direction);
            const double correction = distanceTo(point, ring, tube) / speed;
            if (!(std::abs(correction) < 1e-6)) break; // touching: the quartic's root is as good as there is
            s -= correction;
        }
        const double at = foot + size * s;
        // Two that all but touch may change places in the last digit.
        hits.at[std::size_t(i)] = i > 0 ? std::max(at, hits.at[std::size_t(i - 1)]) : at;
        hits.count = i + 1;
    }
    return hits;
}

} // namespace lucent::truth
