#pragma once
/// Diffusion through layers of different media that lie on each other.

#include "diffusion/Profile.h"

#include <complex>
#include <vector>

namespace lucent::diffusion {

/// What leaves a medium with its slabs (Medium::above), the top first, of one colour.
///
/// As polesOf() has it for one medium, light starts to diffuse at the depth of the first collision: at its
/// mean optical depth, counted through all slabs, with the albedo of the media in which it happens, by their
/// shares of it. From there the diffusion equation D (k² phi - phi'') + sigma_a phi = 0 is solved for waves
/// of spatial frequency k along the plane. The flux passes from slab to slab; phi does so too where indices
/// of refraction are equal, and elsewhere by the partial currents that Fresnel's equations let through
/// (Shendeleva 2004). Outside, phi is 0 at z_b = 2 A D, D that of the media of the first collision. So slabs
/// of one medium are that medium, and a slab may become thinner until it is gone (where indices are equal)
/// without a step. In stacks thinner than z_b, where light could enter again in that model, phi is 2 A times
/// the flux at the boundary itself.
///
/// That is what Donner and Jensen's (2005) R12 = R1 + T1 R2 T1 / (1 - R2 R1) sums up, but for light that is
/// not yet diffuse between two slabs, to which their sum gives sources of its own.
class Stack {
public:
    /// Where light leaves.
    enum class Side { Lit, Other };

    /// @param thickness  m, of the medium below all slabs; 0 or infinite: a half space, which has one side
    Stack(const Medium& medium, double thickness, Side side = Side::Lit);

    /// Share of the light that leaves on this side.
    double total() const { return total_; }
    /// Flux at distance r from where light enters, 1/m²; 0 where less than 1e-9 of the light is left.
    double at(double r) const;
    /// Its integral over a disc.
    double within(double r) const;
    /// m, of the source of diffuse light.
    double depth() const { return depth_; }

private:
    /// A medium between two planes.
    struct Sheet {
        double diffusion;  ///< D, m
        double absorption; ///< 1/m
        double extinction; ///< reduced, 1/m
        double albedo;
        double thickness; ///< m; infinite: a half space
        double ior;
    };
    /// Where diffuse light would be 0 outside, in a medium that goes on so far; where that has no diffusion,
    /// phi = 2 A flux at the boundary itself.
    struct Ending {
        double twoA, diffusion, absorption;
    };
    /// What phi becomes on the other side of an interface: ratio phi + drop flux.
    struct Passage {
        double ratio = 1, drop = 0;
    };
    /// Sheets from one boundary to the source, and what lies at that boundary.
    struct Way {
        std::vector<Sheet> sheets;
        std::vector<Passage> passages; ///< behind each sheet but the last
        Ending ending;
        bool isEndless = false; ///< a half space, which has no boundary
    };
    struct Wave;

    void placeSource(std::vector<Sheet> sheets);
    static Ending endingOf(const std::vector<Sheet>& sheets);
    static Way wayOf(std::vector<Sheet> sheets, const Ending& ending);
    static Wave follow(const Way& way, std::complex<double> square);
    std::complex<double> leaving(std::complex<double> square) const;
    bool tabulate();

    Way near_, far_; ///< from the side on which light leaves, and from the other
    double strength_ = 0, depth_ = 0, slowest_ = 0, total_ = 0;
    int first_ = 0; ///< number of the first distance, of which each is e^step times the one before
    std::vector<double> values_, shares_; ///< logarithms
};

} // namespace lucent::diffusion
