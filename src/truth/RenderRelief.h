#pragma once
/// Pictures of whole scenes by the exact relief model.

#include "base/Image.h"
#include "base/Result.h"
#include "scene/Scene.h"
#include "truth/Relief.h"

#include <atomic>
#include <functional>
#include <optional>
#include <vector>

namespace lucent::truth {

/// An environment as distant lights in world space: `weight` is solid angle / 4 pi, `color` the mean radiance
/// there times the weight and the environment's intensity.
///
/// @param count  number of directions, each for an equal solid angle, > 0
std::vector<LightSource> environmentLights(const scene::Environment& environment, int count);

/// First point at which a ray meets what is drawn of a field: the surface and the side walls down to
/// Field::bottom(). Nothing when the ray starts inside or comes from below: the field is open there.
std::optional<SurfacePoint> firstHit(const Field& field, const Ray& ray, Stretch stretch);

/// What the picture depends on besides the scene.
struct ReliefOptions {
    Attenuation attenuation = Attenuation::Ratio;
    int environmentLights = 4096; ///< directions that stand for the environment
    bool normalise = false; ///< divide the light by the number of lights, an environment counting as one
    int threads = 0;        ///< 0: as many as the machine has
};

/// Renders the scene as its camera sees it: every visible object by exact first hit, lit by all lights.
/// Objects cast no shadows on each other. A place whose alpha is 0 is looked through; a smaller alpha than 1
/// becomes the coverage and leaves the colour as it is.
///
/// @param aov       Color or Illumination
/// @param progress  called now and then, always from the calling thread, with the finished share in [0,1]
/// @param cancel    set from elsewhere to stop
/// @return          4 channels, linear, the fourth is coverage; Error for another AOV or when cancelled
Result<Image> renderRelief(const scene::Scene& scene, ivec2 size, scene::Aov aov,
                           const ReliefOptions& options, const std::function<void(double)>& progress,
                           const std::atomic<bool>& cancel);

} // namespace lucent::truth
