#include "views/SurfaceKey.h"

#include "views/Surface.h"

namespace lucent::views {

SurfaceKey surfaceKey(const scene::Scene& scene, ivec2 size, std::uint64_t waters) {
    SurfaceKey key{{},
                   makeEye(scene, float(size.x) / float(size.y)).clipFromWorld,
                   size,
                   isGeometric(scene.view.show),
                   waters};
    for (const scene::Object& object : scene.objects)
        key.objects.push_back(objectKey(object, scene.view.time));
    return key;
}

} // namespace lucent::views
