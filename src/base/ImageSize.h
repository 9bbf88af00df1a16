#pragma once
/// How large an image may be, checked before memory is taken.

#include "base/Result.h"

namespace lucent {

inline constexpr int kMaxImageSide = 16384;        ///< pixels, what GPUs can hold
inline constexpr double kMaxImagePixels = 1 << 26; ///< 8192 x 8192: 1 GiB in four float channels

/// In linear floats. WebAssembly has 2 GiB for everything.
inline constexpr double kMaxImageBytes = sizeof(void*) == 4 ? 1 << 29 : 1 << 30;

/// Error "NAME: is 0 x 4 pixels; must be ..." unless both sides are whole numbers and all is within the
/// limits.
Status checkImageSize(double width, double height, int channels, const std::string& name);

} // namespace lucent
