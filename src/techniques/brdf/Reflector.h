#pragma once
/// How glossy materials send light back, by the very lines that the shaders run (shaders/brdf/models.glsl).

#include "scene/ReflectanceTable.h"

namespace lucent::brdf {

/// What models.glsl calls a Reflector, as blocks of shaders hold it.
struct ReflectorValues {
    vec4 diffuse; ///< a: 1
    vec4 specular;
    vec4 lobe; ///< alpha, exponent, asPrinted, model
};
ReflectorValues reflectorOf(const scene::Material& material);

/// Alpha of the GGX facets by which directions of a glossy lobe are chosen.
float facetAlphaOf(const scene::Material& material);
/// Whether a surface mirrors in a lobe at all: Oren and Nayar's does not.
bool hasLobe(const scene::Material& material);
/// Whether it shows the objects around in what it mirrors, somewhere (scene::kMostMirroringRoughness).
bool showsObjects(const scene::Object& object);

/// BRDF times the light's cosine, 1/sr of each colour.
///
/// @param normal, toLight, toEye  unit
vec3 shareOf(const scene::Material& material, vec3 normal, vec3 toLight, vec3 toEye);

/// The BRDF itself, for many directions around a normal of +z, both above the surface.
scene::Brdf brdfOf(const scene::Material& material);

/// Share of even light from all around that is seen from a cosine to the normal, of each colour: the white
/// furnace's number, which no more than 1 of conserves energy. To 0.5 %.
vec3 directionalAlbedo(const scene::Material& material, float cosine);

/// The largest difference of the BRDF between two directions and the same two exchanged, over its larger
/// value, of some hundred pairs: rounding alone, for models that are reciprocal.
float reciprocityError(const scene::Material& material);

/// How far a table of the BRDF is from it (scene/ReflectanceTable.h): the root of the mean squared difference
/// of green over its mean, over pairs of directions that stand evenly by solid angle, to 1 degree above the
/// surface.
///
/// @param blocks, texels  n and m; of no meaning to Merl
float tableError(const scene::Material& material, scene::TableForm form, int blocks, int texels, int pairs);

} // namespace lucent::brdf
