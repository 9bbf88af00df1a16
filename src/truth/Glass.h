#pragma once
/// Pictures of scenes with refractive and mirroring objects.

#include "base/Result.h"
#include "scene/Scene.h"
#include "truth/Journey.h"
#include "truth/Lamps.h"
#include "truth/Optics.h"
#include "truth/Picture.h"
#include "truth/Sight.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace lucent::truth {

struct GlassOptions {
    Branching branching = Branching::Chain;
    int samples = 256;      ///< of each pixel in which something is left to chance; > 0
    bool antialias = false; ///< samples lie all over the pixel, else all in its middle
    std::uint64_t seed = 0;
};

/// What the eye sees.
///
/// Color: the chain is the model that is drawn: the eye's ray is refracted at every interface and shows what
/// it meets in the end, times the transmitted shares, plus, by the first interface, the reflected share of
/// what lies in the mirrored direction (followed as a chain of its own). The tree is the physics of the same
/// surfaces: at every interface one of both ways, as often as light goes there. Rays to nowhere show the
/// environment (Sky), opaque objects base + diffuse E / pi with E by Illumination, in which refractive
/// objects and mirrors stand in the light's way. The model that is drawn adds the environment's part of E as
/// if nothing stood in its way, smoothed to spherical harmonics of order 2 (brdf/SkyIrradiance.h): that
/// difference is model error. Light that the chain gives up is black. Coverage is 0 where nothing is met and
/// there is no environment.
///
/// Direction: the last one of green light by the chain; coverage is 0 where the chain was given up. Layers:
/// the refractive surfaces that the unbent ray of the eye meets before anything else. Normal (interpolated),
/// depth (m from the eye) and position of the first thing met. All in the pixel's middle.
class GlassEstimator : public Estimator {
public:
    /// @param scene  must outlive this
    /// @return       Error for an AOV that is none of these, or when Embree cannot hold the scene
    static Result<GlassEstimator> create(const scene::Scene& scene, ivec2 size, scene::Aov aov,
                                         const GlassOptions& options);
    Pixel solve(ivec2 pixel) const override;

private:
    GlassEstimator(const scene::Scene& scene, ivec2 size, scene::Aov aov, const GlassOptions& options,
                   Optics optics);
    struct Seen {
        dvec3 radiance;
        bool anything; ///< is there
        bool byChance; ///< another look would differ
    };
    Beam eyeBeam(dvec2 place) const;
    Seen seen(const Beam& beam, Random& random) const;
    dvec3 radiance(const Beam& beam, int channel, Random& random, Seen& seen) const;
    dvec3 shown(const Arrival& arrival, Random& random) const;
    Pixel color(ivec2 pixel) const;
    int layers(const Beam& beam) const;

    Eye eye_;
    ivec2 size_;
    scene::Aov aov_;
    GlassOptions options_;
    std::unique_ptr<Optics> optics_; ///< in one place: the illumination knows it
    Illumination illumination_;
    std::optional<Sky> sky_;
    Media atEye_;
};

/// What a scene's eye sends out through a place of its picture.
///
/// @param around  the media at the eye; an orthographic one stands outside of everything
Beam beamFrom(const Eye& eye, dvec2 place, const Media& around);

/// The media at the eye, of what it sees.
Media mediaAtEye(const Optics& optics, const scene::Camera& camera);

/// Radiance of an opaque surface that receives an irradiance; maps colour height fields.
dvec3 shownBy(const Optics& optics, const Hit& hit, const dvec3& irradiance);

} // namespace lucent::truth
