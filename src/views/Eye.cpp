#include "views/Eye.h"

#include "scene/Displacement.h"
#include "views/FieldTextures.h"
#include "views/Meshes.h"
#include "views/Water.h"

#include <algorithm>
#include <cmath>

namespace lucent::views {

vec4 Eye::inObject(const mat4& worldFromObject) const {
    const mat4 objectFromWorld = glm::inverse(worldFromObject);
    if (perspective) return vec4(vec3(objectFromWorld * vec4(position, 1)), 1);
    return vec4(glm::normalize(vec3(objectFromWorld * vec4(forward, 0))), 0);
}

namespace {

Bounds fieldBounds(const scene::HeightField& field, const Kept& kept) {
    const auto range = kept.of<HeightRange>(field.heights, [&] { return heightRange(*field.heights); });
    const vec2 half = 0.5f * field.footprint();
    Bounds bounds;
    bounds.add({-half, std::min(range.lowest, 0.0f) * field.heightScale});
    bounds.add({half, range.highest * field.heightScale});
    return bounds;
}

Bounds waterBounds(const scene::Water& water) {
    Bounds bounds;
    const float reach = waterReach(water);
    bounds.add({-0.5f * water.size.x, -reach, -0.5f * water.size.y});
    bounds.add({0.5f * water.size.x, reach, 0.5f * water.size.y});
    return bounds;
}

Bounds displacedBounds(const scene::Object& object) {
    const auto base = scene::baseOf(object);
    const float reach = base->reach(*object.displacement);
    Bounds bounds;
    for (const scene::DisplacedTriangle& triangle : base->triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            bounds.add(triangle.places[i]);
            bounds.add(triangle.places[i] + reach * triangle.directions[i]);
        }
    return bounds;
}

Bounds localBounds(const scene::Object& object) {
    if (object.isField()) return fieldBounds(object.field(), object.kept);
    if (const auto* water = std::get_if<scene::Water>(&object.shape)) return waterBounds(*water);
    if (object.isDisplaced())
        return object.kept.of<Bounds>(std::pair(scene::baseOf(object), object.displacement->scale),
                                      [&] { return displacedBounds(object); });
    const std::shared_ptr<const scene::Mesh> mesh = meshOf(object);
    Bounds bounds = object.kept.of<Bounds>(mesh, [&] { return meshBounds(*mesh); });
    bounds.low -= glm::abs(object.wave.amplitude);
    bounds.high += glm::abs(object.wave.amplitude);
    return bounds;
}

} // namespace

Bounds boundsOf(const scene::Object& object) {
    const Bounds local = localBounds(object);
    const mat4 worldFromObject = object.transform.worldFromObject();
    Bounds bounds;
    for (int corner = 0; corner < 8; ++corner) {
        const vec3 point(corner & 1 ? local.high.x : local.low.x, corner & 2 ? local.high.y : local.low.y,
                         corner & 4 ? local.high.z : local.low.z);
        bounds.add(vec3(worldFromObject * vec4(point, 1)));
    }
    return bounds;
}

ViewBlock viewBlock(const Eye& eye, ivec2 size) {
    const vec2 pixel = 2.0f * eye.halfExtent / vec2(size);
    return {.eye = vec4(eye.position, eye.perspective ? 1 : 0),
            .forward = vec4(eye.forward, eye.farthest),
            .right = vec4(pixel.x * eye.right, eye.nearest),
            .up = vec4(pixel.y * eye.up, 0),
            .size = vec2(size),
            .middle = 0.5f * vec2(size) * (1.0f - eye.shift),
            .cut = eye.cut + vec4(0, 0, 0, glm::dot(vec3(eye.cut), eye.position))};
}

Eye makeEye(const scene::Scene& scene, float aspect, float nearestPart, vec2 shift) {
    const scene::Camera& camera = scene.camera;
    Eye eye;
    eye.position = camera.eye;
    eye.forward = glm::normalize(camera.target - camera.eye);
    eye.perspective = camera.type == scene::Camera::Type::Perspective;
    vec3 up = camera.up;
    if (glm::length(glm::cross(eye.forward, up)) < 1e-6f) // looking along up: any other direction will do
        up = std::abs(eye.forward.z) < 0.9f ? vec3(0, 0, 1) : vec3(0, 1, 0);
    const mat4 viewFromWorld = glm::lookAt(camera.eye, camera.eye + eye.forward, up);
    eye.right = glm::normalize(glm::cross(eye.forward, up));
    eye.up = glm::cross(eye.right, eye.forward);

    float nearest = 1e30f, farthest = -1e30f;
    for (const scene::Object& object : scene.objects) {
        const Bounds bounds = boundsOf(object);
        const float middle = glm::dot(bounds.center() - camera.eye, eye.forward);
        const float margin = 1.01f * bounds.radius() + 1e-4f;
        nearest = std::min(nearest, middle - margin);
        farthest = std::max(farthest, middle + margin);
    }
    const float half = eye.perspective ? std::tan(glm::radians(camera.fov) / 2) : 0.5f * camera.height;
    eye.halfExtent = {half * aspect, half};
    if (eye.perspective) {
        farthest = std::max(farthest, 1e-3f);
        nearest = std::max(nearest, nearestPart * farthest);
        eye.clipFromWorld =
            glm::perspective(glm::radians(camera.fov), aspect, nearest, farthest) * viewFromWorld;
    } else {
        eye.clipFromWorld =
            glm::ortho(-half * aspect, half * aspect, -half, half, nearest, farthest) * viewFromWorld;
    }
    eye.clipFromWorld = glm::translate(mat4(1), vec3(-shift, 0)) * eye.clipFromWorld;
    eye.shift = shift;
    eye.nearest = nearest;
    eye.farthest = farthest;
    return eye;
}

} // namespace lucent::views
