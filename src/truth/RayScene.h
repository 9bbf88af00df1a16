#pragma once
/// Rays through whole scenes: which of many shapes one meets first, and whether any is in its way.
///
/// Embree (3.13) finds the candidates; its numbers are floats. Every hit is therefore solved again in double
/// precision: height fields by their exact cut, spheres and tori in closed form, triangles by their plane.
/// Rays start where they enter the scene's box, so that a distant eye or lamp costs no digits.

#include "base/Math.h"
#include "base/Result.h"
#include "scene/Mesh.h"
#include "truth/Field.h"
#include "truth/Sight.h"

#include <limits>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

namespace lucent::truth {

struct Sphere {
    dvec3 center{0};
    double radius = 1; ///< m, > 0
};

/// All points at distance `minor` from a circle.
struct Torus {
    dvec3 center{0};
    dvec3 axis{0, 0, 1}; ///< unit, perpendicular to the circle
    double major = 1;    ///< m, radius of the circle
    double minor = 0.25; ///< m, <= major
};

/// A height field in the world: a block from its surface down to Field::bottom().
struct FieldBlock {
    std::shared_ptr<const Field> field;
    Placement placement;
};

/// A shape's number is its place in the list that the scene was made of.
using Shape = std::variant<scene::Mesh, FieldBlock, Sphere, Torus>;

/// A ray in world space.
struct WorldRay {
    dvec3 origin;
    dvec3 direction;                                         ///< unit
    double length = std::numeric_limits<double>::infinity(); ///< m
};

/// The beginning of a ray on which one shape is not seen: the one it starts on.
struct Leaving {
    int shape = -1;   ///< -1: none
    double until = 0; ///< m
};

struct Hit {
    dvec3 position;
    dvec3 normal; ///< unit, outward; of a triangle to the side from which its corners run counter-clockwise
    int shape;
    double distance; ///< m from the ray's origin
};

class RayScene {
public:
    /// Error when Embree cannot work on this machine, with its own message.
    static Result<RayScene> create(std::vector<Shape> shapes);
    RayScene(RayScene&&) noexcept;
    ~RayScene();

    /// The nearest hit past the origin. From inside, spheres, tori and meshes are met as well; of a field
    /// only what firstHit() sees is: nothing from inside or below.
    std::optional<Hit> intersect(const WorldRay& ray, const Leaving& leaving = {}) const;

    /// Whether anything is on the ray, its origin included where that lies inside a field.
    bool occluded(const WorldRay& ray, const Leaving& leaving = {}) const;

private:
    struct State;
    explicit RayScene(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

} // namespace lucent::truth
