#pragma once
/// What the camera sees of a scene: exact first hits of the height fields.

#include "base/Math.h"
#include "scene/Scene.h"
#include "truth/Field.h"

#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace lucent::truth {

/// Where an object's space lies in the world: scaled, turned, moved.
struct Placement {
    glm::dmat3 objectFromWorld{1}; ///< rotation only
    dvec3 translate{0};
    double scale = 1;

    Placement() = default;
    explicit Placement(const scene::Transform& transform);
    dvec3 pointFromWorld(const dvec3& point) const { return objectFromWorld * (point - translate) / scale; }
    dvec3 pointInWorld(const dvec3& point) const { return scale * directionInWorld(point) + translate; }
    dvec3 directionFromWorld(const dvec3& direction) const { return objectFromWorld * direction; }
    dvec3 directionInWorld(const dvec3& direction) const { return direction * objectFromWorld; } // transposed
};

/// An object of the scene with its field.
struct PlacedField {
    const scene::Object* object;
    Field field;
    Placement placement;
};

/// All height fields of a scene, those hidden from the camera too.
std::vector<PlacedField> placeAll(const scene::Scene& scene);

/// First point at which a ray meets what is drawn of a field: the surface and the side walls down to
/// Field::bottom(). Nothing when the ray starts inside or comes from below: the field is open there.
std::optional<SurfacePoint> firstHit(const Field& field, const Ray& ray, Stretch stretch);

/// What the middle of a pixel shows.
struct Sight {
    const PlacedField* object = nullptr; ///< null: nothing
    SurfacePoint point{};                ///< in the object's space
    double distance =
        std::numeric_limits<double>::infinity(); ///< m in the world, from where the ray is measured
    double coverage = 0;                         ///< [0,1], alpha at the point
};

/// The eye of a scene.
class Eye {
public:
    Eye(const scene::Camera& camera, ivec2 size);

    /// A pixel's middle as a ray in world space. Orthographic ones come from infinity.
    Ray ray(ivec2 pixel) const { return ray(dvec2(pixel) + 0.5); }
    /// The same of any place, in pixels from the picture's first corner.
    Ray ray(dvec2 place) const;
    bool isPerspective() const { return perspective_; }

    /// Where on the picture a point of the world is seen, in pixels; nothing beside it or behind the eye.
    std::optional<dvec2> placeOf(const dvec3& point) const;
    /// Unit direction from a point to the eye.
    dvec3 directionFrom(const dvec3& point) const;
    /// m to the eye; infinite for an orthographic one.
    double distanceFrom(const dvec3& point) const;
    /// Width of what one pixel shows in the middle of the picture, m.
    ///
    /// @param away  m from the eye
    double pixelWidth(double away) const { return 2 * extent_.x / size_.x * (perspective_ ? away : 1); }
    /// What one pixel shows of a surface, m²: the derivative of area by pixels at the point, so that light
    /// per pixel over this is light per area however large the pixel.
    double areaOfPixel(const dvec3& point, const dvec3& normal) const;
    /// The nearest visible object that is not looked through: a place whose alpha is 0 is.
    Sight look(const Ray& ray, std::span<const PlacedField> objects) const;
    /// Unit direction, in the object's space, from the eye to a place there.
    dvec3 directionTo(const dvec3& place, const Ray& ray, const Placement& placement) const;

private:
    ivec2 size_;
    dvec3 origin_, forward_, right_, up_;
    dvec2 extent_; ///< half width and height of the picture: metres, or per metre of distance
    bool perspective_;
};

} // namespace lucent::truth
