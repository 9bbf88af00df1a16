#pragma once
/// Objects that have subsurface scattering, for the estimators that know what becomes of it there.

#include "base/Math.h"
#include "base/Result.h"
#include "scene/Scene.h"
#include "truth/Glass.h"
#include "truth/Layered.h"
#include "truth/Optics.h"
#include "truth/Paint.h"
#include "truth/Picture.h"
#include "truth/RayScene.h"
#include "truth/Sight.h"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace lucent::truth {

/// An object that has subsurface scattering.
struct Body {
    int object;                               ///< its number in the scene
    RayScene alone;                           ///< it alone, as shape 0
    std::array<Inside, 3> insides;            ///< of red, green and blue light
    std::array<std::vector<Layer>, 3> layers; ///< on top of it, the top first
    double surfaceIor;                        ///< index of refraction right below the surface
    double thickness;                         ///< m, of the layer below its surface; 0: none
    double meanTransmittance; ///< of its boundary for light from all around: the mean of F_t by the cosine
    std::shared_ptr<const PaintedSurface> painted; ///< null: nothing is

    Paint paintAt(const dvec3& place) const { return painted ? painted->at(place) : Paint{}; }

    /// m, from a place inside to the nearest of its surface.
    double depthOf(const dvec3& place) const;
    /// What a radiosity is as radiance towards a place: F_t(cosine) / (pi mean F_t), 1/sr. All that leaves is
    /// seen from somewhere.
    ///
    /// @param cosine  of the angle outside, [0,1]
    double lobe(double cosine) const;
};

/// A scene with its bodies.
class Bodies {
public:
    /// @param scene  must outlive this
    /// @return       Error when nothing scatters light, or Embree cannot hold the scene
    static Result<Bodies> create(const scene::Scene& scene);

    const Optics& optics() const { return *optics_; }
    const std::vector<Body>& all() const { return bodies_; }
    /// Null when the object is none.
    const Body* of(int object) const;

    /// A place of a body's outside.
    struct Place {
        const Body* body;
        Hit hit;
        dvec3 viewer; ///< unit, to the eye
    };
    /// What the middle of a pixel shows, if it is the outside of a body.
    std::optional<Place> seenAt(const Eye& eye, ivec2 pixel) const;

private:
    explicit Bodies(Optics optics);
    std::unique_ptr<Optics> optics_; ///< in one place
    std::vector<Body> bodies_;
};

/// Pictures of everything else: of the AOV color what GlassEstimator shows, to which bodies that are seen
/// through glass or in mirrors are matt (their diffuse colour); of radiosity nothing. Where the middle of a
/// pixel shows the outside of a body there is what its surface mirrors, by its roughness, and what is matt of
/// it, by its painting.
class Surroundings : public Estimator {
public:
    /// @param bodies  must outlive this
    /// @return        Error for another AOV than color and radiosity, or when Embree cannot hold the scene
    static Result<Surroundings> create(const scene::Scene& scene, const Bodies& bodies, ivec2 size,
                                       scene::Aov aov, int samples, std::uint64_t seed);
    Pixel solve(ivec2 pixel) const override;
    /// What the surface of a body in a pixel mirrors, and what is matt of it.
    Pixel ofSurface(const Bodies::Place& place, ivec2 pixel) const;

private:
    Surroundings(const scene::Scene& scene, const Bodies& bodies, ivec2 size, int samples,
                 std::uint64_t seed);
    const Bodies* bodies_;
    Eye eye_;
    ivec2 size_;
    int samples_;
    std::uint64_t seed_;
    std::optional<GlassEstimator> others_;
    std::optional<Illumination> light_; ///< on surfaces
};

} // namespace lucent::truth
