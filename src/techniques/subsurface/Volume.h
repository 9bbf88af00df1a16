#pragma once
/// Diffusion solved inside the body: where profiles of a plane go wrong, behind a body, round its edges and
/// through its thin parts, this follows the light itself.

#include "techniques/subsurface/Entering.h"

#include <map>

namespace lucent::subsurface {

/// Solutions, kept for as long as light, bodies and media stay as they are: where only the camera moves, what
/// leaves is looked up in them.
class Volumes {
public:
    /// What a solution depends on.
    struct Key {
        EnteredKey entered;
        std::array<diffusion::Medium, 3> media; ///< of the body
        int cells = 0;                          ///< along its longest side
        bool operator==(const Key&) const = default;
    };
    struct Solution {
        Key key;
        graph::Texture cells, fluence;
        bool solved = false; ///< by a graph that ran
    };

    /// The solution of an object of the scene, to be solved anew where it is by another key.
    ///
    /// @param key  nothing: what it depends on may change unseen
    std::shared_ptr<Solution> of(int object, const std::optional<Key>& key);
    /// Forgets those of all other objects.
    void keepOnly(const std::vector<int>& objects);

private:
    std::map<int, std::shared_ptr<Solution>> solutions_;
};

/// What leaves at each pixel of scattering objects, W/m². Each object is cut into cells, in which the
/// diffusion equation -div(D grad phi) + sigma_a phi = Q is solved for the light that enters, with phi = 2 A
/// D dphi/dn at its surface (Haskell et al. 1994). Light first scatters along the refracted ray, not at one
/// depth. Cells at the surface hold what of them lies inside, so that it shows no steps.
///
/// Parts of a body that are thinner than a cell are as bright on both sides, which thicker ones than some
/// mean free paths are not.
Result<Radiosity> recordVolumes(graph::FrameGraph& graph, gl::Context& context, const Inputs& in,
                                const Plan::State& plan, const Entering& entering, const Settings& settings,
                                Volumes& volumes);

/// Cells along the axes, the ring around the body included, and their width.
struct Cells {
    glm::ivec3 count{0};
    float width = 0; ///< m
    vec3 low{0};     ///< corner, world
    int across = 1;  ///< slices in a row of the image

    ivec2 imageSize() const { return {count.x * across, count.y * ((count.z + across - 1) / across)}; }
};
Cells cellsOf(const views::Bounds& body, int along);
/// Views along x, y and z in which light enters the cells, and their pixels.
std::array<views::Eye, 3> axesOf(const Cells& cells);
ivec2 pixelsOf(const views::Eye& axis, const scene::Object& object, const Cells& cells,
               const gl::Context& context);

/// Rounds that a solution takes at most: where a thousandth takes more, cells are a hundred mean free paths
/// wide and tell nothing of the light in them anyway.
inline constexpr int kMostRounds = 2000;

/// How many rounds bring Chebyshev's iteration within a thousandth of the solution, kMostRounds at most, and
/// its largest eigenvalue.
struct Rounds {
    int count = 1;
    dvec3 radius{0}; ///< of Jacobi's iteration, per colour
};
Rounds roundsOf(const std::array<diffusion::Medium, 3>& media, const Cells& cells);

} // namespace lucent::subsurface
