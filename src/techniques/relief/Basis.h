#pragma once
/// The basis of a transfer: directions on which d of one height field depends in few ways.
///
/// d(texel, direction) of a field is a matrix of low rank. A sample of its rows shows which functions of the
/// direction the rows are made of (principal components, as in clustered transfer, Sloan et al. 2003, with
/// one cluster), and how to find the coefficients of any other row from its values in fewer directions.

#include "base/Image.h"
#include "base/Math.h"

#include <span>
#include <vector>

namespace lucent::relief {

/// The sphere in rings of about square cells of nearly equal solid angle, about an axis that no scene is
/// likely to be aligned with: a horizon that ran along a ring would fall into one ring or the other as a
/// whole.
class Cells {
public:
    explicit Cells(int count);
    int count() const { return int(directions_.size()); }
    const std::vector<vec3>& directions() const { return directions_; } ///< middles
    int cellOf(vec3 direction) const;

private:
    std::vector<int> first_, columns_;
    std::vector<vec3> directions_;
};

/// Directions spread evenly over the sphere on a spiral (Fibonacci lattice).
std::vector<vec3> spiral(int count);

/// What the light of an environment is on one basis.
struct Projection {
    std::vector<vec4> light; ///< one for each term; a: for the mean of d
    /// RMSE of colour over its mean when 4, 8, 12, ... terms are used, on rows kept back while learning.
    std::vector<float> errors;
};

class Basis {
public:
    /// @param rows    d for a texel a row: `cells` values from the first column on, `sensors` values from
    /// column
    ///                `firstSensor` on. A quarter of the rows is kept back to know the error
    /// @param terms   wanted number of basis functions, a multiple of 4; fewer when the rows have fewer
    void learn(const Image& rows, int cells, int firstSensor, int sensors, int terms);

    int terms() const { return terms_; }
    /// How much of a value in sensor direction `sensor` goes into coefficient `term`.
    float fit(int term, int sensor) const { return fit_[std::size_t(term * sensors_ + sensor)]; }
    /// @param flux      light that comes from each cell: colour, and share of the sphere; one for each cell
    /// @param measures  false: leaves the errors out, which take most of the time
    Projection project(std::span<const vec4> flux, bool measures) const;

private:
    int terms_ = 0, cells_ = 0, sensors_ = 0, kept_ = 0;
    std::vector<float> values_;                        ///< terms x cells
    std::vector<float> fit_;                           ///< terms x sensors
    std::vector<float> keptValues_, keptCoefficients_; ///< kept x cells, kept x terms
};

} // namespace lucent::relief
