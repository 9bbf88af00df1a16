#pragma once
/// What leaves a medium with layers of other media on it, by diffusion theory.

#include "base/Math.h"

#include <vector>

namespace lucent::truth {

/// What one colour of light finds inside an object, 1/m.
struct Inside {
    double scattering = 0; ///< sigma_s
    double anisotropy = 0; ///< g
    double absorption = 0; ///< sigma_a
    double ior = 1;        ///< over that of the outside
    /// sigma_s' = (1 - g) sigma_s
    double reducedScattering() const { return (1 - anisotropy) * scattering; }
};

/// A layer of one colour's medium.
struct Layer {
    Inside inside;
    double thickness; ///< m
};

/// Egan and Hilgeman's fit of what the boundary reflects of diffuse light inside.
double internalReflection(double ior);

/// R_d(r) of layers on each other, the last of which may be endless.
///
/// A source stands at the mean optical depth of the first collision; its strength is the share of light that
/// scatters there. D phi'' = (sigma_a + D k²) phi holds in each layer, D = 1 / (3 sigma_t'), what flows on
/// between layers is what the partial currents phi / 4 -+ flux / 2 send through Fresnel's boundary, and phi
/// is 0 at 2 A D outside, in a medium with the mean extinction and absorption that the first collisions find
/// (where that would let light in again, phi is 2 A times the flux at the boundary). The coefficients of
/// e^(-q z) and e^(q z) are solved for at each k by elimination, and R_d(r) = integral of R(k) J0(k r) k dk /
/// 2 pi along the real axis, half a period at a time, its sum taken to the limit by Wynn's epsilon algorithm.
class LayeredResponse {
public:
    /// @param layers  the top first; the last one's thickness may be infinite
    /// @param most    m, the largest distance asked for
    LayeredResponse(const std::vector<Layer>& layers, double most);

    /// 1/m²
    double at(double r) const;
    /// m, of the source and of its image above the surface, as of a half space of the medium first met.
    dvec2 depths() const { return depths_; }
    bool isDark() const { return values_.empty(); }

private:
    dvec2 depths_{0};
    double first_ = 0;           ///< log of the first distance
    std::vector<double> values_; ///< logarithms
};

} // namespace lucent::truth
