#pragma once
/// OpenEXR pictures by tinyexr: scan lines or tiles, one part, half or 32-bit floats.

#include "base/Image.h"

namespace lucent::scene {

bool isExr(std::span<const std::byte> bytes);

/// @return  3 linear channels, 4 with alpha, or 1 when the file has only one.
///          Error "NAME: what was found; what was expected"
Result<Image> decodeExr(std::span<const std::byte> bytes, const std::string& name);

} // namespace lucent::scene
