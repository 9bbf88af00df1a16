#pragma once
/// Rays through whole scenes: which of many shapes one meets first, and whether any is in its way.
///
/// Embree (3.13) finds the candidates where there is one, a tree of boxes elsewhere. Embree's numbers are
/// floats. Every hit is therefore solved again in double precision: height fields by their exact cut, spheres
/// and tori in closed form, ripples between the places where they turn, water cell by cell of its grid,
/// displaced surfaces above each of their triangles, triangles by their plane. Rays start where they enter
/// the scene's box, so that a distant eye or lamp costs no digits, and Embree's begin a little earlier, so
/// that it misses no layer close by.

#include "base/Math.h"
#include "base/Result.h"
#include "truth/Basin.h"
#include "truth/Displaced.h"
#include "truth/Field.h"
#include "truth/Sight.h"

#include <array>
#include <cstdint>
#include <functional>
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

/// Triangles in world space.
struct Triangles {
    std::vector<dvec3> positions;
    std::vector<dvec3> normals; ///< unit, one a position; empty: the triangles' own
    std::vector<std::uint32_t> indices;
    /// The share of a place of a triangle, by the weights of its corners, that is there, [0,1]; empty: all
    /// is.
    std::function<double(unsigned triangle, const dvec3& weights)> opacity{};
};

/// A sheet over a rectangle of its placement's xz plane with the height amplitude sin(wave . (x, z)).
struct Ripple {
    Placement placement;
    dvec2 half{0.5};      ///< m, of the rectangle along x and z
    dvec2 wave{0};        ///< radians per metre along x and z
    double amplitude = 0; ///< m
};

/// A sheet over its placement's xz plane with the heights of a basin of water.
struct Waves {
    Placement placement;
    std::shared_ptr<const Basin> basin;
};

/// A surface that heights lift along its normals.
struct Displaced {
    std::shared_ptr<const DisplacedBody> body;
};

/// A shape's number is its place in the list that the scene was made of.
using Shape = std::variant<Triangles, FieldBlock, Sphere, Torus, Ripple, Waves, Displaced>;

/// A ray in world space.
struct WorldRay {
    dvec3 origin;
    dvec3 direction;                                         ///< unit
    double length = std::numeric_limits<double>::infinity(); ///< m
    double begin = 0;       ///< m; nothing nearer is met. -infinity: a whole line
    bool hitsHidden = true; ///< whether shapes that the eye does not see are met
    /// Whether all that is blended is met, as Hit::opacity says. Else a ray meets either all or nothing
    /// of a place, always the same: many rays in the mean meet the share that is there.
    bool hitsBlended = false;
};

/// The beginning of a ray on which one shape is not seen: the one it starts on.
struct Leaving {
    int shape = -1;   ///< -1: none
    double until = 0; ///< m
};

struct Hit {
    dvec3 position;
    dvec3 normal; ///< unit, outward; of a triangle to the side from which its corners run counter-clockwise
    dvec3 smoothNormal; ///< unit: interpolated between a mesh's vertices, elsewhere the same as `normal`
    int shape;
    double distance;    ///< m from the ray's origin
    int triangle = -1;  ///< of Triangles
    double opacity = 1; ///< the share of the place that is there, (0,1]
};

/// Surfaces that a ray meets at one place, nearest first: faces that lie on each other. A shape appears once
/// entered (its normal against the ray) and once left, whatever number of its triangles meets there.
struct Hits {
    static constexpr int kMost = 16; ///< more are left out, the farthest first
    std::array<Hit, kMost> at;
    int count = 0;

    const Hit* begin() const { return at.data(); }
    const Hit* end() const { return at.data() + count; }
};

/// The place on triangles that is nearest to a point.
struct Nearest {
    std::size_t triangle;
    dvec3 weights;   ///< of its corners, [0,1], their sum 1
    double distance; ///< m
};

class RayScene {
public:
    /// What finds the shapes that a ray may meet. A page has no Embree.
    enum class By { Embree, Boxes };
#ifdef __EMSCRIPTEN__
    static constexpr By kUsual = By::Boxes;
#else
    static constexpr By kUsual = By::Embree;
#endif

    /// Error when Embree cannot work on this machine, with its own message.
    ///
    /// @param hidden  for each shape whether the eye does not see it; empty: it sees all
    static Result<RayScene> create(std::vector<Shape> shapes, const std::vector<bool>& hidden = {},
                                   By by = kUsual);
    RayScene(RayScene&&) noexcept;
    ~RayScene();

    /// The nearest hit of the ray. From inside, spheres, tori and meshes are met as well; of a field
    /// only what firstHit() sees is: nothing from inside or below.
    std::optional<Hit> intersect(const WorldRay& ray, const Leaving& leaving = {}) const;

    /// The nearest hit and all that lie no more than gap() behind it.
    Hits coincidentHits(const WorldRay& ray, const Leaving& leaving = {}) const;

    /// Of all shapes that are triangles; nothing where there are none.
    std::optional<Nearest> nearest(const dvec3& point) const;

    /// Surfaces that are no further apart count as one [m]: 1e-9 of the scene's box, a thousand times what a
    /// hit's place may be off by rounding.
    double gap() const;
    const Shape& shape(int number) const;
    /// A ball around a shape: around its box, or the sphere itself.
    Sphere around(int number) const;

    /// Whether anything is on the ray, its origin included where that lies inside a field.
    bool occluded(const WorldRay& ray, const Leaving& leaving = {}) const;

private:
    struct State;
    Hits search(const WorldRay& ray, const Leaving& leaving, double within) const;
    explicit RayScene(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

} // namespace lucent::truth
