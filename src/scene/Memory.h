#pragma once
/// What a scene's numbers ask for in memory, so that it is refused by name before any is taken.

#include "scene/Scene.h"

namespace lucent::scene {

/// What all objects may ask for together. WebAssembly has 2 GiB for everything, and growing lists need their
/// old and their new place at once.
inline constexpr double kMostBytes = sizeof(void*) == 4 ? 0x1p30 : 0x1p34;

/// Of a sheet's triangles on their way to the GPU.
double bytesOf(const Water& water);
/// Of the triangles of a height field that is no relief.
double bytesOfBody(const HeightField& field);
/// Of both painted maps of `side` x `side` texels and the surface under them.
double bytesOfPaint(int side);
/// Of heights that are taken from a mesh.
double bytesOfHeights(ivec2 resolution);

/// " is VALUE: with it all takes about 20 GiB; ..." where `bytes` are more than kMostBytes, else "".
std::string whyTooLarge(const std::string& value, double bytes);

} // namespace lucent::scene
