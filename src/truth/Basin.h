#pragma once
/// Water between walls, computed step by step in double precision.

#include "base/Math.h"
#include "scene/Scene.h"

#include <utility>
#include <vector>

namespace lucent::truth {

/// The heights of a sheet of water at a time, m, over its rectangle, which is centred.
///
/// h_tt + damping h_t = speed² (h_xx + h_zz) between walls that mirror waves, on the grid of
/// scene::waterCells by the steps that belong to the water: leapfrog, whose rise lies half a step earlier
/// than its heights; the second derivatives over nine points (Collatz 1960); since the last step heights went
/// on straight. It begins as the travelling sine of Optics.h; a drop (scene::fallingDrop) falls after each
/// dropInterval, at most one a step. Between the grid's lines lies the cubic spline through the heights.
class Basin {
public:
    /// Steps times cells until a time.
    static double work(const scene::Water& water, double time);
    /// @param time  s, >= 0
    Basin(const scene::Water& water, double time);

    struct Surface {
        double height;
        dvec2 slope; ///< its derivatives along x and z
    };
    /// @param place  m along x and z; outside of the walls: what they mirror
    Surface at(const dvec2& place) const;
    dvec2 half() const { return half_; }

    // --- for rays: in cells, x and z from the corner where both are least

    dvec2 inCells(const dvec2& place) const { return (place + half_) / cell_; }
    dvec2 cell() const { return cell_; }
    /// Between which heights the surface lies over a cell, and over all of them.
    std::pair<double, double> range(ivec2 cell) const;
    std::pair<double, double> range() const { return range_; }

private:
    std::size_t number(int x, int z) const;
    void begin(const scene::Water& water, double step);
    void advance(const scene::Water& water, double step);
    void drop(const scene::Water& water, double n);
    void makeSpline();

    ivec2 last_; ///< lines of the grid less one
    dvec2 half_, cell_;
    std::vector<double> heights_, rises_; ///< m and m/s, of the grid's crossings, row after row along x
    std::vector<double> spline_;          ///< weights of cubic B-splines around them
    std::pair<double, double> range_;
};

} // namespace lucent::truth
