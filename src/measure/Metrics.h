#pragma once
/// How far one picture is from another.

#include "base/Image.h"
#include "base/JsonWriter.h"
#include "base/Math.h"
#include "base/Result.h"

#include <optional>
#include <string>
#include <vector>

namespace lucent::measure {

/// Added to the squared reference in relMSE, so that black pixels do not decide it alone.
inline constexpr double kRelMseEpsilon = 0.01;

/// How far directions are from exact ones, over some pixels.
struct Angles {
    double median = 0, p95 = 0, p99 = 0; ///< degrees, of the pixels that have a direction
    double lost = 0;                     ///< share of the pixels that have none
    int pixels = 0;
};
struct AngleErrors {
    Angles all;    ///< wherever the eye sees glass and there is an exact direction
    Angles inside; ///< of these, where all eight neighbours see as many layers: away from silhouettes
};

/// How far light on a surface lies from where it belongs, as the eye sees it: every pixel counts alike.
struct FluxErrors {
    double misplaced = 0; ///< half the summed absolute differences of means over squares of some pixels, over
                          ///< the reference's sum
    double byNoise = 0;   ///< what is to be expected of that from the noise of the reference alone
    double encircled = 0; ///< largest difference of the flux within a circle around the reference's middle,
                          ///< over all of the reference's
};

/// Differences picture minus reference over every pixel and colour channel; alpha is not looked at.
struct Metrics {
    double rmse = 0;
    double relRmse = 0;   ///< RMSE over the reference's mean: what error budgets mean; NaN unless > 0
    double relMse = 0;    ///< mean of (a - b)^2 / (b^2 + kRelMseEpsilon)
    double mae = 0;       ///< mean absolute difference
    double p50 = 0;       ///< half of the absolute differences are not above this ...
    double p90 = 0;       ///< ... 90 % not above this ...
    double p99 = 0;       ///< ... and 99 % not above this
    double maximum = 0;   ///< largest absolute difference ...
    ivec2 maximumAt{0};   ///< ... and the first pixel that has it, from the top left
    double psnr = 0;      ///< dB for a peak of 1; infinite for equal pictures
    double bias = 0;      ///< mean difference
    double fluxRatio = 0; ///< sum of the picture over sum of the reference; NaN unless > 0

    // These two cost more than all others together and are there when they were asked for.
    std::optional<double> ssim; ///< ssim() of Ssim.h; NaN for pictures too small for it
    std::optional<double> flip; ///< mean of flip() of Flip.h, hdrFlip() when a value is above 1

    std::optional<AngleErrors> angles; ///< of pictures of directions; see compareDirections()
    std::optional<FluxErrors> flux;    ///< of light on surfaces; see compareFlux()
};

/// @param imageName, referenceName  used in messages only
/// @param coverage  only pixels where the last channel of this picture is above 0 count (a picture with alpha
///                  is its own coverage); null: all. Of the same size.
/// @return Error for pictures of different size or number of colour channels, for values that are not finite
///         (how many there are and where the first one is), and for a coverage without any pixel
Result<Metrics> compare(const Image& image, const std::string& imageName, const Image& reference,
                        const std::string& referenceName, const Image* coverage = nullptr);

/// Compares directions where the eye sees glass: compare() with angles, without what relates to the sum of
/// the reference.
///
/// @param image   directions of any length, 4 channels; none where the fourth is 0
/// @param exact   of the same kind
/// @param layers  of the same size: how many surfaces of glass lie behind each pixel, exactly
/// @return        Error as compare() has it, or when no pixel sees glass
Result<Metrics> compareDirections(const Image& image, const std::string& imageName, const Image& exact,
                                  const Image& layers);

/// Compares light on a surface, all colours together.
///
/// @param errors  standard errors of the reference, 3 channels
/// @param cell    pixels a side, > 0, over which light may lie where it likes: as many as the reference's own
///                noise asks for
FluxErrors compareFlux(const Image& image, const Image& reference, const Image& errors, int cell = 5);

/// Adds SSIM and FLIP, over all pixels, to what compare() found of the same two pictures.
void addPerceptual(Metrics& metrics, const Image& image, const Image& reference);

/// The smallest of the values that a share of them is not above.
///
/// @param values  not empty; their order changes
/// @param share   (0, 1]
double percentile(std::vector<double>& values, double share);

/// The metrics as members of the object that is open; absent ones are left out.
void writeMembers(JsonWriter& json, const Metrics& metrics);

/// Absolute differences as colours, per pixel the largest of its channels: black for none, over blue, red and
/// orange to a pale yellow for `full` and above; each step is lighter than the one before.
///
/// @param full  difference that gets the last colour, > 0
/// @return      3 channels of display values, for PNG
Image heatMap(const Image& image, const Image& reference, double full);

/// The colour of a share in [0,1] on that scale: linear Rec. 709, [0,1] each.
dvec3 heatColor(double share);

} // namespace lucent::measure
