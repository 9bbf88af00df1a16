#pragma once
/// TIFF pictures, by libtiff.

#include "base/Image.h"

namespace lucent::scene {

/// True for bytes that begin as TIFF (or BigTIFF) does, in either byte order.
bool isTiff(std::span<const std::byte> bytes);

/// The first picture of a file as what decodeImage() reads: 8 and 16 bits become 16-bit PNG, floats PFM.
///
/// 16-bit integers and 32-bit floats of 1 to 4 channels keep their values; all else that libtiff knows
/// (palettes, bits, YCbCr) comes through its 8-bit RGBA. Without JPEG, WebP, LZMA and Zstandard inside.
/// @return  Error "NAME: what was found; what was expected"
Result<Bytes> plainTiff(std::span<const std::byte> bytes, const std::string& name);

} // namespace lucent::scene
