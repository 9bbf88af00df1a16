#pragma once
/// What surfaces that are not matt send to one direction (scene::Glossy and the classical models), in double
/// precision and written by angles, not as the shaders have it.

#include "base/Math.h"
#include "scene/Scene.h"
#include "truth/Facets.h"

namespace lucent::truth {

/// A BRDF at a place, seen from one side.
///
/// Sources: glTF 2.0, appendix B (GGX of Walter et al. 2007 with Smith's shadowing for both directions
/// together, Fresnel by Schlick 1994); Phong, Blinn, Cook, Torrance 1982 as the image-space dissertation
/// (2007, eq. 2.27 to 2.33) prints them, or normalised; Oren, Nayar 1994, qualitative model.
class Gloss {
public:
    /// Which part of the light. A surface whose roughness is below kSmooth mirrors no light samples, whose
    /// points are of no size: of All it is Matt; Mirrored alone takes it as one of that roughness.
    enum class Part { All, Matt, Mirrored };
    static constexpr double kSmooth = 0.001;

    /// @param material  isGlossy()
    /// @param normal    unit
    /// @param viewer    unit
    Gloss(const scene::Material& material, const dvec3& normal, const dvec3& viewer, Part part = Part::All);

    /// Share of the light from a direction that goes to the viewer, times the cosine there, 1/sr of each
    /// colour; 0 below the surface.
    dvec3 share(const dvec3& toLight) const;
    /// How densely choose() chooses a direction, 1/sr.
    double density(const dvec3& toLight) const;
    /// A direction, more often where much light of the part comes from; may lie below the surface.
    ///
    /// @param chance  [0,1) each
    dvec3 choose(dvec2 chance) const;

private:
    struct Angles;
    double roughnessFor(float roughness) const;
    dvec3 measuredShare(const scene::MeasuredBrdf& measured, const dvec3& toLight) const;
    dvec3 mattShare(const Angles& angles) const;
    dvec3 mirroredShare(const Angles& angles) const;

    const scene::Material& material_;
    dvec3 normal_, viewer_;
    Part part_;
    Facets facets_;   ///< of about the same spread, by which directions are chosen
    double ofFacets_; ///< share of the choices that they make; the others are as a matt surface has them
};

/// Whether a surface shows the objects around in what it mirrors: rougher ones than
/// scene::kMostMirroringRoughness show only the light, in whose way objects stand.
bool showsObjects(const scene::Material& material);

} // namespace lucent::truth
