#include "measure/Statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace lucent::measure {

Spread spreadOf(std::vector<double> values) {
    assert(!values.empty());
    std::sort(values.begin(), values.end());
    return {values[values.size() / 2], values.front(), values.back(), int(values.size())};
}

double fittedExponent(std::span<const dvec2> points) {
    dvec2 mean(0);
    for (const dvec2& point : points)
        mean += glm::log(point) / double(points.size());
    double covariance = 0, variance = 0;
    for (const dvec2& point : points) {
        const dvec2 away = glm::log(point) - mean;
        covariance += away.x * away.y;
        variance += away.x * away.x;
    }
    return variance > 0 ? covariance / variance : std::numeric_limits<double>::quiet_NaN();
}

std::vector<bool> paretoFront(std::span<const dvec2> points) {
    const auto beats = [](const dvec2& a, const dvec2& b) { return a.x <= b.x && a.y <= b.y && a != b; };
    std::vector<bool> front;
    for (const dvec2& point : points)
        front.push_back(std::none_of(points.begin(), points.end(),
                                     [&](const dvec2& other) { return beats(other, point); }));
    return front;
}

} // namespace lucent::measure
