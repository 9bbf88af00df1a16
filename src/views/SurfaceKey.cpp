#include "views/SurfaceKey.h"

namespace lucent::views {

SurfaceKey surfaceKey(const scene::Scene& scene, const Eye& eye, ivec2 size, std::uint64_t waters) {
    return {objectKeys(scene), eye.clipFromWorld, eye.second, size, isGeometric(scene.view.show), waters};
}

} // namespace lucent::views
