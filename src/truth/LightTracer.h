#pragma once
/// Irradiance of what the camera sees, with the light that reaches it through and by way of glass, water and
/// mirrors: rays of light are followed from lamps and environment to the first opaque surface.

#include "base/Result.h"
#include "scene/Scene.h"
#include "truth/LightPath.h"
#include "truth/Picture.h"
#include "truth/Relief.h"

#include <atomic>
#include <cstdint>

namespace lucent::truth {

struct LightOptions {
    scene::Aov aov = scene::Aov::Irradiance; ///< or Color
    Branching branching = Branching::Chain;
    std::int64_t photons = 1'000'000; ///< of the whole picture, > 0
    int samples = 256;                ///< of each pixel, for light straight from what has a size; > 0
    std::uint64_t seed = 0;
    Attenuation attenuation = Attenuation::Ratio; ///< of light inside height fields
    bool overPixels =
        false; ///< of the color: straight light and what is seen through glass, too, as means over pixels
};

/// Irradiance, W/m², of the opaque surfaces that the camera sees with nothing before them; coverage is 1
/// where the pixel's middle shows one. Or the colour that they have by it, and of all else that of
/// GlassEstimator, with the caustics that are seen through glass or in a mirror, spread over what the surface
/// has within a pixel's width (SeenPlaces). Two parts, added:
///
/// - Light straight from the lamps and the environment (Illumination), in the pixel's middle or as the
///   mean over it (PixelMean).
/// - Light that refractive and mirroring objects turned aside (LampRays), as the mean over the pixel. The
///   flux that a ray brings to an opaque surface goes to the pixel that shows the place, over the area that a
///   pixel covers there (Eye::areaOfPixel): exact for surfaces of any shape and for edges inside a pixel, and
///   not blurred beyond the pixel.
///
/// A surface is lit on the side that the camera sees. The standard error is that of independent rays, so
/// neighbouring pixels are independent too. A place that none of n rays met may still be lit: there the error
/// is what it receives with a probability of 95 % at most, 3 / n times what the strongest ray would bring
/// (the rule of three: (1 - 3 / n)^n = 0.05).
///
/// @param part    of several parts each has straight light in its rows, and Picture::rays for merge()
/// @param cancel  set from elsewhere to stop
/// @return        the picture and its flux (Picture::energy); Error for another AOV, when cancelled, or when
///                Embree cannot hold the scene
Result<Picture> traceLight(const scene::Scene& scene, ivec2 size, const LightOptions& options,
                           const Tile& part, const Work& work, const std::atomic<bool>& cancel);

} // namespace lucent::truth
