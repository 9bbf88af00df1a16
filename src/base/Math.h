#pragma once
/// The vector and matrix types of the whole project, and the few constants that the field keeps using.
///
/// House units: metres, radians, linear Rec. 709, y up, right-handed.

#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cstdint>
#include <numbers>

namespace lucent {
using glm::dvec2;
using glm::dvec3;
using glm::ivec2;
using glm::ivec4;
using glm::mat3;
using glm::mat4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

inline constexpr float kPi = std::numbers::pi_v<float>;

/// Rotation about the fixed x, then y, then z axis.
///
/// @param degrees  angles about x, y, z in degrees, any value
/// @return         worldFromLocal rotation
mat3 rotationFromDegrees(vec3 degrees);

/// The half float nearest to a number of at least 0, of two the even one; beyond the largest that one. Many
/// times as quick as glm::packHalf1x16, for pictures.
std::uint16_t halfFrom(float number);
} // namespace lucent
