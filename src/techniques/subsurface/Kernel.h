#pragma once
/// What one splat leaves around it: a diffusion profile, cut where little is left of it, blurred where its
/// points lie too far apart for it, and split into bands of which the wide ones need few points and few
/// pixels.

#include "diffusion/Profile.h"

#include <array>
#include <vector>

namespace lucent::subsurface {

/// Across an object, of any material: what lies between them is its shape.
inline constexpr double kLeastPoints = 16;

/// What is asked of a kernel.
struct KernelWish {
    diffusion::Shape shape = diffusion::Shape::Dipole;
    double thickness = 0;    ///< m, of a slab; 0: none
    double epsilon = 0.01;   ///< error of its integral over the surface
    double size = 1;         ///< m, beyond which the object has no points
    double leastSpacing = 0; ///< m: points stand no closer
    double sharpest = 1;     ///< M_d: largest factor of distances that a painting has, >= 1
    bool split = false;      ///< into bands
    bool shares =
        false; ///< tables of each band's share of the profile, for those who compute the profile themselves
    bool operator==(const KernelWish&) const = default;
};

/// A part of the profile that points of one density carry to places of one density.
struct Band {
    double spacing = 0; ///< m, between points on the surface
    double pixel = 0;   ///< m, between places that get its light; 0: every pixel
    double reach = 0;   ///< m; nothing beyond
    /// At r = reach (i / (n - 1))², linear in i: 1/m², or shares of the profile. a: unused.
    std::vector<vec4> table;
};

struct Kernel {
    std::vector<Band> bands; ///< narrow ones first; they add up to the profile
    double blur = 0;         ///< m, standard deviation by which the profile was widened; 0: not at all
    double spread = 0;       ///< m, radius within which half of the light leaves, before that
    double sharpest = 1; ///< M_d up to which points can stand close enough; below 1: not even those of the
                         ///< material itself
};

/// Distance of the points of a square lattice at which the sum over them is a dipole's integral, but for
/// `epsilon`: the lattice's first harmonics are 4 e^(-2 pi z_r / s) of it.
double latticeSpacing(double epsilon, double depth);

/// The kernel of a material.
///
/// Where points can stand no closer than wish.leastSpacing, the profile is blurred by the Gaussian that keeps
/// the lattice's harmonics below epsilon: the picture is softer than the medium, its light is not less.
///
/// Where M_d is painted, the profile holds of distances times M_d, and so do the bands' lengths: points of a
/// larger M_d stand closer. Such a body is that many times as large.
///
/// A split profile is S_0 = (S_0 - S_1) + (S_1 - S_2) + ... + S_n: S_i is the profile beyond a distance c_i
/// and an even polynomial with the same value, slope and bend within (multilevel summation; Hardy, Skeel
/// 2006), such that a lattice 2^i times as wide sums it.
Kernel kernelOf(const std::array<diffusion::Medium, 3>& media, const KernelWish& wish);

/// Points along a side of a view `width` metres wide that eq. 6.17 and 6.18 of the dissertation ask for,
/// where R_d(0) / (n_o R_d(reach)) < epsilon. They are many: the equations compare the highest value of the
/// profile with the lowest, not a sum with its integral.
double papersSplats(const std::array<diffusion::Medium, 3>& media, const KernelWish& wish, double width);

} // namespace lucent::subsurface
