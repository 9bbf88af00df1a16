#pragma once
/// Displaced surfaces in double precision: heights on a curved base, met exactly.

#include "base/Math.h"
#include "scene/Scene.h"
#include "truth/Field.h"

#include <array>
#include <cstdint>
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
    bool holds(const dvec3& point) const {
        return glm::all(glm::lessThanEqual(low, point)) && glm::all(glm::lessThanEqual(point, high));
    }
};

/// What a ray meets of one shape: how far, and the normals there.
struct Intersection {
    double distance;
    dvec3 normal, smoothNormal;
    int triangle = -1;  ///< of a mesh, or below heights; else -1
    double opacity = 1; ///< Hit::opacity
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

    /// The triangle below a part, in the world, and its vertices in the shape's mesh.
    const std::array<dvec3, 3>& placesOf(unsigned part) const { return triangles_[part].places; }
    const std::array<std::uint32_t, 3>& verticesOf(unsigned part) const { return triangles_[part].vertices; }
    /// Weights of the corners at the foot of a place above one triangle.
    dvec3 weightsAt(unsigned part, const dvec3& place) const;

private:
    struct Triangle {
        std::array<dvec3, 3> places, directions; ///< directions as long as a metre of the object's
        std::array<dvec2, 3> coordinates;        ///< texels
        unsigned walls;
        std::array<std::uint32_t, 3> vertices; ///< of the shape's mesh
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
