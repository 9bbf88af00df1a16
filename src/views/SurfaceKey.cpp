#include "views/SurfaceKey.h"

namespace lucent::views {

SurfaceKey surfaceKey(const scene::Scene& scene, const Eye& eye, ivec2 size, std::uint64_t waters) {
    SurfaceKey key{{}, eye.clipFromWorld, eye.second, size, isGeometric(scene.view.show), waters};
    for (const scene::Object& object : scene.objects)
        key.objects.push_back(objectKey(object, scene.view.time));
    return key;
}

} // namespace lucent::views
