#include "truth/Sight.h"

#include "truth/ColorMap.h"
#include "truth/Lights.h"
#include "truth/Relief.h"

#include <cmath>

namespace lucent::truth {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();
} // namespace

Placement::Placement(const scene::Transform& transform)
    : objectFromWorld(glm::transpose(rotation(transform.rotate))), translate(transform.translate),
      scale(double(transform.scale)) {}

std::vector<PlacedField> placeAll(const scene::Scene& scene) {
    std::vector<PlacedField> placed;
    for (const scene::Object& object : scene.objects)
        if (object.isField()) placed.push_back({&object, Field(object.field()), Placement(object.transform)});
    return placed;
}

std::optional<SurfacePoint> firstHit(const Field& field, const Ray& ray, Stretch stretch) {
    const double hit = firstInside(field, ray, stretch);
    const dvec3 place = ray.anchor + ray.offset + hit * ray.direction;
    if (hit == kInfinity || hit == stretch.from) return {};
    if (hit > field.overFootprint(ray, stretch).from) return field.pointAbove(dvec2(place));
    if (place.z < field.bottom()) return {};

    const dvec2 gap = field.half() - glm::abs(dvec2(place));
    const int axis = gap.x < gap.y ? 0 : 1;
    SurfacePoint wall{place, dvec3(0)};
    wall.normal[axis] = place[axis] > 0 ? 1 : -1;
    wall.position[axis] = wall.normal[axis] * field.half()[axis];
    return wall;
}

Eye::Eye(const scene::Camera& camera, ivec2 size)
    : size_(size), origin_(camera.eye), forward_(glm::normalize(dvec3(camera.target) - dvec3(camera.eye))),
      right_(glm::normalize(glm::cross(forward_, dvec3(camera.up)))), up_(glm::cross(right_, forward_)),
      perspective_(camera.type == scene::Camera::Type::Perspective) {
    const double half =
        perspective_ ? std::tan(double(camera.fov) * std::numbers::pi / 360) : double(camera.height) / 2;
    extent_ = half * dvec2(double(size.x) / size.y, 1);
}

Ray Eye::ray(dvec2 place) const {
    const dvec2 at = 2.0 * place / dvec2(size_) - 1.0; // y down
    const dvec3 aside = at.x * extent_.x * right_ - at.y * extent_.y * up_;
    if (perspective_) return {origin_, dvec3(0), glm::normalize(forward_ + aside)};
    return {origin_, aside, forward_};
}

std::optional<dvec2> Eye::placeOf(const dvec3& point) const {
    const dvec3 out = point - origin_;
    const double away = perspective_ ? glm::dot(out, forward_) : 1;
    if (!(away > 0)) return {};
    const dvec2 at = dvec2(glm::dot(out, right_), -glm::dot(out, up_)) / (away * extent_);
    const dvec2 place = 0.5 * (at + 1.0) * dvec2(size_);
    if (!(place.x >= 0 && place.y >= 0 && place.x < size_.x && place.y < size_.y)) return {};
    return place;
}

dvec3 Eye::directionFrom(const dvec3& point) const {
    return perspective_ ? glm::normalize(origin_ - point) : -forward_;
}

double Eye::distanceFrom(const dvec3& point) const {
    return perspective_ ? glm::distance(origin_, point) : kInfinity;
}

double Eye::areaOfPixel(const dvec3& point, const dvec3& normal) const {
    // On the picture's plane, 1 m away where that makes a difference.
    const double area = 4 * extent_.x * extent_.y / (double(size_.x) * double(size_.y));
    const double slant = std::abs(glm::dot(normal, directionFrom(point)));
    if (!perspective_) return area / slant;
    // The pixel's solid angle is area cos³; on a surface it covers distance² / slant of that.
    const double distance = distanceFrom(point), away = glm::dot(point - origin_, forward_);
    return area * away * away * away / (distance * slant);
}

Sight Eye::look(const Ray& ray, std::span<const PlacedField> objects) const {
    Sight nearest;
    for (const PlacedField& placed : objects) {
        if (!placed.object->visible) continue;
        // Measured from the place on the ray that is nearest to the object's origin, where digits are
        // densest.
        const dvec3 direction = placed.placement.directionFromWorld(ray.direction);
        const dvec3 origin = placed.placement.pointFromWorld(ray.anchor + ray.offset);
        const double foot = -glm::dot(origin, direction);
        const Ray local{dvec3(0), origin + foot * direction, direction};
        const auto hit = firstHit(placed.field, local, {perspective_ ? -foot : -kInfinity, kInfinity});
        if (!hit) continue;
        const Image* alpha = placed.object->field().alpha.get();
        const double coverage = sampleMap(alpha, placed.field.placeOnMap(hit->position)).x;
        const double distance = glm::dot(hit->position - origin, direction) * placed.placement.scale;
        if (coverage > 0 && distance < nearest.distance) nearest = {&placed, *hit, distance, coverage};
    }
    return nearest;
}

dvec3 Eye::directionTo(const dvec3& place, const Ray& ray, const Placement& placement) const {
    if (!perspective_) return placement.directionFromWorld(ray.direction);
    return glm::normalize(place - placement.pointFromWorld(ray.anchor));
}

} // namespace lucent::truth
