#pragma once
/// Structural similarity of two pictures.

#include "base/Image.h"

namespace lucent::measure {

/// Rec. 709 luminance of every pixel, one channel; grey pictures keep their values.
Image luminance(const Image& image);

/// Mean structural similarity of the luminances (Wang, Bovik, Sheikh, Simoncelli 2004, eq. 13 to 17): 1 for
/// equal pictures.
///
/// Gaussian windows of 11 x 11 pixels, sigma 1.5, that lie wholly inside; K1 = 0.01, K2 = 0.03. The data
/// range L is 1, or the reference's largest luminance where that is above 1 (linear light has no largest
/// code).
///
/// @param image, reference  of the same size
/// @return  NaN when a side is below 11 pixels
double ssim(const Image& image, const Image& reference);

} // namespace lucent::measure
