#include "viewer/Interaction.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lucent::viewer {

namespace {

constexpr float kGrazing = 0.05f;      // onPlane(): cosine below which the hit runs away; chosen by eye
constexpr float kPole = kPi / 180;     // closest angle between sight line and up
constexpr float kLowestLight = 0.001f; // m, see liftedLight()
// Pixels from the border to an arrow; above it stand the page's own buttons.
constexpr float kArrowInset = 24, kArrowTop = 56;
constexpr float kWholeDot = 10; // from the border to the middle of a dot, so that none is cut
constexpr float kDisc =
    1 / kPi; // radius of distant lights' places, of the shorter side: dots follow turnedLight()

vec3 turned(vec3 vector, float angle, vec3 axis) {
    return vec3(glm::rotate(mat4(1), angle, axis) * vec4(vector, 0));
}

vec3 rightOf(const scene::Camera& camera) {
    return glm::normalize(glm::cross(camera.target - camera.eye, camera.up));
}

float wrapDegrees(float degrees) { return degrees - 360 * std::floor((degrees + 180) / 360); }

} // namespace

Lens::Lens(const scene::Camera& camera, vec2 size, vec2 corner)
    : perspective_(camera.type == scene::Camera::Type::Perspective), eye_(camera.eye),
      forward_(glm::normalize(camera.target - camera.eye)), right_(rightOf(camera)),
      up_(glm::cross(right_, forward_)), size_(size), corner_(corner) {
    const float height = perspective_ ? 2 * std::tan(glm::radians(camera.fov) / 2) : camera.height;
    spread_ = height / size.y;
}

std::optional<vec2> Lens::project(vec3 point) const {
    const vec3 offset = point - eye_;
    const float depth = glm::dot(offset, forward_);
    if (perspective_ && depth <= 0) return {};
    const vec2 metres(glm::dot(offset, right_), -glm::dot(offset, up_));
    return corner_ + size_ * 0.5f + metres / (perspective_ ? spread_ * depth : spread_);
}

Lens::Sight Lens::sight(vec2 pixel) const {
    const vec2 metres = (pixel - corner_ - size_ * 0.5f) * spread_;
    const vec3 aside = right_ * metres.x - up_ * metres.y;
    return {perspective_ ? eye_ : eye_ + aside, glm::normalize(perspective_ ? forward_ + aside : forward_)};
}

std::optional<vec3> Lens::onPlane(vec2 pixel, vec3 point, vec3 normal) const {
    const auto [origin, direction] = sight(pixel);
    const float slope = glm::dot(direction, normal);
    if (std::abs(slope) < kGrazing) return {};
    const float distance = glm::dot(point - origin, normal) / slope;
    if (perspective_ && distance <= 0) return {};
    return origin + distance * direction;
}

float Lens::metresPerPixel(vec3 point) const {
    return perspective_ ? spread_ * std::abs(glm::dot(point - eye_, forward_)) : spread_;
}

scene::Camera framed(scene::Camera camera, ivec2 sceneSize, vec2 viewSize) {
    const float wanted = float(sceneSize.x) / float(sceneSize.y);
    const float widening = std::max(1.0f, wanted * viewSize.y / viewSize.x);
    camera.height *= widening;
    camera.fov = glm::degrees(2 * std::atan(std::tan(glm::radians(camera.fov) / 2) * widening));
    return camera;
}

const vec3* placeOf(const scene::Light& light) {
    if (const auto* point = std::get_if<scene::PointLight>(&light)) return &point->position;
    if (const auto* spot = std::get_if<scene::SpotLight>(&light)) return &spot->position;
    if (const auto* area = std::get_if<scene::AreaLight>(&light)) return &area->corner;
    return nullptr;
}

vec3 colorOf(const scene::Light& light) {
    return std::visit([](const auto& kind) { return kind.color; }, light);
}

// Where a line from the middle of a box leaves it.
static vec2 borderOf(vec2 low, vec2 high, vec2 way) {
    const vec2 middle = (low + high) / 2.0f, half = glm::max(high - low, vec2(1)) / 2.0f;
    return middle + way / std::max(std::abs(way.x) / half.x, std::abs(way.y) / half.y);
}

LightHandle handleOf(const scene::Light& light, const Lens& lens, vec2 size) {
    const vec3* place = placeOf(light);
    if (!place) {
        const vec3 source = -glm::normalize(std::get<scene::DistantLight>(light).direction);
        return {size / 2.0f + lens.across(source) * kDisc * std::min(size.x, size.y), {}};
    }
    const std::optional<vec2> dot = lens.project(*place);
    const bool isSeen =
        dot && glm::all(glm::greaterThanEqual(*dot, vec2(0))) && glm::all(glm::lessThan(*dot, size));
    if (isSeen) return {glm::clamp(*dot, vec2(kWholeDot), glm::max(size - kWholeDot, vec2(kWholeDot))), {}};
    const vec2 low(kArrowInset, kArrowTop), high = size - kArrowInset;
    vec2 way = dot ? *dot - (low + high) / 2.0f : lens.across(*place - lens.eye());
    if (glm::length(way) < 1e-6f) way = {0, -1}; // straight behind the camera
    return {borderOf(low, high, way), glm::normalize(way)};
}

vec3 movedLight(const Lens& lens, vec3 position, vec3 normal, vec2 from, vec2 to) {
    if (!lens.project(position)) return position + lens.aside((to - from) * lens.metresPerPixel(position));
    const auto start = lens.onPlane(from, position, normal);
    const auto end = lens.onPlane(to, position, normal);
    return start && end ? position + *end - *start : position;
}

vec3 turnedLight(const scene::Camera& camera, vec3 direction, vec2 turns) {
    const vec3 right = rightOf(camera);
    const vec3 up = glm::normalize(glm::cross(right, camera.target - camera.eye));
    return turned(turned(direction, turns.x * kPi, up), turns.y * kPi, right);
}

vec3 turnedMap(vec3 rotation, vec2 turns, bool roll) {
    const vec2 degrees = turns * 180.0f;
    rotation += roll ? vec3(0, 0, -degrees.x) : vec3(degrees.y, degrees.x, 0);
    return {wrapDegrees(rotation.x), wrapDegrees(rotation.y), wrapDegrees(rotation.z)};
}

vec3 orbited(const scene::Camera& camera, vec2 turns) {
    const vec3 up = glm::normalize(camera.up);
    const vec3 arm = turned(camera.eye - camera.target, -turns.x * kPi, up);
    const float polar = std::acos(std::clamp(glm::dot(glm::normalize(arm), up), -1.0f, 1.0f));
    const float wanted = std::clamp(polar - turns.y * kPi, kPole, kPi - kPole);
    const vec3 side = glm::cross(up, arm);
    if (glm::length(side) < 1e-6f * glm::length(arm))
        return camera.eye; // looking along `up` there is no side
    return camera.target + turned(arm, wanted - polar, glm::normalize(side));
}

scene::Camera zoomed(scene::Camera camera, float factor) {
    if (camera.type == scene::Camera::Type::Orthographic)
        camera.height /= factor;
    else
        camera.eye = camera.target + (camera.eye - camera.target) / factor;
    return camera;
}

std::optional<WaterPlace> waterAt(const scene::Scene& scene, const Lens& lens, vec2 pixel) {
    std::optional<WaterPlace> found;
    float nearest = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const scene::Object& object = scene.objects[i];
        const auto* water = std::get_if<scene::Water>(&object.shape);
        if (!water || !object.visible) continue;
        const mat4 worldFromObject = object.transform.worldFromObject();
        const vec3 middle(worldFromObject[3]), up = glm::normalize(vec3(worldFromObject[1]));
        const auto place = lens.onPlane(pixel, middle, up);
        if (!place) continue;
        const vec3 local(glm::inverse(worldFromObject) * vec4(*place, 1));
        const float depth = glm::dot(*place - scene.camera.eye, lens.forward());
        if (std::abs(local.x) > water->size.x / 2 || std::abs(local.z) > water->size.y / 2) continue;
        if (depth >= nearest) continue;
        nearest = depth;
        found = WaterPlace{int(i), {local.x, local.z}};
    }
    return found;
}

float liftedLight(float z, float factor) {
    return std::copysign(std::max(std::abs(z), kLowestLight) * factor, z);
}

} // namespace lucent::viewer
