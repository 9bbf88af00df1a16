#pragma once
/// Portable float maps: a text header and raw floats, rows from the bottom up. Written by hand because no
/// packaged reader keeps every bit.

#include "base/Image.h"

namespace lucent {

/// True when the bytes begin as a PFM file does.
bool isPfm(std::span<const std::byte> bytes);

/// Either byte order, 1, 3 or, as type "PF4", 4 channels. The size of the scale field is a label in the wild,
/// not a factor: only its sign is read, which tells the byte order.
Result<Image> decodePfm(std::span<const std::byte> bytes, const std::string& name);

/// Little-endian; `image` has 1, 3 or 4 channels.
Bytes encodePfm(const Image& image);

} // namespace lucent
