#pragma once
/// Rough boundaries: small mirror facets of a medium's surface.

#include "base/Math.h"

namespace lucent::truth {

/// What a rough boundary mirrors towards one direction: facets spread by GGX, those hidden from light or eye
/// left out each on its own (Walter et al. 2007), with unpolarised Fresnel. Light that facets send each other
/// is left out.
class Facets {
public:
    /// @param normal     unit, on the side of the viewer
    /// @param viewer     unit, dot(normal, viewer) > 0
    /// @param roughness  [0,1], the root of GGX's alpha; below 0.001 smooth
    /// @param ior        of the medium below, > 0
    Facets(const dvec3& normal, const dvec3& viewer, double roughness, double ior);

    bool isSmooth() const;
    /// Share of the light from a direction on the surface that goes to the viewer, times the cosine there,
    /// 1/sr; 0 below the surface.
    double share(const dvec3& toLight) const;
    /// How densely choose() chooses a direction, 1/sr.
    double density(const dvec3& toLight) const;
    /// A direction by a facet as often as the viewer sees it (Heitz 2018); may lie below the surface.
    ///
    /// @param chance  [0,1) each
    dvec3 choose(dvec2 chance) const;

private:
    double spreadOf(const dvec3& facet) const;
    double unhidden(double cosine) const;

    dvec3 normal_, viewer_;
    double alpha_, ior_;
};

} // namespace lucent::truth
