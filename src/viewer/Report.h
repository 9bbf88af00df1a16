#pragma once
/// What a page asks about a viewer, as JSON.

#include "frame/Renderer.h"
#include "viewer/Compare.h"
#include "viewer/Interaction.h"
#include "viewer/Mode.h"
#include "viewer/Panel.h"

#include <optional>

namespace lucent::viewer {

/// Array of the controls in panel order; those of Group::None too, with an empty group. Then the actions.
std::string controlsJson(std::span<const Control> controls, std::span<const Action> actions);

/// Object path -> value of every parameter that differs from the loaded scene.
///
/// @param leftOut  value of a parameter that is never named
std::string changesJson(std::span<const Control> controls, const void* leftOut);

/// Work that takes long.
struct DrawingProgress {
    std::string_view task;             ///< what is done now, for people
    float share = 0;                   ///< of it that is done, [0,1]
    std::optional<double> secondsLeft; ///< none: nobody knows yet
};

struct StatsInput {
    frame::Stats cost;
    bool complete = false, finished = false; ///< the picture is, and has all samples of its pixels
    bool shown = false;                      ///< there is a picture, be it a preview
    vec2 open{0}; ///< CSS pixels from the upper left that neither panel nor numbers cover
    bool canUndo = false, canRedo = false;
    int downscale = 1; ///< of what is shown: pixels to one that was drawn, along a side
    std::optional<DrawingProgress> progress;
    std::string bakeTechnique, bakeObject, bakeWork; ///< what is missing; empty: nothing
    int pictures = 0;                                ///< shown so far, drawn or reprojected
    bool reprojected = false;                        ///< what is shown
    int frames = 0;
    std::uint64_t revision = 0;
    std::vector<LightHandle> lamps;      ///< CSS pixels of their dots and arrows
    std::size_t light = 0;               ///< the chosen one
    std::vector<Mode> modes;             ///< of the scene
    std::vector<std::string> notDrawn;   ///< what the scene asks for and its picture lacks
    technique::Balance balance;          ///< of the caustic map that is shown
    std::map<std::string, Rect> widgets; ///< see Panel::widgets()
};
std::string statsJson(const StatsInput& input);

/// How the picture stands to what is beside it.
struct ComparisonReport {
    std::string mode, truth; ///< truth: "none", "stale" or "fresh"
    float divider = 0;
    ivec2 size{0};               ///< of the truth, pixels
    std::optional<double> noise; ///< of the truth
    std::optional<Rect> place;   ///< of what is beside the picture, were the divider at its left; CSS pixels
    float scale = 1;             ///< pixels a CSS pixel
    std::optional<measure::Metrics> numbers;
    std::string left, right; ///< of Methods and Materials: which
    std::optional<measure::Metrics> rightNumbers;
    frame::Stats cost;
};
std::string comparisonJson(const ComparisonReport& report);

} // namespace lucent::viewer
