#pragma once
/// Light scattered inside objects, by diffusion theory: the model that subsurface splatting draws, without
/// its splats.

#include "base/Result.h"
#include "scene/Scene.h"
#include "truth/Estimate.h"
#include "truth/Lamps.h"
#include "truth/Picture.h"
#include "truth/Translucent.h"

#include <cstdint>
#include <memory>
#include <optional>

namespace lucent::truth {

/// What light that enters at a point leaves around it.
enum class Diffusion {
    Dipole,    ///< of a half space
    Multipole, ///< of a layer as thick as material.thickness
    Burley,    ///< normalised diffusion (Christensen, Burley 2015), with the dipole's light
};

/// From where distances count on curved surfaces.
enum class DipoleGeometry {
    Planar, ///< from the place where light enters, as if its surroundings were flat (dissertation 2007)
    Offset, ///< from sources moved along the normal there (2002 paper), but never less than so far
};

struct DipoleOptions {
    scene::Aov aov = scene::Aov::Color; ///< or Radiosity
    Diffusion profile = Diffusion::Dipole;
    DipoleGeometry geometry = DipoleGeometry::Planar;
    bool normalisedExit = true; ///< false: L = B F_t(w) / pi, as the papers have it, which loses light
    int samples = 256;          ///< lines on which light may enter, of each pixel; kFewest at least
    int rays = 400'000;         ///< of light that enters by way of glass, water and mirrors; 0: none does
    std::uint64_t seed = 0;

    static constexpr int kFewest = 48;
};

/// The integral over an object's surface of R_d times the light that enters, without anything precomputed:
///
/// B(x_o) = integral of R_d(x_i, x_o) E(x_i) dA(x_i), and L = B F_t(w) / (pi mean F_t).
///
/// E is what lamps and environment send to x_i past everything that stands in their way, the object itself
/// and refractive objects included, and caustics (LampRays), times the share that a smooth boundary lets
/// through. R_d is
///
/// - Dipole: alpha' / (4 pi) sum of z (sigma_tr + 1/d) e^(-sigma_tr d) / d² over the depths z_r = 1 /
/// sigma_t' and
///   z_v = z_r + 4 A D (Jensen et al. 2001), D = 1 / (3 sigma_t'), A = (1 + F_dr) / (1 - F_dr) with Egan and
///   Hilgeman's fit of F_dr;
/// - Multipole: the images of these at both boundaries of a layer (Donner, Jensen 2005), 20 each way and the
///   rest as an integral; the source stands at the mean depth of the first collision in the layer, with the
///   share of light that collides there;
///   With layers on the medium (material.layers) it is LayeredResponse's, by the distance alone whatever the
///   geometry; dipole and Burley know no layers.
/// - Burley: s = 1.85 - A + 7 |A - 0.8|³ with A the dipole's share of light that leaves a half space.
///
/// On painted bodies (scene::Painting) light that enters counts t M_i times and spreads by M_d² R_d(M_d r),
/// all by the paint where it enters; where it is seen, t times the paint on what leaves is a factor, and the
/// share 1 - t of the surface is matt.
///
/// Light that is scattered once only or not at all is in none of them: the papers leave it out. Nor is light
/// that objects send each other after scattering, nor that of caustics on all else. Where the surface is not
/// closed only its outside, where normals point, takes and gives light. The color has the highlights of the
/// surface (Facets).
///
/// Places are chosen by chance on lines through the object: two thirds of them along three axes around x_o,
/// at distances from it as R_d has them without absorption (King et al. 2013), the others anywhere along the
/// world's axes. What a place counts follows from how densely the lines of all six directions lie there, so
/// that its share is bounded. The lines of each direction are those of an even sequence that begins at a
/// place chosen by chance, eight times: the error is that of the mean of eight, and falls nearly as the
/// number of samples grows, not as its root, where light and surface are smooth.
class DipoleEstimator : public Estimator {
public:
    /// @param scene  must outlive this
    /// @return       Error for another AOV, when nothing scatters, or when Embree cannot hold the scene
    static Result<DipoleEstimator> create(const scene::Scene& scene, ivec2 size,
                                          const DipoleOptions& options);
    DipoleEstimator(DipoleEstimator&&) noexcept;
    ~DipoleEstimator() override;
    Pixel solve(ivec2 pixel) const override;

    const Bodies& bodies() const;
    /// B at a place of a body, W/m².
    ///
    /// @param number  of the random numbers: other ones tell another estimate
    Estimate radiosity(const Body& body, const Hit& hit, std::uint64_t number) const;

private:
    struct State;
    explicit DipoleEstimator(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

} // namespace lucent::truth
