#pragma once
/// One ray of light on its way through refractive objects, from the eye or from a lamp.

#include "base/Math.h"
#include "truth/Optics.h"
#include "truth/Random.h"
#include "truth/RayScene.h"

#include <optional>

namespace lucent::truth {

/// What becomes of light that an interface could both reflect and transmit.
enum class Branching {
    Chain, ///< the model: it is transmitted, with what Fresnel's equations leave of it
    Tree   ///< the physics: chance takes one way, each as often as light does
};

/// Where the model gives up.
struct Limits {
    int totalReflections = 8;
    int interfaces = 64; ///< surfaces met, mirrors included
    int mirrors = 64;    ///< reflections on mirrors
};
/// So many that what is given up does not count.
inline constexpr Limits kPhysics{4096, 4096, 4096};

/// A ray with what it carries.
struct Beam {
    dvec3 origin, direction; ///< m; unit
    Media media;             ///< around the origin
    dvec3 weight{1};         ///< of each colour
    double begin = 0;        ///< m along the ray; -infinity: a whole line
    bool hitsHidden = false;
};

/// Where a beam got to.
struct Arrival {
    enum class At { Sky, Opaque, Lost };
    At at = At::Lost;
    Hit hit{};                    ///< the place, where opaque
    dvec3 direction{0};           ///< the last one, unit
    dvec3 weight{0};              ///< what is left
    dvec3 absorbed{0};            ///< by media and mirrors
    dvec3 reflected{0};           ///< at interfaces, and not followed
    double firstDistance = 0;     ///< m to the first surface
    double length = 0;            ///< m, of the whole way to the last surface
    int surfaces = 0;             ///< met before, those that changed nothing included
    int bends = 0;                ///< interfaces between unequal indices, total reflections and mirrors
    bool byChance = false;        ///< it met something blended
    std::optional<Beam> mirrored; ///< what the first interface reflects, as `weight` says; chain only
};

/// Follows a beam until it leaves everything, meets something opaque, or one of the limits is passed.
///
/// - Surfaces in one place (RayScene::gap()) are crossed together; something opaque among them ends the way.
/// - A crossing enters its object when the ray runs against the geometric normal, else leaves it; one that is
///   both entered and left in one place stays as it was. Where the medium changes, the ray bends at the
///   interpolated normal of the later object of the two in the scene's list; at the geometric normal where
///   the interpolated one faces the other way.
/// - Light that enters an object keeps `transmission` of itself. Absorption is e^(-sigma length) of every
///   stretch between two surfaces; a way to the sky has no length to absorb it (open meshes).
/// - Total reflection is followed. Objects without `fresnel` reflect nothing else.
///
/// @param channel  whose index of refraction counts: 0, 1, 2
/// @param random   of the tree; not asked by the chain
Arrival follow(const Optics& optics, Beam beam, int channel, Branching branching, const Limits& limits,
               Random& random);

/// What is left of light that goes straight along a ray, [0,1] of each colour: 0 past anything opaque,
/// mirrors and interfaces that bend it. Where an object has the index of vacuum, interfaces between equal
/// indices let light pass, with what `transmission` and absorption leave of it; a way that meets no surface
/// loses nothing.
///
/// @param ray  towards the light or from it; meets what the eye does not see
dvec3 straightTransmittance(const Optics& optics, WorldRay ray, const Leaving& leaving);

} // namespace lucent::truth
