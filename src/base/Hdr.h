#pragma once
/// Reads Radiance pictures (.hdr). By hand: stb's reader never ends on a file that was cut inside a run.

#include "base/Image.h"

namespace lucent {

/// RGBE pixels, rows from the top, flat or run-length coded (old and new kind). Values are taken as they
/// stand: the header's EXPOSURE is a note of how the picture was made, which other readers ignore as well.
Result<Image> decodeHdr(std::span<const std::byte> bytes, const std::string& name);

} // namespace lucent
