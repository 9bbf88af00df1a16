#pragma once
/// How far one picture is from another.

#include "base/Image.h"
#include "base/Math.h"
#include "base/Result.h"

#include <string>

namespace lucent::measure {

/// Added to the squared reference in relMSE, so that black pixels do not decide it alone.
inline constexpr double kRelMseEpsilon = 0.01;

/// Differences picture minus reference over every pixel and colour channel; alpha is not looked at.
struct Metrics {
    double rmse = 0;
    double relMse = 0;    ///< mean of (a - b)^2 / (b^2 + kRelMseEpsilon)
    double mae = 0;       ///< mean absolute difference
    double p99 = 0;       ///< 99 % of the absolute differences are not above this
    double maximum = 0;   ///< largest absolute difference ...
    ivec2 maximumAt{0};   ///< ... and the first pixel that has it, from the top left
    double psnr = 0;      ///< dB for a peak of 1; infinite for equal pictures
    double bias = 0;      ///< mean difference
    double fluxRatio = 0; ///< sum of the picture over sum of the reference; NaN when that is 0
};

/// @param imageName, referenceName  used in messages only
/// @return Error for pictures of different size or number of colour channels, and for values that are not
/// finite:
///         how many there are and where the first one is
Result<Metrics> compare(const Image& image, const std::string& imageName, const Image& reference,
                        const std::string& referenceName);

/// Absolute differences as colours, per pixel the largest of its channels: black for none, over blue, red and
/// orange to a pale yellow for `full` and above; each step is lighter than the one before.
///
/// @param full  difference that gets the last colour, > 0
/// @return      3 channels of display values, for PNG
Image heatMap(const Image& image, const Image& reference, double full);

/// The colour of a share in [0,1] on that scale: linear Rec. 709, [0,1] each.
dvec3 heatColor(double share);

} // namespace lucent::measure
