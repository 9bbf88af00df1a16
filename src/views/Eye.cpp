#include "views/Eye.h"

#include "views/FieldTextures.h"

#include <algorithm>

namespace lucent::views {

vec4 Eye::inObject(const mat4& worldFromObject) const {
    const mat4 objectFromWorld = glm::inverse(worldFromObject);
    if (perspective) return vec4(vec3(objectFromWorld * vec4(position, 1)), 1);
    return vec4(glm::normalize(vec3(objectFromWorld * vec4(forward, 0))), 0);
}

Bounds boundsOf(const scene::Object& object) {
    const scene::HeightField& field = object.field();
    const HeightRange range = heightRange(*field.heights);
    const vec2 half = 0.5f * field.footprint();
    const mat4 worldFromObject = object.transform.worldFromObject();
    Bounds bounds;
    for (int corner = 0; corner < 8; ++corner) {
        const float z = (corner & 4 ? range.highest : std::min(range.lowest, 0.0f)) * field.heightScale;
        const vec3 point(corner & 1 ? half.x : -half.x, corner & 2 ? half.y : -half.y, z);
        bounds.add(vec3(worldFromObject * vec4(point, 1)));
    }
    return bounds;
}

Eye makeEye(const scene::Scene& scene, float aspect) {
    const scene::Camera& camera = scene.camera;
    Eye eye;
    eye.position = camera.eye;
    eye.forward = glm::normalize(camera.target - camera.eye);
    eye.perspective = camera.type == scene::Camera::Type::Perspective;
    vec3 up = camera.up;
    if (glm::length(glm::cross(eye.forward, up)) < 1e-6f) // looking along up: any other direction will do
        up = std::abs(eye.forward.z) < 0.9f ? vec3(0, 0, 1) : vec3(0, 1, 0);
    const mat4 viewFromWorld = glm::lookAt(camera.eye, camera.eye + eye.forward, up);

    float nearest = 1e30f, farthest = -1e30f;
    for (const scene::Object& object : scene.objects) {
        const Bounds bounds = boundsOf(object);
        const float middle = glm::dot(bounds.center() - camera.eye, eye.forward);
        const float margin = 1.01f * bounds.radius() + 1e-4f;
        nearest = std::min(nearest, middle - margin);
        farthest = std::max(farthest, middle + margin);
    }
    const float half = 0.5f * camera.height;
    if (eye.perspective) {
        farthest = std::max(farthest, 1e-3f);
        nearest = std::max(nearest, 1e-3f * farthest);
        eye.clipFromWorld =
            glm::perspective(glm::radians(camera.fov), aspect, nearest, farthest) * viewFromWorld;
    } else {
        eye.clipFromWorld =
            glm::ortho(-half * aspect, half * aspect, -half, half, nearest, farthest) * viewFromWorld;
    }
    return eye;
}

} // namespace lucent::views
