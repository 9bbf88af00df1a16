#pragma once
/// Pictures of scenes with refractive and mirroring objects.

#include "base/Result.h"
#include "scene/Scene.h"
#include "truth/Lamps.h"
#include "truth/LightPath.h"
#include "truth/Optics.h"
#include "truth/Picture.h"
#include "truth/Sight.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace lucent::truth {

struct GlassOptions {
    Branching branching = Branching::Chain;
    int samples = 256; ///< of each pixel in which something is left to chance; > 0
    std::uint64_t seed = 0;
    Attenuation attenuation = Attenuation::Ratio; ///< of light inside height fields
};

/// What the eye sees.
///
/// Color: the chain is the model that is drawn: the eye's ray is refracted at every interface and shows what
/// it meets in the end, times the transmitted shares, plus, by the first interface, the reflected share of
/// what lies in the mirrored direction (followed as a chain of its own). The tree is the physics of the same
/// surfaces: at every interface one of both ways, as often as light goes there. Rays to nowhere show the
/// environment (Sky; height fields alone stand before nothing), opaque objects Illumination::radiance(), in
/// which refractive objects and mirrors stand in the light's way. Light that the chain gives up is black.
/// Coverage is 0 where nothing is met and no environment shows.
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
    bool background_ = false; ///< the eye sees the environment behind everything
    Media atEye_;
};

/// What a scene's eye sends out through a place of its picture.
///
/// @param around  the media at the eye; an orthographic one stands outside of everything
Beam beamFrom(const Eye& eye, dvec2 place, const Media& around);

/// The media at the eye, of what it sees.
Media mediaAtEye(const Optics& optics, const scene::Camera& camera);

} // namespace lucent::truth
