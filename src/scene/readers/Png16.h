#pragma once
/// 16-bit PNG files. Written by hand because no packaged writer that is here knows them: stb writes 8 bits.

#include "base/Image.h"

namespace lucent::scene {

/// Values in [0,1] as they are, others clamped; 1 to 4 channels, of an even number the last is alpha.
Bytes encodePng16(const Image& image);

} // namespace lucent::scene
