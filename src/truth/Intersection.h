#pragma once
/// Where a ray meets one shape, in double precision.

#include "truth/RayScene.h"

namespace lucent::truth {

Box boxOf(const Shape& shape);
/// Parts of a shape that is no triangles, each with a box of its own and met by itself.
unsigned partsOf(const Shape& shape);
Box boxOf(const Shape& shape, unsigned part);

/// Part of a ray that lies in a box; empty when it passes by.
Stretch within(const Box& box, const WorldRay& ray);

/// The nearest hit within a stretch of the ray of a part of a shape that is no triangles.
std::optional<Intersection> intersect(const Shape& shape, unsigned part, const WorldRay& ray,
                                      Stretch stretch);
/// Whether such a part is in the way there.
bool blocks(const Shape& shape, unsigned part, const WorldRay& ray, Stretch stretch);

/// A triangle that was found, solved by its plane. Nothing where the exact ray passes by it: close to an edge
/// by as much as floats may be wrong is still on it, so that no ray slips through.
std::optional<Intersection> intersectTriangle(const Triangles& triangles, unsigned number,
                                              const WorldRay& ray);

/// The place of a triangle that is nearest to a point, as weights of its corners.
dvec3 nearestWeights(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& point);

} // namespace lucent::truth
