#pragma once
/// What an artist painted on an object (image-space dissertation 2007, ch. 7), at places in the world.

#include "base/Math.h"
#include "base/Result.h"
#include "scene/Scene.h"
#include "truth/RayScene.h"

#include <memory>
#include <vector>

namespace lucent::truth {

/// At one place; what nobody painted is 1.
struct Paint {
    dvec3 entering{1};       ///< M_i, of light that enters there
    double sharpness = 1;    ///< M_d, of how it spreads
    dvec3 leaving{1};        ///< factor of light that leaves there
    double translucency = 1; ///< t: the rest of the surface is matt
};

/// An object's maps, read bilinearly (middles of texels at + 0.5) at the nearest place of its atlas' mesh as
/// it stands in the world: on spheres and tori, which are exact here, that mesh lies close by.
class PaintedSurface {
public:
    /// @param object  with a painting, and no height field
    /// @param time    s
    /// @return        Error where its mesh has no atlas, or Embree cannot hold it
    static Result<PaintedSurface> create(const scene::Object& object, double time);

    Paint at(const dvec3& place) const;
    /// Least and most of M_d in the map.
    dvec2 sharpness() const;

private:
    PaintedSurface(std::shared_ptr<const scene::Painting> painting, RayScene mesh, std::vector<dvec2> places);

    std::shared_ptr<const scene::Painting> painting_;
    RayScene mesh_;             ///< shape 0
    std::vector<dvec2> places_; ///< texels, of its vertices
};

} // namespace lucent::truth
