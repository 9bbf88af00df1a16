#pragma once
/// Where a ray meets one shape, in double precision.

#include "truth/RayScene.h"

namespace lucent::truth {

struct Box {
    dvec3 low{std::numeric_limits<double>::infinity()}, high{-std::numeric_limits<double>::infinity()};
    void add(const dvec3& point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    void add(const Box& box) {
        add(box.low);
        add(box.high);
    }
};

Box boxOf(const Shape& shape);

/// Part of a ray that lies in a box; empty when it passes by.
Stretch within(const Box& box, const WorldRay& ray);

/// What a ray meets of one shape: how far, and the normals there.
struct Intersection {
    double distance;
    dvec3 normal, smoothNormal;
    int triangle = -1;
    Intersection(double distance, const dvec3& normal) : Intersection(distance, normal, normal) {}
    Intersection(double distance, const dvec3& normal, const dvec3& smoothNormal)
        : distance(distance), normal(normal), smoothNormal(smoothNormal) {}
};

/// The nearest hit within a stretch of the ray of a shape that is no triangles.
std::optional<Intersection> intersect(const Shape& shape, const WorldRay& ray, Stretch stretch);
/// Whether such a shape is in the way there.
bool blocks(const Shape& shape, const WorldRay& ray, Stretch stretch);

/// A triangle that was found, solved by its plane. Nothing where the exact ray passes by it: close to an edge
/// by as much as floats may be wrong is still on it, so that no ray slips through.
std::optional<Intersection> intersectTriangle(const Triangles& triangles, unsigned number,
                                              const WorldRay& ray);

/// The place of a triangle that is nearest to a point, as weights of its corners.
dvec3 nearestWeights(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& point);

} // namespace lucent::truth
