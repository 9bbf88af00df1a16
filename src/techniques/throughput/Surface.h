#pragma once
/// The surface of an object as precomputed throughput samples it: vertices, between which light is linear,
/// and texels of an atlas, on each of which it is even.

#include "base/Math.h"
#include "scene/Atlas.h"
#include "techniques/throughput/Stages.h"

#include <array>
#include <cstdint>
#include <vector>

namespace lucent::throughput {

/// Rows of a matrix of which most is 0.
template <class Value>
struct Rows {
    std::vector<std::uint32_t> starts{0}; ///< of each row in the rest, and where the last one ends
    std::vector<std::uint32_t> columns;   ///< ascending within a row
    std::vector<Value> values;

    std::size_t count() const { return starts.size() - 1; }
    std::size_t bytes() const {
        return starts.size() * sizeof starts[0] + columns.size() * (sizeof columns[0] + sizeof(Value));
    }
    bool operator==(const Rows&) const = default;
};

/// Vertices of a mesh with the basis of linear interpolation: the hat of a vertex is 1 there and 0 at all
/// others. Vertices at one place are one; those of no triangle with an area are left out.
struct Hats {
    std::vector<vec3> positions;                         ///< m
    std::vector<vec3> normals;                           ///< unit, outward
    std::vector<double> areas;                           ///< A_v: of all triangles around a vertex, m²
    std::vector<std::array<std::uint32_t, 3>> triangles; ///< those that have an area
    std::vector<double> triangleAreas;                   ///< m²
    std::vector<std::uint32_t> sources;                  ///< which triangle of the mesh each one is
    /// Triangle across the side from corner i to corner i + 1; kNone where none or several are.
    std::vector<std::array<std::uint32_t, 3>> across;
    static constexpr std::uint32_t kNone = ~0u;

    std::size_t count() const { return positions.size(); }
    double area() const;
    /// Mean distance of neighbours: of the equal triangles that as many vertices would have, m.
    double spacing() const;
    /// Of all triangles, m.
    double longestSide() const;
};

/// @param scale  metres a unit of the mesh
Hats hatsOf(const scene::Mesh& mesh, float scale);

/// Something on the surface.
struct Place {
    std::uint32_t triangle = 0; ///< of Hats
    vec3 weights{0};            ///< of its corners: the values of their hats
};
vec3 positionAt(const Hats& hats, const Place& place);
vec3 normalAt(const Hats& hats, const Place& place);

/// A texel that shows some of the surface.
struct Texel {
    ivec2 at{0};
    Place place;               ///< of its middle
    float area = 0;            ///< of the surface that it stands for, in its chart or the border around, m²
    float own = 0;             ///< of its chart's own surface in it, m²: these add up to the object's
    std::uint32_t isShown = 0; ///< 1: it or a texel beside it has some, so that bilinear reading takes it
};

/// The texels of an atlas. Those around a chart show the surface that goes on there, unfolded across the
/// chart's edge, so that all within `border` texels of a place of a chart is there, but past open edges.
struct Texels {
    int side = 0;
    float size = 0; ///< m, of a texel on what lies in its chart's plane
    std::vector<Texel> list;
    std::vector<std::int32_t> indexAt; ///< in `list`, row by row; -1: shows nothing

    int find(ivec2 at) const {
        const bool inside = at.x >= 0 && at.y >= 0 && at.x < side && at.y < side;
        return inside ? indexAt[std::size_t(at.y) * std::size_t(side) + std::size_t(at.x)] : -1;
    }
};

/// Everything that is sampled of an object.
struct Surface {
    Hats hats;
    Texels texels;
    std::vector<std::array<vec2, 3>> places; ///< of each triangle's corners in the atlas, texels
    /// Of each vertex the texels around it: the integral over each one's own surface of the dual basis
    /// (3 / A_v) (4 beta_v - 1). They add up to 1 exactly, however small or thin triangles are: what a texel
    /// has of a triangle is cut out, not sampled.
    Rows<float> duals;
};

/// Lays a mesh out.
///
/// @param scale   metres a unit of the mesh
/// @param side    texels of the atlas
/// @param border  texels
/// @param taken   called once; with an Error where the mesh does not fit into such an atlas, or has no area
void addSurface(Stages& stages, std::shared_ptr<const scene::Mesh> mesh, float scale, int side, int border,
                std::function<Status(Result<Surface>)> taken);

} // namespace lucent::throughput
