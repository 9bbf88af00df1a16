#pragma once
/// What is read off many measurements: medians, exponents, Pareto fronts.

#include "base/Math.h"

#include <span>
#include <vector>

namespace lucent::measure {

/// Repeated times of one thing.
struct Spread {
    double median = 0, low = 0, high = 0; ///< ms; low and high are the extremes
    int repeats = 0;
};
/// @param values  at least one; of an even number the upper of the two in the middle is the median
Spread spreadOf(std::vector<double> values);

/// Exponent p of the power law y = c x^p that fits the points best: least squares of log y over log x.
///
/// @param points  x and y above 0
/// @return        NaN for fewer than two different x
double fittedExponent(std::span<const dvec2> points);

/// Which points no other point beats: another that is not larger in both x and y and smaller in one.
std::vector<bool> paretoFront(std::span<const dvec2> points);

} // namespace lucent::measure
