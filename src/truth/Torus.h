#pragma once
/// Where a straight line meets a torus, in double precision.

#include "base/Math.h"

#include <array>

namespace lucent::truth {

/// Parameters at which a line meets a torus, ascending; at most four.
struct TorusHits {
    std::array<double, 4> at{};
    int count = 0;
};

/// The torus of all points at distance `minor` from the circle of radius `major` in the plane z = 0.
///
/// Counted from the point of the line that is nearest to the centre, the quartic has no cubic term, and none
/// of its coefficients is the difference of numbers much larger than the torus. Its roots are separated by
/// those of its derivatives and closed in on by bisection and Newton's steps; the last steps run on the
/// distance itself, so that a hit lies on the torus to rounding. A line that only touches counts as
/// intersection it twice, or not at all, as rounding has it.
///
/// @param origin     any point of the line
/// @param direction  unit
/// @param major      > 0, m
/// @param minor      > 0, m; above `major` the torus meets itself (a spindle, inner part included)
TorusHits torusHits(const dvec3& origin, const dvec3& direction, double major, double minor);

/// Outward unit normal of the torus at a point on it.
dvec3 torusNormal(const dvec3& point, double major);

} // namespace lucent::truth
