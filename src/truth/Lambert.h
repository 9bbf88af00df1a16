#pragma once
/// Direct light on matt surfaces, ray-traced: the physics that the relief model stands for.
///
/// A point of the surface sends base + diffuse E / pi to the eye, with E the irradiance by every lamp and
/// every direction of the environment that it sees: the units of the relief model, so that the two can be
/// subtracted. The difference between the two truths is the relief model's own error.

#include "base/Result.h"
#include "scene/Scene.h"
#include "truth/Lights.h"
#include "truth/Picture.h"
#include "truth/RayScene.h"
#include "truth/Sight.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace lucent::truth {

struct LambertOptions {
    int samples = 256;      ///< of each pixel, for soft lamps and the environment; > 0
    bool normalise = false; ///< divide the light by the number of lights, an environment counting as one
    std::uint64_t seed = 0;
};

/// Colour: (1 - ks) (cB + cD sum of light); highlight and forward scattering are no part of a matt surface.
/// Illumination: the cosines seen, averaged over the lights by weight, as the relief's d.
///
/// Objects shadow each other, those hidden from the camera too. Normals are the field's (Field::normal), and
/// what lies within one texel of the point on its own field casts no shadow on it: the facets between texels
/// are no part of the surface that they stand for.
///
/// Samples of a pixel are independent: its standard error falls with the root of their number. Where light is
/// seen through a gap so small that no sample found it, the pixel is black and says that it has no error; its
/// neighbours, whose samples did, keep the picture's standard error right.
class LambertEstimator : public Estimator {
public:
    /// @param scene  must outlive this
    /// @param aov    Color or Illumination
    /// @return       Error for another AOV, or when Embree cannot hold the scene
    static Result<LambertEstimator> create(const scene::Scene& scene, ivec2 size, scene::Aov aov,
                                           const LambertOptions& options);
    Pixel solve(ivec2 pixel) const override;

private:
    LambertEstimator(const scene::Scene& scene, ivec2 size, scene::Aov aov, const LambertOptions& options,
                     std::vector<PlacedField> objects, RayScene rays);
    dvec3 arriving(const LightSource& light, const PlacedField& object, const SurfacePoint& point) const;
    dvec3 sample(const PlacedField& object, const SurfacePoint& point, Random random) const;

    Eye eye_;
    ivec2 size_;
    scene::Aov aov_;
    LambertOptions options_;
    std::vector<PlacedField> objects_;
    RayScene rays_;
    std::vector<LightSource> points_, discs_;
    std::optional<EnvironmentSampler> sky_;
};

} // namespace lucent::truth
