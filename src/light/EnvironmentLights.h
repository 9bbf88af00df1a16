#pragma once
/// An environment as a few lights: equal rings of the sphere, each light with the mean radiance of its cell.

#include "scene/Scene.h"

#include <vector>

namespace lucent::views {

struct EnvironmentLight {
    vec3 direction; ///< world, unit, towards the light
    vec3 radiance;  ///< mean over its cell, linear Rec. 709
    float weight;   ///< solid angle of its cell over 4 pi; all weights sum to 1
    float spread;   ///< of its light's directions: standard deviation along each axis across it, radians
};

/// Divides the sphere of directions into about `count` cells of nearly equal solid angle (rings of latitude,
/// each cut into as many cells as its length asks for) and averages the map over each, weighted by solid
/// angle: summing map pixels without sin(phi) would over-weight the poles (thesis 2017, 3.2.2). A light
/// stands at the centre of its cell's light: an edge of something bright cuts cells.
///
/// @param count   wanted number of lights, >= 6; the result differs by a few
/// @param offset  [0,1)²: cells begin that much of one later, from ring to ring and around each
/// The cells are fixed to the map and turn with `environment.rotation`; `intensity` is included.
std::vector<EnvironmentLight> environmentLights(const scene::Environment& environment, int count,
                                                vec2 offset = vec2(0));

/// `count` lights that stand closer where more light comes from: the sphere is cut in two again and again,
/// always the part whose light is spread widest, through the middle of its light (after median cut, Debevec
/// 2005). A light stands at the centre of its part's light, carries all of it, and its weight is the part's
/// share of the sphere.
///
/// @param count    > 0
/// @param sample   [0, samples)
/// @param samples  > 1: every part that can be is cut further, into an even piece for each, which stands
///                 for all of the part there: their mean has that many times as many lights
std::vector<EnvironmentLight> importanceLights(const scene::Environment& environment, int count,
                                               int sample = 0, int samples = 1);

/// The most that a white matt surface sends under the environment alone, whichever way it faces, of the
/// brightest colour: W/(m² sr), to some percent.
float brightestWhite(const scene::Environment& environment);

} // namespace lucent::views
