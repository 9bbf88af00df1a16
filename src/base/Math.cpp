#include "base/Math.h"

namespace lucent {

mat3 rotationFromDegrees(vec3 degrees) {
    const vec3 a = glm::radians(degrees);
    mat4 m = glm::rotate(mat4(1), a.z, vec3(0, 0, 1));
    m = glm::rotate(m, a.y, vec3(0, 1, 0));
    return mat3(glm::rotate(m, a.x, vec3(1, 0, 0)));
}

std::uint16_t halfFrom(float number) {
    constexpr float kMost = 65504, kLeastNormal = 6.103515625e-5f; // 2^-14
    if (!(number < kMost)) return 0x7bff;
    if (number < kLeastNormal) { // beside 1/2 a float's steps are 2^-24, those of such halves
        return std::uint16_t(glm::floatBitsToUint(number + 0.5f) - glm::floatBitsToUint(0.5f));
    }
    const auto bits = glm::floatBitsToUint(number);
    constexpr std::uint32_t kExponents = std::uint32_t(127 - 15) << 23; // of floats beyond those of halves
    return std::uint16_t((bits - kExponents + 0xfff + (bits >> 13 & 1)) >> 13);
}

} // namespace lucent
