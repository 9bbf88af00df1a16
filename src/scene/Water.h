#pragma once
/// What belongs to water itself, whoever computes it: its steps through time and the drops that fall into it.

#include "base/Result.h"
#include "scene/Scene.h"

namespace lucent::scene {

/// Hollows the surface by `depth` in the middle; a rim around holds what was there, so that the mean stays:
/// -depth (1 - q) e^(-q), q = distance² / radius², which the walls mirror.
struct WaterDrop {
    vec2 place{0};       ///< along x and z from the middle, m
    float radius = 0.1f; ///< m, > 0; below two cells of the grid the hollow is two cells wide
    float depth = 0.05f; ///< m
};

/// The n-th drop that falls by itself, n = 1, 2, ..., after n times Water::dropInterval; n may be large.
WaterDrop fallingDrop(const Water& water, double n);

/// Steps of time a second: a multiple of kWaterStepsPerSecond that keeps leapfrog stable.
int waterStepsPerSecond(const Water& water);
inline constexpr int kWaterStepsPerSecond = 120;

/// Steps times cells that anybody computes at once: half a minute for llvmpipe, an hour and a half of the
/// time of 128 x 128 cells.
inline constexpr double kMostWaterWork = 1e10;
/// What is said where a time lies further ahead.
///
/// @param work  steps times cells
Error waterTooFarAhead(const std::string& object, float time, double work);

} // namespace lucent::scene
