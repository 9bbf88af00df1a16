#include "views/ObjectKey.h"

#include "views/Meshes.h"

namespace lucent::views {

ObjectKey objectKey(const scene::Object& object, float time) {
    ObjectKey key{nullptr, nullptr, {}, object.transform.worldFromObject(), object.visible};
    if (object.isField()) {
        const scene::HeightField& field = object.field();
        key.shape = field.heights;
        key.mask = field.alpha;
        key.numbers = {field.width, field.heightScale};
        return key;
    }
    const std::shared_ptr<const scene::Mesh> mesh = scene::meshOf(object);
    const scene::Wave& wave = object.wave;
    const bool waved = wave.amplitude != vec3(0);
    key.shape = mesh;
    key.numbers = {float(object.material.isRefractive()), waved || mesh->moves() ? time : 0};
    if (waved)
        for (float value : {wave.amplitude.x, wave.amplitude.y, wave.amplitude.z, wave.direction.x,
                            wave.direction.y, wave.direction.z, wave.wavelength, wave.period})
            key.numbers.push_back(value);
    return key;
}

} // namespace lucent::views
