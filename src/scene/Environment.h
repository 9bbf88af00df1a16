#pragma once
/// Environments made by a formula instead of read from a file. Directions: y up, the map's centre at -z.

#include "base/Image.h"

#include <span>
#include <string_view>

namespace lucent::scene {

/// Names of the environments that need no file.
std::span<const std::string_view> proceduralEnvironments();

/// Lat-long map of 256 x 128 texels, linear, each texel the radiance L of its centre's unit direction d:
///
/// - rainbow    hue = azimuth, from -z over +x (hue 90 degrees) to +z, full saturation, value 1
/// - sky        d.y >= 0: mix(horizon, zenith, sqrt(d.y)); below: ground. horizon = (0.9, 0.95, 1),
///              zenith = (0.15, 0.35, 0.8), ground = (0.2, 0.17, 0.14). No sun: add a distant light. Chosen
///              by eye
/// - uniform    (1, 1, 1)
/// - direction  0.5 + 0.5 d; tells every wrong turn and mirror
///
/// @param name  one of proceduralEnvironments()
Image proceduralEnvironment(std::string_view name);

} // namespace lucent::scene
