#pragma once
/// Colour and alpha maps in double precision.

#include "base/Image.h"
#include "base/Math.h"

namespace lucent::truth {

/// Bilinear between texel centres, clamped at the border.
///
/// @param map      1 channel (spread over the three) or at least 3; null: 1 everywhere
/// @param place    [0,1] each, (0, 0) at the outer corner of the first texel
dvec3 sampleMap(const Image* map, dvec2 place);

} // namespace lucent::truth
