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
        placed.push_back({&object, Field(object.field()), Placement(object.transform)});
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

Ray Eye::ray(ivec2 pixel) const {
    const dvec2 place = 2.0 * (dvec2(pixel) + 0.5) / dvec2(size_) - 1.0; // y down
    const dvec3 aside = place.x * extent_.x * right_ - place.y * extent_.y * up_;
    if (perspective_) return {origin_, dvec3(0), glm::normalize(forward_ + aside)};
    return {origin_, aside, forward_};
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
