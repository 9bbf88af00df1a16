#pragma once
/// How far normals from depths are off (multiple-refractions thesis 2008, figure 3.4), as numbers.

#include "base/Math.h"

namespace lucent::refract {

enum class DepthNormals : int { Neighbours, Delta1, Delta2 };

struct NormalErrors {
    double median = 0, p95 = 0; ///< degrees
    double outline = 0;         ///< median of the pixels that have a pixel beside the ball within two of them
};

/// Normals of a ball's near side, whose depths are exact or those of slices, against the ball's own. The ball
/// of 1 m is seen from 3 m in a picture of `size` pixels a side that ends at 22.5 degrees.
///
/// @param slices  between the ball's nearest point and its outline; 0: depths are exact
NormalErrors errorsOf(DepthNormals method, int size, int slices);

} // namespace lucent::refract
