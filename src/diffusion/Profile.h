#pragma once
/// How light that enters a scattering medium at one place leaves it around there: profiles of diffusion
/// theory over a plane, per colour, and the tables of them that shaders read.
///
/// Light that is scattered once only, or not at all, is no part of any of them: the dipole stands for light
/// that has forgotten where it came from (the dissertation leaves single scattering out as well).

#include "scene/Scene.h"

#include <array>
#include <memory>
#include <vector>

namespace lucent::diffusion {

class Stack;

/// A layer of another medium.
struct Slab {
    double scattering = 0, absorption = 0; ///< as Medium's, 1/m
    double ior = 1.5;                      ///< over that of the outside
    double thickness = 0;                  ///< m; 0: not there
    bool operator==(const Slab&) const = default;
};

/// One colour of light in a medium; 1/m.
struct Medium {
    double scattering = 0; ///< reduced: sigma_s' = (1 - g) sigma_s
    double absorption = 0; ///< sigma_a
    double ior = 1.5;      ///< of the inside over that of the outside, as diffuseReflectance() has it
    /// What lies on it, the top first: of account in profiles of Shape::Multipole only, see Stack.
    std::vector<Slab> above = {};
    double extinction() const { return scattering + absorption; } ///< sigma_t'
    /// alpha', of one collision; 0 where nothing collides.
    double albedo() const;
    /// Effective transport coefficient sqrt(3 sigma_a sigma_t').
    double transport() const;
    /// Whether something lies on it.
    bool isLayered() const;
    bool operator==(const Medium&) const = default;
};

/// The medium inside an object of this material, red, green and blue, and its layers.
std::array<Medium, 3> mediaOf(const scene::Material& material);

/// The share that diffuse light inside loses to reflection at the boundary, on average (Egan and Hilgeman's
/// fit).
///
/// @param ior  [0.3, 3] (scene::kLeastScatteringIor and kMostScatteringIor), where the fit stays in (0, 1)
double diffuseReflectance(double ior);

/// Share of unpolarised light that a smooth boundary lets through (Fresnel's equations).
///
/// @param cosine  of the angle outside, [0,1]
/// @param ior     as diffuseReflectance(), > 0
double transmittedShare(double cosine, double ior);

/// Share of light from all around outside that a smooth boundary lets through: 2 integral of F_t(c) c dc over
/// the cosine c, with Fresnel's equations. What leaves with radiosity B is seen as B F_t(c) / (pi times
/// this).
///
/// @param ior  as diffuseReflectance(), > 0
double meanTransmittance(double ior);

/// The same of a flux that changes with the cosine: 3 integral of F_t(c) c² dc.
double fluxTransmittance(double ior);

/// A source of diffuse light below (depth > 0) or above the place where light enters.
struct Pole {
    double depth = 0;  ///< m
    double weight = 0; ///< m: what shaders multiply the kernel by; the depth with its sign for a dipole
};

/// Two for a half space, or as many as `epsilon` asks for in a slab (multipole; Donner and Jensen 2005). The
/// last two poles of a slab stand for all that would follow: the rest of the series is the integral of a
/// derivative, so that no integral over a plane is cut off.
///
/// In slabs the source stands at the mean depth of the first collision inside, with the share of light that
/// collides there; the paper puts all of it at one mean free path, which lies outside of thinner slabs. A
/// slab of infinite thickness is a half space.
///
/// On curved surfaces (`dipoleGeometry` offset) a pole lies at x_i - depth * n_i and its distance d to x_o
/// counts as no less than |depth|, as on a plane: otherwise thin sheets, whose other side may touch the pole,
/// would have no finite answer.
///
/// @param medium     which scatters or absorbs; layers on it have no poles and are not there
/// @param thickness  m; 0 or infinite: a half space
/// @param epsilon    error over the profile's largest value, (0,1)
std::vector<Pole> polesOf(const Medium& medium, double thickness, double epsilon);

/// What a pole leaves at distance d from itself per unit of its weight, 1/m³:
/// alpha' / (4 pi) (1 + sigma_tr d) e^(-sigma_tr d) / d³.
double kernel(const Medium& medium, double d);

/// Dipole and multipole as polesOf() has them; of a multipole with thickness 0 a dipole remains. A multipole
/// with layers on the medium is Stack's; `thickness` is that of the medium below them. Burley:
/// normalised diffusion for a beam from above (Christensen and Burley 2015, s = 1.85 - A + 7 |A - 0.8|³, with
/// 1 / sigma_t' as the mean free path), whose A is the dipole's totalReflectance(), so that both hold the
/// same light and only its spread differs; it knows no thickness.
enum class Shape : int { Dipole, Multipole, Burley };

/// R_d of one colour, to be asked many times: layers are solved once.
class Profile {
public:
    Profile(const Medium& medium, Shape shape, double thickness);

    /// R_d(r) on a plane: radiant exitance at distance r over the flux that entered at a point, 1/m².
    ///
    /// @param r  m, >= 0; Burley's profile is infinite at 0
    double at(double r) const;
    /// Its integral over the plane in closed form: the share that leaves again.
    double total() const { return total_; }
    /// Its integral over a disc of radius r around the place where light enters, in closed form.
    double within(double r) const;
    /// m, of the source of diffuse light that is nearest to the surface: profiles have no detail much finer.
    /// 0 where nothing collides.
    double depth() const { return depth_; }
    /// The distance within which all but `epsilon` of the integral lies (dissertation 2007, eq. 6.16 with the
    /// 2 pi r that an area integral has), m; 0 where nothing scatters. Profiles that reach further (without
    /// absorption they fall as 1/r only in that integral) end at `most`.
    ///
    /// @param most  m, > 0: the object's own extent, beyond which nothing can receive light
    double reach(double epsilon, double most) const;

private:
    Medium medium_;
    double total_ = 0, depth_ = 0;
    double burley_ = 0; // s over the mean free path, 1/m; 0: another shape
    std::vector<Pole> poles_;
    std::shared_ptr<const Stack> stack_; // of layers
};

/// Profile::at(), total() and within() of a profile that is asked once.
double reflectance(const Medium& medium, Shape shape, double thickness, double r);
double totalReflectance(const Medium& medium, Shape shape, double thickness);
double reflectanceWithin(const Medium& medium, Shape shape, double thickness, double r);

/// What leaves a slab, and what lies on it, at the other side, 1/m². 0 for a half space.
double transmittance(const Medium& medium, double thickness, double r);
/// Its integral over the plane in closed form. With totalReflectance() and what is absorbed it adds up to the
/// share that collides in the slab; the rest passes straight and is no part of the profiles.
double totalTransmittance(const Medium& medium, double thickness);

/// The profiles of the three colours.
std::array<Profile, 3> profilesOf(const std::array<Medium, 3>& media, Shape shape, double thickness);

/// A profile over r in [0, reach], sampled where it bends most and linear between.
struct Table {
    double reach = 0;         ///< m; 0 beyond
    std::vector<vec3> values; ///< at r = reach (i / (n - 1))², 1/m²: dense near 0, where profiles are steep.
                              ///< Linear between in i, that is in sqrt(r). Finite at r = 0 for Burley too:
                              ///< its first value keeps the integral
    double error = 0; ///< of interpolation, reached; above the one asked for where kMostEntries are few
};
inline constexpr int kMostEntries = 2048; ///< WebGL2 promises textures of this width

/// R_d of the three colours. Its integral, as shaders interpolate it, is the closed form to float precision.
///
/// @param reach  m, of the slowest colour
/// @param error  bound on the interpolation's error, > 0: over the profile's value, or over a thousandth of
///               its mean in the reach where that is larger; of no account in the innermost disc that holds
///               less than this share of the light. The table is as long as it needs, kMostEntries at most
/// @param whole  each colour keeps its full integral although it is cut at `reach`. False where the reach is
///               the object's own extent (reach() gave `most`): nothing lies beyond, so nothing is cut
Table tableOf(const std::array<Profile, 3>& profiles, double reach, double error, bool whole = true);

/// R_d of a table at r, as shaders read it.
vec3 valueAt(const Table& table, double r);

} // namespace lucent::diffusion
