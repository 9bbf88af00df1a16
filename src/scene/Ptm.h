#pragma once
/// Polynomial texture maps (.ptm): what photographs under many lamps became elsewhere.

#include "scene/PhotometricStereo.h"

namespace lucent::scene {

/// True for bytes that begin as a PTM file does.
bool isPtm(std::span<const std::byte> bytes);

/// Normals and albedo of a PTM file, of uncompressed LRGB or RGB (PTM_1.2). The residual is empty.
///
/// A pixel's brightness under light from (u, v, sqrt(1 - u² - v²)) is L = a0 u² + a1 v² + a2 u v + a3 u + a4
/// v + a5 (Malzbender, Gelb and Wolters 2001, eq. 5). The normal is the light that makes it brightest (eqs.
/// 16 to 18): u = (a2 a4 - 2 a1 a3) / D, v = (a2 a3 - 2 a0 a4) / D with D = 4 a0 a1 - a2². Where L has no
/// such place, or one beyond the horizon, it is the direction in which L grows, or +z, at n.z = 0.05. The
/// albedo is the colour there.
/// @return  Error "NAME: what was found; what was expected"
Result<SurfaceMaps> decodePtm(std::span<const std::byte> bytes, const std::string& name);

} // namespace lucent::scene
