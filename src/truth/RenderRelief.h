#pragma once
/// Pictures of whole scenes by the exact relief model.

#include "base/Image.h"
#include "base/Result.h"
#include "scene/Scene.h"
#include "truth/Picture.h"
#include "truth/Relief.h"
#include "truth/Sight.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace lucent::truth {

/// What the picture depends on besides the scene, and how many threads work on it.
struct ReliefOptions {
    Attenuation attenuation = Attenuation::Ratio;
    int environmentLights = 4096; ///< directions that stand for the environment
    int environmentSets = 1;      ///< of so many directions, each for every so many-th column of pixels
    bool normalise = false; ///< divide the light by the number of lights, an environment counting as one
    int threads = 0;        ///< 0: as many as the machine has
    int discSamples = 256;  ///< points that stand for the disc of a soft light
    std::uint64_t seed = 0; ///< of the directions and points
};

/// What people choose it by.
inline constexpr std::string_view kReliefName = "relief";

/// The relief model at the middle of each pixel: every visible object by exact first hit, lit by all lights.
/// Objects cast no shadows on each other. A place whose alpha is 0 is looked through; a smaller alpha than 1
/// becomes the coverage and leaves the colour as it is.
class ReliefEstimator : public Estimator {
public:
    /// @param scene  must outlive this
    /// @param aov    Color or Illumination
    ReliefEstimator(const scene::Scene& scene, ivec2 size, scene::Aov aov, const ReliefOptions& options);
    Pixel solve(ivec2 pixel) const override;

private:
    Eye eye_;
    ivec2 size_;
    scene::Aov aov_;
    ReliefOptions options_;
    std::vector<PlacedField> objects_;
    std::vector<Lighting> lighting_; ///< of each object, in its space, set by set
};

/// Error "truth: AOV ... has no reference; must be color or d" for another quantity than these.
Status checkAov(scene::Aov aov);

/// Renders the scene by ReliefEstimator.
///
/// @param progress  called now and then, always from the calling thread, with the finished share in [0,1]
/// @param cancel    set from elsewhere to stop
/// @return          4 channels, linear, the fourth is coverage; Error for another AOV or when cancelled
Result<Image> renderRelief(const scene::Scene& scene, ivec2 size, scene::Aov aov,
                           const ReliefOptions& options, const std::function<void(double)>& progress,
                           const std::atomic<bool>& cancel);

} // namespace lucent::truth
