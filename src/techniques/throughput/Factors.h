#pragma once
/// Throughput factors from vertex to vertex, and their product with the irradiance of the vertices.

#include "techniques/throughput/Response.h"
#include "techniques/throughput/Stages.h"
#include "techniques/throughput/Surface.h"

#include <span>
#include <vector>

namespace lucent::throughput {

using glm::ivec3;

enum class Global : int {
    Dense,       ///< all factors
    Sparse,      ///< those of at least `threshold` in some colour, as the paper has it
    Hierarchical ///< blocks of far vertices by few products each, to a bound on the error
};

struct FactorOptions {
    Global method = Global::Hierarchical;
    float threshold = 1e-5f; ///< of Sparse
    float epsilon = 0.02f; ///< of Hierarchical: no B_j errs by more than this of what it is under even light
                           ///< as bright as the brightest vertex
    /// Factors of vertices closer than 6 z_r by quadrature over the hat of the one that is lit; else all are
    /// (A_i / 3) R_d(v_i, v_j), which loses light where vertices stand farther apart than z_r.
    bool quadrature = true;
    bool diagonal = true; ///< false: F_jj = 0, where another vector stands for it
    bool operator==(const FactorOptions&) const = default;
};

/// Rows of the matrix F_ij = integral of psi_i(x) R(x, v_j) dA(x), j a row. R is the far part of a response,
/// but all of it where the way over the surface from x to v_j is longer than filters of texels reach although
/// they are as close as its near part does: on the other side of a thin wall.
class FactorRows {
public:
    FactorRows(const Hats& hats, const Response& response, const FactorOptions& options);

    /// Factors of one row by quadrature: what is not in it is onePoint(). Ascending.
    std::vector<std::pair<std::uint32_t, vec3>> close(std::uint32_t j) const;
    vec3 onePoint(std::uint32_t i, std::uint32_t j) const;
    /// All of a row.
    void fill(std::uint32_t j, std::span<vec3> row) const;
    /// Integral of the near part over the surface around a place, as far as it is no other side of a wall.
    vec3 nearAround(const Place& place) const;

private:
    ivec3 cellOf(const vec3& place) const;
    std::size_t cellAt(ivec3 cell) const;
    std::vector<std::uint32_t> trianglesNear(const vec3& place, double radius) const;
    std::vector<bool> beyondWalls(const std::vector<std::uint32_t>& near, const vec3& place,
                                  std::span<const std::uint32_t> seeds) const;
    enum class Part { Far, Whole, Near };
    void integrate(std::uint32_t triangle, const vec3& to, Part part, std::array<dvec3, 3>& sums) const;

    const Hats& hats_;
    const Response& response_;
    FactorOptions options_;
    double radius_ = 0;                             ///< m, of what is near
    double longest_ = 0;                            ///< m, side of a triangle
    std::vector<std::vector<std::uint32_t>> rings_; ///< triangles around each vertex
    ivec3 cells_{1};
    vec3 low_{0}, cellSize_{1};
    std::vector<std::vector<std::uint32_t>> grid_; ///< triangles by the cells of their first corners
};

/// A matrix of factors: B = close E + outer (inner E).
struct Factors {
    Global method = Global::Dense;
    std::uint64_t count = 0; ///< of vertices
    std::vector<vec3> dense; ///< of Dense: row by row
    Rows<vec3> close;        ///< of the others
    Rows<vec3> inner;        ///< of Hierarchical: sums over far vertices
    Rows<vec3> outer;        ///< and what each of them leaves at a vertex

    /// B_j = sum of E_i F_ij.
    std::vector<vec3> product(std::span<const vec3> irradiance) const;
    std::size_t kept() const; ///< factors
    std::size_t bytes() const;
    bool operator==(const Factors&) const = default;
};

/// Works factors out. The work fails (Fault::Machine) where those of so many vertices are more than 2 GiB.
///
/// @param share  of all the stages' work, [0,1]
/// @param made   is whole when what is added ends
void addFactors(Stages& stages, double share, const FactorRows& rows, const Hats& hats,
                const FactorOptions& options, Factors& made);

} // namespace lucent::throughput
