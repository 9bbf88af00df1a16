#pragma once
/// Diffusion solved inside the body: where profiles of a plane go wrong, behind a body, round its edges and
/// through its thin parts, this follows the light itself.

#include "subsurface/Splatting.h"

namespace lucent::subsurface {

/// What leaves at each pixel of scattering objects, W/m². Each object is cut into cells, in which the
/// diffusion equation -div(D grad phi) + sigma_a phi = Q is solved for the light that enters, with phi = 2 A
/// D dphi/dn at its surface (Haskell et al. 1994). Light first scatters along the refracted ray, not at one
/// depth. Cells at the surface hold what of them lies inside, so that it shows no steps.
///
/// Parts of a body that are thinner than a cell are as bright on both sides, which thicker ones than some
/// mean free paths are not.
Result<Radiosity> recordVolumes(graph::FrameGraph& graph, gl::Context& context, const Inputs& in,
                                const Plan::State& plan, const Settings& settings);

/// Cells along the axes, the ring around the body included, and their width.
struct Cells {
    glm::ivec3 count{0};
    float width = 0; ///< m
    vec3 low{0};     ///< corner, world
    int across = 1;  ///< slices in a row of the image

    ivec2 imageSize() const { return {count.x * across, count.y * ((count.z + across - 1) / across)}; }
};
Cells cellsOf(const views::Bounds& body, int along);

/// How many rounds bring Chebyshev's iteration within a thousandth of the solution, and its largest
/// eigenvalue.
struct Rounds {
    int count = 1;
    dvec3 radius{0}; ///< of Jacobi's iteration, per colour
};
Rounds roundsOf(const std::array<diffusion::Medium, 3>& media, const Cells& cells);

} // namespace lucent::subsurface
