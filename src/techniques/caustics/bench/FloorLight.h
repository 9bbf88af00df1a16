#pragma once
/// Light on a floor by way of a glass ball and of sine water, in closed form: parallel light of irradiance 1
/// from above, a camera that looks straight down.

#include "base/Image.h"
#include "base/Math.h"

namespace lucent::caustics {

/// A ball of radius 1 whose centre lies above the floor's middle. The sum over the branches of
/// T(b)² b |db| / (r |dr|), with b the distance of a ray from the axis, r where it lands, and T what one
/// interface transmits; rays that are turned away from the floor are missing.
///
/// @param height  of the picture on the floor, m
/// @param ior     > 1
/// @param below   of the centre: how far the floor is, m; ior / (2 (ior - 1)) is the paraxial focus
/// @return        W/m² in four channels, the last of them 1; each pixel the mean over it
Image lightOfBall(ivec2 size, double height, double ior, double below);

/// Water whose height is amplitude * sin(2 pi x / wavelength), with x = 0 in the picture's middle, over a
/// floor: the sum of |dx / dX| times what the surface transmits over all places x whose light falls on X.
///
/// @param width   of the picture on the floor, m
/// @param depth   of the floor below the water's mean height, m
/// @return        as above
Image lightOfWater(ivec2 size, double width, double amplitude, double wavelength, double ior, double depth);

} // namespace lucent::caustics
