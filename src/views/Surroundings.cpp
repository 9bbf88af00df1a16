#include "views/Surroundings.h"

#include "views/Meshes.h"

#include <algorithm>

namespace lucent::views {

namespace {

constexpr std::string_view kAround[] = {"environment", "view", "surroundings"};

// A rectangle in its object's space.
struct Side {
    vec3 middle, normal, edgeU, edgeV; // half edges
};

std::vector<Side> sidesOf(const scene::Shape& shape) {
    if (const auto* plane = std::get_if<scene::Plane>(&shape)) {
        const vec3 u(0.5f * plane->size.x, 0, 0), v(0, 0, 0.5f * plane->size.y);
        return {{vec3(0), {0, 1, 0}, u, v}, {vec3(0), {0, -1, 0}, u, v}};
    }
    std::vector<Side> sides;
    if (const auto* box = std::get_if<scene::Box>(&shape))
        for (int axis = 0; axis < 3; ++axis)
            for (const float sign : {1.0f, -1.0f}) {
                vec3 normal(0), u(0), v(0);
                normal[axis] = sign;
                u[(axis + 1) % 3] = 0.5f * box->size[(axis + 1) % 3];
                v[(axis + 2) % 3] = 0.5f * box->size[(axis + 2) % 3];
                sides.push_back({0.5f * box->size * normal, normal, u, v});
            }
    return sides;
}

} // namespace

ParamText aroundText() {
    return {.id = "surroundings",
            .label = "What is around",
            .group = Group::Environment,
            .doc =
                "What is seen in mirrors and through glass where rays leave what the camera shows: the "
                "environment alone; what the camera sees too; or all that is around, from views of its own.",
            .choices = kAround};
}

bool isFlat(const scene::Object& object) {
    return !sidesOf(object.shape).empty() && object.wave.amplitude == vec3(0) && !object.displacement;
}

Probe probeFrom(const scene::Scene& scene, int object) {
    const scene::Object& one = scene.objects[std::size_t(object)];
    return {.name = one.name,
            .place = boundsOf(one).center(),
            .object = one.material.isMirror() || one.material.isGlossy() ? object : -1,
            .reflectance = one.material.isMirror() ? one.material.mirror().reflectance : vec3(0),
            .hidden = {object}};
}

std::vector<Probe> probesFromMirror(const scene::Scene& scene, int object) {
    const scene::Object& mirror = scene.objects[std::size_t(object)];
    std::vector<Probe> probes{probeFrom(scene, object)};
    const bool isBall = std::holds_alternative<scene::Sphere>(mirror.shape) && !mirror.displacement;
    if (isFlat(mirror) || isBall) return probes; // shows nothing of itself
    Probe itself{.name = mirror.name, .place = probes[0].place, .object = -2, .hidden = {}};
    for (int i = 0; i < int(scene.objects.size()); ++i)
        if (i != object) itself.hidden.push_back(i);
    probes.push_back(std::move(itself));
    return probes;
}

std::vector<FlatMirror> flatSides(const scene::Scene& scene, int object, const Eye& eye) {
    const scene::Object& one = scene.objects[std::size_t(object)];
    std::vector<FlatMirror> flat;
    if (!isFlat(one)) return flat;
    const mat4 worldFromObject = one.transform.worldFromObject();
    for (const Side& side : sidesOf(one.shape)) {
        const vec3 middle(worldFromObject * vec4(side.middle, 1));
        const vec3 normal = glm::normalize(mat3(worldFromObject) * side.normal);
        const vec3 away = middle - eye.position;
        const vec3 towards = eye.perspective ? away / glm::length(away) : eye.forward;
        const float cosine = -glm::dot(normal, towards);
        const float distance = eye.perspective ? glm::length(away) : 1;
        const float area = 4 * glm::length(glm::cross(mat3(worldFromObject) * side.edgeU,
                                                      mat3(worldFromObject) * side.edgeV));
        if (!(cosine > 1e-4f) || area == 0) continue;
        flat.push_back({one.name, object, middle, normal,
                        area * cosine / (distance * distance * 4 * eye.halfExtent.x * eye.halfExtent.y)});
    }
    return flat;
}

scene::Camera cameraOf(const Probe& probe, int face) {
    vec3 forward(0);
    forward[face / 2] = face % 2 == 0 ? 1.0f : -1.0f;
    return {.type = scene::Camera::Type::Perspective,
            .eye = probe.place,
            .target = probe.place + forward,
            .up = face / 2 == 1 ? vec3(0, 0, -1) : vec3(0, 1, 0),
            .fov = 90};
}

scene::Camera mirrored(const scene::Camera& camera, const FlatMirror& mirror) {
    scene::Camera image = camera;
    image.eye -= 2 * glm::dot(camera.eye - mirror.place, mirror.normal) * mirror.normal;
    image.target -= 2 * glm::dot(camera.target - mirror.place, mirror.normal) * mirror.normal;
    image.up = glm::reflect(camera.up, mirror.normal);
    return image;
}

AroundBlock aroundBlock(const Surroundings* surroundings) {
    AroundBlock block;
    if (!surroundings) return block;
    block.low = vec4(surroundings->bounds.low, 0);
    block.high = vec4(surroundings->bounds.high, 0);
    block.count = int(surroundings->cubes.size());
    block.further = surroundings->further;
    block.texelsALook = surroundings->texelsALook;
    for (std::size_t i = 0; i < surroundings->cubes.size(); ++i) {
        const Probe& cube = surroundings->cubes[i];
        block.cubes[i] = {vec4(cube.place, cube.object), vec4(cube.reflectance, surroundings->faces[i])};
    }
    return block;
}

} // namespace lucent::views
