#pragma once
/// The relief model solved exactly, in double precision: what every relief picture is measured against.
///
/// A point below the surface looks at the light; the length r of its way through the solid, against the depth
/// t of the point, says how much light arrives (height-field thesis 2017, 3.2.1; d = t/r and the displacement
/// along the real normal, where its text is loose). The length is summed over the pieces of Field::cut(),
/// whose quadratics are recovered from samples of the surface and solved; nothing is stepped or estimated.
///
/// Everything here is in the object's space.

#include "base/Math.h"
#include "scene/Scene.h"
#include "truth/Field.h"
#include "truth/Lights.h"

#include <vector>

namespace lucent::truth {

/// How d falls with the length r inside: t/r, or the exponential with the same value and slope at r = t.
enum class Attenuation { Ratio, Exponential };

/// Length of the stretch that is inside the solid; infinite for a ray that stays below the field.
double insideLength(const Field& field, const Ray& ray, Stretch stretch);

/// First ray parameter that is inside the solid; infinite when there is none.
double firstInside(const Field& field, const Ray& ray, Stretch stretch);

/// The way from `depth` below the surface point to the light. When the light is at that very place, its
/// direction is the normal's.
LightPath lightPath(const SurfacePoint& point, double depth, const LightSource& light);

/// False when anything solid is on the straight way from the surface point to the light, farther than one
/// texel (horizontally) from the point.
bool visible(const Field& field, const SurfacePoint& point, const LightSource& light);

/// The illumination factor d, [0,1]: 1 where the light's way inside is not longer than `depth`.
///
/// Below half a texel of depth it is the model's limit by definition: visibility times the cosine between
/// normal and light (ratio) or exp(1 - 1/cosine) (exponential).
double illumination(const Field& field, const SurfacePoint& point, double depth, const LightSource& light,
                    Attenuation attenuation);

/// All that lights an object, in its space.
struct Lighting {
    std::vector<LightSource> lamps;
    std::vector<LightSource> environment; ///< four to each cell of the sky, as environmentLights() gives them
};

/// How the discs of soft lamps are sampled.
struct DiscSampling {
    int samples = 256; ///< > 0; rounded up to four (mirroredPairs) in each of k² cells
    Random random{0, 0, 0};
};

/// Values are estimates where an environment or a disc was sampled: the variances are the squares of their
/// standard errors, 0 under points and single directions.
struct Shading {
    dvec3 color{0};          ///< linear Rec. 709
    double illumination = 0; ///< d averaged over the lights by weight; 0 without lights
    dvec3 colorVariance{0};
    double illuminationVariance = 0;
};

/// The material's depth t in metres of the object's space.
double depthInObject(const scene::Object& object);

/// Colour of a point of the surface: the thesis's equation (3.5) summed over the lights, the base colour
/// once. Under a soft lamp d, highlight and forward scattering are means over its disc, every point of it
/// with its own direction and distance; the disc faces the moved point.
///
/// @param eyeDirection  unit, from the eye to the point that lies the material's depth below the surface
Shading shade(const Field& field, const scene::Object& object, const SurfacePoint& point,
              const dvec3& eyeDirection, const Lighting& lighting, Attenuation attenuation,
              DiscSampling discs = {});

} // namespace lucent::truth
