#pragma once
/// Displaced surfaces in double precision: heights on a curved base, met exactly.

#include "base/Math.h"
#include "scene/Scene.h"
#include "truth/Field.h"

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

namespace lucent::truth {

struct WorldRay;

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

/// What a ray meets of one shape: how far, and the normals there.
struct Intersection {
    double distance;
    dvec3 normal, smoothNormal;
    int triangle = -1;
    Intersection(double distance, const dvec3& normal) : Intersection(distance, normal, normal) {}
    Intersection(double distance, const dvec3& normal, const dvec3& smoothNormal)
        : distance(distance), normal(normal), smoothNormal(smoothNormal) {}
};

/// What scene/Displacement.h defines, in the world. Between texels heights are bilinear; smooth normals
/// follow their central differences, which are bilinear too, over a base that leans as its normals between
/// corners do. Where a triangle has no neighbour the solid ends in a wall, and in a floor where the base is
/// open.
class DisplacedBody {
public:
    /// @param object  displaced
    explicit DisplacedBody(const scene::Object& object);

    /// One for each triangle of the base.
    unsigned parts() const { return unsigned(triangles_.size()); }
    Box boxOf(unsigned part) const;
    /// The first place above one triangle where a ray comes into the solid, from outside.
    std::optional<Intersection> firstHit(unsigned part, const WorldRay& ray, Stretch stretch) const;

private:
    struct Triangle {
        std::array<dvec3, 3> places, directions; ///< directions as long as a metre of the object's
        std::array<dvec2, 3> coordinates;        ///< texels
        unsigned walls;
    };
    /// Weights of all corners, and the height above the triangle, m of the object's.
    struct Place {
        dvec3 weights;
        double height;
    };
    class Ray;

    double metresAt(const dvec2& texel) const;
    /// No height between two places, in a box around them, is above it [m].
    double highestBetween(const dvec2& a, const dvec2& b) const;
    dvec2 slopeAt(const dvec2& texel) const;       ///< of the bilinear surface, m a texel
    dvec2 smoothSlopeAt(const dvec2& texel) const; ///< of central differences
    double stored(int x, int y) const;
    /// @param isSmooth  whether the base leans as its directions do, not as its triangle
    dvec3 normalAt(const Triangle& triangle, const Place& place, const dvec2& slope, bool isSmooth) const;

    std::vector<Triangle> triangles_;
    std::shared_ptr<const Image> heights_;
    ivec2 blocks_;                  ///< of kBlock texels a side, over one tile
    std::vector<double> highestOf_; ///< stored height in each
    double scale_, highest_;
    bool closed_;
};

} // namespace lucent::truth
