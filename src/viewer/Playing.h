#pragma once
/// Time that runs while a person looks.

#include "base/Param.h"

#include <span>

namespace lucent::viewer {

/// What a person chooses. Part of the view, not of the scene: no undo step, not in a scene file.
struct PlaySettings {
    bool playing = false;
};

/// "playing", which is also its path. It has no attribute.
std::span<const Param> playParams();

/// @param shown  false: nothing in the scene moves, and the panel has no such control
BoundParam bindPlaying(PlaySettings& settings, bool shown);

} // namespace lucent::viewer
