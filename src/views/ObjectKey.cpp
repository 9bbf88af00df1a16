#include "views/ObjectKey.h"

#include "scene/Displacement.h"
#include "views/Meshes.h"

namespace lucent::views {

ObjectKey objectKey(const scene::Object& object, float time) {
    ObjectKey key{{}, object.transform.worldFromObject(), object.visible};
    if (object.isField()) {
        const scene::HeightField& field = object.field();
        key.own = {.shape = field.heights, .mask = field.alpha, .field = {field.width, field.heightScale}};
        return key;
    }
    if (object.isDisplaced()) {
        key.own = {.shape = scene::baseOf(object), .mask = nullptr, .displacement = object.displacement};
        return key;
    }
    const std::shared_ptr<const scene::Mesh> mesh = scene::meshOf(object);
    const bool waved = object.wave.amplitude != vec3(0);
    key.own = {.shape = mesh, .mask = nullptr, .isRefractive = object.material.isRefractive()};
    if (waved) key.own.wave = object.wave;
    if (waved || mesh->moves()) key.own.time = time;
    return key;
}

std::vector<ObjectKey> objectKeys(const scene::Scene& scene) {
    std::vector<ObjectKey> keys;
    for (const scene::Object& object : scene.objects)
        keys.push_back(objectKey(object, scene.view.time));
    return keys;
}

} // namespace lucent::views
