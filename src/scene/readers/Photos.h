#pragma once
/// A surface of which photographs tell becomes a scene.

#include "scene/Bring.h"
#include "scene/PhotometricStereo.h"

namespace lucent::scene {

/// What is white in the picture of the residual: a root mean square of 10 % of the albedo, or more.
inline constexpr float kResidualWhite = 0.1f;

/// The relief that sceneOfMaps() makes of the normals and the albedo. Behind the files of the scene follow
/// TITLE_normal.png and, where there is one, TITLE_residual.png, which it does not name; 16-bit PNG, as the
/// albedo.
Result<Brought> sceneOfSurface(const std::string& title, const SurfaceMaps& maps);

/// What a person wants to know of it: "residual 0.8 % of the albedo (root mean square); 12 % of the values
/// left out as shadows or highlights", and by how much the photographs were made smaller.
std::string describe(const PhotometricStereo& stereo);

} // namespace lucent::scene
