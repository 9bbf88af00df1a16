#pragma once
/// What the pictures of a set are for: one surface in several files, such as coin_height.png and
/// coin_albedo.png.

#include "base/Image.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lucent::scene {

enum class MapUse { Heights, Normals, Albedo, Alpha, Specular };

/// "height", "normal", "albedo", "alpha", "specular", in the order of MapUse.
std::span<const std::string_view> mapUseNames();
std::optional<MapUse> mapUseNamed(std::string_view name);

/// What the last part of a file's name says: "coin_height.png", "Coin-Normal.tif", "coin.albedo.png"; nothing
/// where it says nothing.
std::optional<MapUse> mapUseOf(std::string_view path);

/// What all files of a set are called: the file's name without folder, ending and mapUseOf()'s part; never
/// empty. Without dots, so that an object may have it.
std::string titleOf(std::string_view path);

/// Whether a picture holds normals: of 64 texels 63 are of length 1 within 0.1 once stored n = 2 c - 1 is
/// undone and face the viewer, and the normals lie around the picture's own (their mean is within 30 degrees
/// of +z).
bool holdsNormals(const Image& image);

/// Whether red, green and blue of a pixel are further apart than in a grey picture that JPEG has stored (8 of
/// 255): such a picture shows colours, and what is bright in it need not be high.
bool holdsColors(const Image& image);

/// Whether the normals' green grows downwards in the picture (DirectX's way) rather than upwards.
///
/// Slopes p along x and q upwards belong to a surface when dp/dy = dq/dx: what of the two signs of q leaves
/// the smaller sum of squares of the difference is taken; where both leave as much, upwards.
bool greenPointsDown(const Image& normals);

} // namespace lucent::scene
