#pragma once
/// The lamps and the environment of a scene in physical units: the light that they send to a place, and rays
/// that carry the lamps' light to what refracts or mirrors it.

#include "base/Math.h"
#include "scene/Scene.h"
#include "truth/Facets.h"
#include "truth/Lights.h"
#include "truth/Optics.h"
#include "truth/Random.h"
#include "truth/RayScene.h"
#include "truth/Relief.h"

#include <optional>
#include <span>
#include <vector>

namespace lucent::truth {

class Gloss;

/// Light from one point of a lamp to a place.
struct LampLight {
    LightPath way;    ///< from the place to the lamp
    dvec3 irradiance; ///< the whole lamp's, as this one point tells it, on a surface that faces it, W/m²
};

/// A ray of light, chosen by chance. The mean over many is the lamp's light.
struct Emission {
    dvec3 origin, direction; ///< m; unit
    double begin = 0;        ///< m along the ray; -infinity: from infinitely far away
    dvec3 flux{0};           ///< W
    bool fades = true; ///< false: `flux` is that at 1 m and grows with the squared distance to the first
                       ///< surface, as the irradiance of a light without falloff does not fade
};

/// A light of the scene.
///
/// Point lights shine evenly, I cos / d² (W/sr; without falloff the plain factor I cos); with a radius as the
/// mean over a disc that faces what is lit (for rays: the middle of what they are aimed at). Spots fade
/// between their angles by the square of (cos - cos outer) / max(0.001, cos inner - cos outer), clamped to
/// [0,1] (KHR_lights_punctual). Distant lights have an irradiance and, with an angle, an even disc of
/// directions; areas an even radiance on one side.
class Lamp {
public:
    explicit Lamp(const scene::Light& light);

    /// Whether it has a size: one point of it does not tell all.
    bool isSampled() const { return panel_ || source_.radius > 0; }
    /// @param within  [0,1) each: which point of the lamp
    LampLight light(const dvec3& place, dvec2 within) const;
    /// A ray that starts at the lamp and is aimed at balls around what it may meet, each as often.
    Emission emit(std::span<const Sphere> targets, Random& random) const;
    /// Where it stands; nothing when it is infinitely far away.
    std::optional<dvec3> place() const;

private:
    /// The cone of a spot: light is clamp(cos scale + offset)².
    struct Cone {
        dvec3 axis;
        double scale, offset;
    };
    /// What a spot projects; the frame as in the scene.
    struct Picture {
        dvec3 right, up;
        std::shared_ptr<const Image> image;
    };
    struct Panel {
        dvec3 corner, edgeU, edgeV, normal;
        double area;
        dvec3 radiance;
    };
    dvec3 inCone(const dvec3& direction) const;
    Emission emitFrom(const dvec3& origin, std::span<const Sphere> targets, Random& random) const;

    LightSource source_; ///< of all but areas
    std::optional<Cone> cone_;
    std::optional<Picture> picture_;
    std::optional<Panel> panel_;
};

/// All lamps of a scene and its environment shining on opaque surfaces, past everything that stands in their
/// way, mirrors and refractive objects included: what those send on is light of caustics, which is followed
/// for lamps only. What bends nothing stands in no way (straightTransmittance()). What a medium around both
/// lamp and surface absorbs is not counted.
class Illumination {
public:
    /// @param attenuation  of light inside height fields
    Illumination(const scene::Scene& scene, const Optics& optics,
                 Attenuation attenuation = Attenuation::Ratio);

    const std::vector<Lamp>& lamps() const { return lamps_; }
    /// Whether irradiance() is left to chance.
    bool isSampled() const;
    /// Irradiance, W/m², by one point of each lamp that has a size and two directions of the environment.
    ///
    /// @param hit     of an opaque object
    /// @param viewer  unit direction to where it is seen from: that side of the surface is lit
    /// @param ior     only what a smooth boundary to a medium of this index lets through counts; 1: all
    dvec3 irradiance(const Hit& hit, const dvec3& viewer, Random& random, double ior = 1) const;
    /// Radiance of an opaque surface, W/(m² sr), by as many: of a height field by the thesis's model
    /// (truth/Relief.h), behind everything else that stands in the light's way; of a glossy one by its BRDF
    /// (Gloss.h), with what lies around in what it mirrors where showsObjects(); of all else base + diffuse E
    /// / pi.
    ///
    /// @param away  m to where it is seen from, along a straight way; infinite
    dvec3 radiance(const Hit& hit, const dvec3& viewer, double away, Random& random) const;
    /// Radiance that facets of the surface mirror to where they are seen from, W/(m² sr), by as many. Smooth
    /// ones mirror no lamp: where one that is a point meets the eye it would be infinitely bright.
    dvec3 mirrored(const Hit& hit, const Facets& facets, Random& random) const;

    /// Lamps, and the environment where it shines.
    std::size_t sources() const { return lamps_.size() + (around_ ? 1 : 0); }
    /// A ray from a lamp or, by the last number, from the environment, aimed as Lamp::emit() does.
    Emission emit(std::size_t source, std::span<const Sphere> targets, Random& random) const;

private:
    /// An environment, and directions of it that are chosen by its light.
    struct Around {
        Sky sky;
        EnvironmentSampler directions;
    };
    dvec3 passed(const Hit& hit, const LightPath& way) const;
    dvec3 radiance(const Hit& hit, const dvec3& viewer, double away, Random& random, bool around) const;
    dvec3 irradianceOf(const Hit& hit, const dvec3& viewer, Random& random, double ior) const;
    dvec3 ofMaterial(const scene::Material& material, const Hit& hit, const dvec3& viewer, Random& random,
                     bool around) const;
    dvec3 ofAround(const Hit& hit, const Gloss& lobe, Random& random) const;
    dvec3 ofRelief(const FieldBlock& block, const Hit& hit, const dvec3& viewer, double away,
                   Random& random) const;
    dvec3 ofLamps(const Hit& hit, const auto& lobe, Random& random) const;
    dvec3 ofSky(const Hit& hit, const auto& lobe, Random& random) const;

    const Optics* optics_;
    std::vector<Lamp> lamps_;
    std::optional<Around> around_;
    Attenuation attenuation_;
};

/// Radiance of an opaque surface that receives an irradiance as a matt one does; maps colour height fields.
/// Of glossy ones the matt part alone.
dvec3 shownBy(const Optics& optics, const Hit& hit, const dvec3& irradiance);

/// The normal of a surface on the side of a viewer: the smooth one, or where that faces away the geometric.
dvec3 normalTowards(const Hit& hit, const dvec3& viewer);

/// The beginning of a ray on which the surface that it leaves is not met. Of a field that is a texel's width:
/// the facets between texels are no part of the surface that they stand for.
Leaving leavingFrom(const Optics& optics, const Hit& hit, const dvec3& direction);

} // namespace lucent::truth
