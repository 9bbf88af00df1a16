#pragma once
/// A scene as light meets it: every object's surface in the world at the time that the view shows, and the
/// media between the surfaces.

#include "base/Math.h"
#include "base/Result.h"
#include "scene/Scene.h"
#include "truth/RayScene.h"

#include <optional>
#include <vector>

namespace lucent::truth {

/// Refractive objects that a place lies in. Its medium is that of the last one in the scene's list.
class Media {
public:
    static constexpr int kVacuum = -1;

    int medium() const { return inside_.empty() ? kVacuum : inside_.back(); }
    /// Entering what one is in, or leaving what one is not in, changes nothing.
    void enter(int object);
    void leave(int object);

private:
    std::vector<int> inside_; ///< ascending
};

/// The objects of a scene in world space; an object's number is that of its shape.
///
/// Spheres and tori are exact, water is the formula of its sine as it begins and a Basin afterwards, reliefs
/// are exact blocks, all else is triangles. Meshes are morphed, skinned (glTF 2.0, 3.7.3) and waved
/// here in double precision, normals by the inverse transpose of each motion's derivative; what a wave bends
/// are the vertices of scene::meshOf(), flat sides in kWavedCells squares along each edge.
///
/// Water begins as the travelling sine a e^(-damping t / 2) sin(k x - w t) at t = 0, a its amplitude, k = 2
/// pi / wavelength, w² = (speed k)² - damping² / 4 (nothing travels where that is negative).
class Optics {
public:
    static constexpr int kWavedCells = 128;

    /// @param scene  must outlive this
    /// @return       Error when Embree cannot hold the scene
    static Result<Optics> create(const scene::Scene& scene);

    const RayScene& rays() const { return rays_; }
    const scene::Object& object(int number) const { return scene_->objects[std::size_t(number)]; }
    bool isOpaque(int number) const;
    /// Objects that bend or mirror light.
    const std::vector<int>& optical() const { return optical_; }
    bool disperses() const { return disperses_; }
    /// Whether some refractive object has the index of vacuum: it bends and reflects nothing there.
    bool hasIndexOfOne() const { return hasIndexOfOne_; }
    /// Whether all of them have.
    bool bendsNothing() const { return bendsNothing_; }
    /// Whether straight light may pass some object: a refractive one of that index, or a blended one.
    bool letsPass() const { return hasIndexOfOne_ || hasBlended_; }

    /// Index of refraction of a medium for red, green or blue light.
    double ior(int medium, int channel) const;
    /// Absorption coefficient of a medium, 1/m.
    dvec3 absorption(int medium) const;

    /// What a place lies in: balls and tori by their equations, water by what is above, meshes where they
    /// turn around the place by more than half a sphere (their solid angle, so that a hole does not decide);
    /// outside of their boxes none does.
    ///
    /// @param hitsHidden  objects that the eye does not see count as well
    Media mediaAt(const dvec3& place, bool hitsHidden) const;

private:
    Optics(const scene::Scene& scene, RayScene rays);

    const scene::Scene* scene_;
    RayScene rays_;
    std::vector<int> optical_;
    std::vector<Box> boxes_; ///< of these; endless around what is no mesh
    bool disperses_ = false, hasIndexOfOne_ = false, hasBlended_ = false, bendsNothing_ = true;
};

/// Index of refraction at the Fraunhofer lines C (656.3 nm, for red), d (587.6 nm) and F (486.1 nm): Cauchy's
/// n = A + B / wavelength² through `ior` at d with the Abbe number 20 / dispersion = (n_d - 1) / (n_F - n_C),
/// as KHR_materials_dispersion has it.
///
/// @param channel  0, 1, 2: red, green, blue
double iorOf(const scene::Clear& material, int channel);

/// The surface of an object in world space at a time [s]; the object is no height field.
Shape surfaceOf(const scene::Object& object, double time);

} // namespace lucent::truth
