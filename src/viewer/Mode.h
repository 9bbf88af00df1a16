#pragma once
/// What a person works on: the mode decides which sliders stand first and which views are offered.

#include "base/Param.h"
#include "scene/Scene.h"

#include <span>
#include <string_view>
#include <vector>

namespace lucent::viewer {

/// A place in the list of modes: those of the techniques, then the brush.
enum class Mode : int {};

/// How exact pictures are of a scene that wants no error of its own.
enum class Accuracy : int { Automatic, Full };

/// Part of the view, not of the scene: no undo step, not in a scene file.
struct ModeSettings {
    Mode mode{};
    Accuracy accuracy = Accuracy::Automatic;
    bool matt = false; ///< what has subsurface scattering is drawn as if it did not: Lambert's law and the
                       ///< same highlights
};

/// "mode", "matt" and "accuracy", which are also their paths and attributes.
std::span<const Param> modeParams();
std::string_view nameOf(Mode mode);
/// The brush.
Mode paintMode();
/// All of them; each is shown where it has something to choose.
///
/// @param error  of pictures by Accuracy::Automatic; 0: the device draws them in full
std::vector<BoundParam> bindMode(ModeSettings& settings, const scene::Scene& scene, float error);
/// The scene as `matt` wants it drawn.
void applyMatt(const ModeSettings& settings, scene::Scene& scene);

/// Modes that have something to do in a scene; the first of all where none has.
std::vector<Mode> modesOf(const scene::Scene& scene);
/// The one that a scene begins with: what its light does, as the gallery sorts it.
Mode modeFor(const scene::Scene& scene);

/// Place of a group in the panel, from 0 on; Group::None stands last.
int placeOf(Group group, Mode mode);

/// What "show" offers, spelled as scene::aovNames(): what belongs to the mode or to all of them, and what is
/// shown.
std::vector<std::string_view> viewsOf(Mode mode, scene::Aov shown);

} // namespace lucent::viewer
