#include "base/Math.h"

namespace lucent {

mat3 rotationFromDegrees(vec3 degrees) {
    const vec3 a = glm::radians(degrees);
    mat4 m = glm::rotate(mat4(1), a.z, vec3(0, 0, 1));
    m = glm::rotate(m, a.y, vec3(0, 1, 0));
    return mat3(glm::rotate(m, a.x, vec3(1, 0, 0)));
}

} // namespace lucent
