#pragma once
/// FLIP: how visible the difference of two pictures is to somebody who switches between them.

#include "base/Image.h"

namespace lucent::measure {

/// Pixels per degree of a monitor 0.7 m wide with 3840 pixels, seen from 0.7 m: about 67.
double defaultPixelsPerDegree();

struct Flip {
    double mean = 0;            ///< [0,1]
    Image map;                  ///< error of each pixel, 1 channel, [0,1]
    double start = 0, stop = 0; ///< exposures of hdrFlip(), in stops
    int exposures = 1;          ///< pictures compared
};

/// FLIP of two pictures on a display (Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild 2020).
///
/// Colours are blurred as the eye blurs them at that distance and compared in Hunt-adjusted CIELAB by the
/// HyAB distance; edges and points of the lightness that only one picture has raise the error.
///
/// @param image, reference  linear Rec. 709, 1 channel (grey) or 3 and more, of the same size; clamped to
///                          [0,1] as a display does
Flip flip(const Image& image, const Image& reference, double pixelsPerDegree = defaultPixelsPerDegree());

/// HDR-FLIP of two pictures of unbounded light (Andersson, Nilsson, Shirley, Akenine-Möller 2021): the
/// largest FLIP of each pixel over exposures one stop or less apart, from the one that maps the reference's
/// brightest pixel to 0.85 of the display's range to the one that does so for its median. Tone mapping is
/// Narkowicz's fit of the ACES curve. A median of 0 is replaced by the smallest luminance above it.
///
/// @param image, reference  linear Rec. 709; negative values count as 0
Flip hdrFlip(const Image& image, const Image& reference, double pixelsPerDegree = defaultPixelsPerDegree());

} // namespace lucent::measure
