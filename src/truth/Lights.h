#pragma once
/// Light as the estimators see it: lamps, which may be discs, and environments as directions.

#include "base/Math.h"
#include "scene/Scene.h"
#include "truth/Random.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace lucent::truth {

/// A lamp in the space of its user: the world's or an object's.
struct LightSource {
    dvec3 place{0};             ///< position, or the unit vector to a distant light
    bool distant = false;       ///< infinitely far away
    bool inverseSquare = false; ///< fades with the square of the distance; else not at all
    dvec3 color{1};             ///< intensity included
    double weight = 1;          ///< its share when d is averaged over the lights
    /// Of an even disc that faces what it lights: metres, or the tangent of half the angle of a distant
    /// light. 0: a point, or one direction.
    double radius = 0;
};

/// The way from a place to a light.
struct LightPath {
    dvec3 direction; ///< unit
    double distance; ///< infinite for distant lights
};

/// A point of a soft light's disc as a light of its own, with the whole disc's colour.
///
/// The disc of a lamp is centred at its position and perpendicular to the way from `from` to it (to z where
/// that has no length); that of a distant light holds the directions l + radius * place, normalised, with
/// `place` perpendicular to l.
///
/// @param from   what is lit
/// @param place  in the unit disc
LightSource pointOnDisc(const LightSource& light, const dvec3& from, dvec2 place);

/// The unit disc in rings² cells of equal area: ring k has 2k + 1 of them.
///
/// @param cell    [0, rings²)
/// @param within  [0,1) each: the place in the cell, even by area
dvec2 placeInDiscCell(int rings, int cell, dvec2 within);

/// Any place of the unit disc, even by area.
///
/// @param within  [0,1) each
dvec2 placeInDisc(dvec2 within);

/// Four places in a unit square: two independent ones, each followed by its mirror image at the middle. A
/// mirrored pair has no error where the integrand is linear; the two pairs' difference tells the error that
/// is left.
std::array<dvec2, 4> mirroredPairs(Random& random);

/// A point or distant light in world space; nothing for others, which relief does not know.
std::optional<LightSource> sourceOf(const scene::Light& light);

/// All sourceOf() of a scene for a surface whose diffuse colour is what it sends back of an irradiance of pi
/// (Lambert): divided by pi.
///
/// @param normalise  divide their light by the number of lights, an environment counting as one
std::vector<LightSource> worldLamps(const scene::Scene& scene, bool normalise);

/// The environment if there is one and it shines, with its intensity (divided among the lights as theirs).
std::optional<scene::Environment> shiningEnvironment(const scene::Scene& scene, bool normalise);

/// What the mean of an environment over the sphere is multiplied by to be the irradiance of all its
/// directions on surfaces that face them, over pi: 4 pi sr / pi.
inline constexpr double kMeanToLambert = 4;

/// What directions on an environment are chosen for.
enum class Choice {
    Evenly,  ///< every solid angle counts alike: the average of d
    ByLight, ///< more where the map is brighter: colours
};

/// An environment as distant lights in world space, four (mirroredPairs) to each cell of a grid of equal
/// solid angles. `weight` is solid angle / 4 pi; `color` is such that the sum over the lights estimates the
/// mean of radiance times intensity over the sphere without bias: bright pixels inside a cell are chosen more
/// often.
///
/// @param count  number of lights, > 0; rounded up to a multiple of four
std::vector<LightSource> environmentLights(const scene::Environment& environment, int count, Choice choice,
                                           std::uint64_t seed);

/// Chooses independent directions on an environment, in proportion to the light (red, green and blue added)
/// that comes from each, or evenly.
class EnvironmentSampler {
public:
    EnvironmentSampler(const scene::Environment& environment, Choice choice);
    /// A distant light in world space whose color is an unbiased estimate of the whole environment's: the
    /// mean of radiance times intensity over the sphere. Black when the map is.
    ///
    /// @param within  [0,1) each
    LightSource choose(dvec2 within) const;
    /// How densely choose() takes directions around one, 1/sr.
    ///
    /// @param direction  unit, in world space
    double density(const dvec3& direction) const;

private:
    bool isEven() const { return choice_ == Choice::Evenly || upTo_.back() <= 0; }
    std::shared_ptr<const Image> map_;
    Choice choice_;
    glm::dmat3 worldFromMap_;
    double intensity_;
    std::vector<double> upTo_; ///< light of all pixels up to and with each, row by row
};

/// What an environment shows in each direction: bilinear between the centres of its map's texels, across the
/// seam at the map's left and right edge too; above the first row's centres and below the last row's constant
/// down each column.
class Sky {
public:
    explicit Sky(const scene::Environment& environment);
    /// Radiance times intensity.
    ///
    /// @param direction  unit, in world space, away from the one who looks
    dvec3 radiance(const dvec3& direction) const;

private:
    std::shared_ptr<const Image> map_;
    glm::dmat3 worldFromMap_;
    double intensity_;
};

/// Rotation about the fixed x, then y, then z axis.
glm::dmat3 rotation(vec3 degrees);

} // namespace lucent::truth
