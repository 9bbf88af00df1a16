#pragma once
/// What closed forms of single techniques are drawn with: scenes of a few objects seen along -y, as pictures
/// of a thousand pixels.

#include "measure/SelfCheck.h"

#include <vector>

namespace lucent::measure {

inline constexpr int kSide = 32; ///< pixels of the pictures a side

/// White and matt.
scene::Object objectOf(scene::Shape shape, vec3 place = vec3(0));
/// Clear.
scene::Object glassOf(scene::Shape shape, float ior, vec3 place = vec3(0));

/// Without light; the column grows with x, the row with z.
///
/// @param height  of the picture, m
scene::Scene sceneOf(std::vector<scene::Object> objects, float height);

/// Light of irradiance 1 on what faces it, which comes down at an angle [radians] from straight above, from
/// +x.
void addSun(scene::Scene& scene, double angle = 0);
/// Radiance 1 from all around.
void addWhiteSphere(scene::Scene& scene);

dvec3 valueAt(const Image& image, ivec2 pixel);
/// All colours of all pixels.
void takeAll(Finding& finding, const Image& image, dvec3 expected);

} // namespace lucent::measure
