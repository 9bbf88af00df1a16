#pragma once
/// What texels leave on texels around them, 49 factors each, and the blend with what vertices carry (2002
/// paper, 5.3 and 5.4).

#include "techniques/throughput/Factors.h"

namespace lucent::throughput {

/// Filters of texels around texels.
struct Filters {
    static constexpr int kRadius = 3, kWidth = 2 * kRadius + 1;

    /// kWidth² for each texel that receives, row by row: of the irradiance of the texel there.
    std::vector<vec3> factors;
    /// Of each vertex the texels that leave light there directly: B^d.
    Rows<vec3> direct;

    std::size_t bytes() const { return factors.size() * sizeof(vec3) + direct.bytes(); }
    bool operator==(const Filters&) const = default;
};

/// The filters alone, K = A R_d: added to what vertices carry they count close light twice.
///
/// @param share  of all the stages' work, [0,1]
/// @param made   is whole when what is added ends
void addPlainFilters(Stages& stages, double share, const Surface& surface, const Response& response,
                     Filters& made);

/// Fits, for each texel that is lit, what its triangle's vertices get of it directly, w_v, in place of the
/// diagonal of the factors: such that the sum of all that is interpolated leaves on the border of 9 x 9
/// texels what their filter does. That sum is subtracted from the filter of 7 x 7: within it, light is the
/// filter's.
///
/// The sum that the paper prints takes the hats at the texel that is lit, so that they are constants; they
/// are taken at the texels of the border. Where the border cannot tell the three vertices apart w_v stays
/// near what the factors' diagonal would leave. And, ours, one more equation asks that all light outside of
/// the filter, that of the border and beyond, be as much as R_d leaves there: without it the fit is free to
/// gain or lose energy wherever vertices stand farther apart than the border is wide.
///
/// @param rows     without diagonal
/// @param factors  of these rows
/// @param whole    sums of the rows with diagonal: what leaves of even light
void addFittedFilters(Stages& stages, double share, const Surface& surface, const Response& response,
                      const FactorRows& rows, const Factors& factors, std::span<const vec3> whole,
                      Filters& made);

} // namespace lucent::throughput
