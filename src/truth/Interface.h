#pragma once
/// What a smooth boundary between two clear media does with light.

#include "base/Math.h"

#include <optional>

namespace lucent::truth {

/// The mirrored direction.
///
/// @param direction  unit, towards the surface
/// @param normal     unit, either side
dvec3 mirrored(const dvec3& direction, const dvec3& normal);

/// The refracted direction by Snell's law; nothing where all light is reflected.
///
/// @param direction  unit, towards the surface
/// @param normal     unit, against `direction`
/// @param relative   index of refraction on this side over that on the other, > 0
/// @return           unit; `direction` itself, to the bit, for equal indices
std::optional<dvec3> refracted(const dvec3& direction, const dvec3& normal, double relative);

/// Reflected share of unpolarised light: the mean of the squared amplitudes of both polarisations
/// (n1 cos1 - n2 cos2) / (n1 cos1 + n2 cos2) and (n2 cos1 - n1 cos2) / (n2 cos1 + n1 cos2) (Fresnel 1823).
///
/// @param cosine    of the angle of incidence, [0,1]
/// @param relative  index of refraction on this side over that on the other, > 0
/// @return          [0,1]; 1 beyond the critical angle, 0 for equal indices
double reflectance(double cosine, double relative);

} // namespace lucent::truth
