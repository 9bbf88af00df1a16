#pragma once
/// The look of everything that is drawn over the picture: colours for light and dark pages, type, measures.

#include "base/Math.h"

#include <imgui.h>

namespace lucent::viewer {

/// Colours as ImGui packs them: encoded (sRGB), straight alpha.
struct Theme {
    ImU32 card; ///< surface of the panel, translucent
    ImU32 cardBorder;
    ImU32 text, muted; ///< labels and values; units and headings
    ImU32 accent;      ///< what is set: filled tracks, chosen options
    ImU32 onAccent;    ///< text upon it
    ImU32 accentFaint; ///< ring around the focused control
    ImU32 track;       ///< empty part of sliders, unchosen options
    ImU32 hover;       ///< under the pointer
    ImU32 knob;
    ImU32 error;
};

/// The light or the dark variant.
const Theme& theme(bool dark);

/// Measures in CSS pixels.
namespace layout {
inline constexpr float kText = 15;    ///< type size
inline constexpr float kPanel = 312;  ///< width of the docked panel
inline constexpr float kMargin = 12;  ///< between panel and edge
inline constexpr float kPadding = 16; ///< inside the panel
inline constexpr float kHeader = 48;  ///< title bar of the panel
inline constexpr float kLine = 26;    ///< a line of label and value
inline constexpr float kSlider = 22;  ///< height in which a slider can be grabbed
inline constexpr float kGap = 10;     ///< between two controls
inline constexpr float kRound = 6;
inline constexpr float kSheetBelow = 560; ///< canvases narrower than this get a sheet at the bottom
inline constexpr float kSheet = 400;      ///< its height, at most half the canvas
} // namespace layout

/// Type for all viewers of a page, cut for screens with one and with two pixels a CSS pixel.
struct Fonts {
    Fonts();
    /// Makes the current ImGui context use the cut that fits, and curves as smooth as the pixels show.
    void select(float scale);
    ImFontAtlas atlas;

private:
    ImFont *plain_, *fine_;
};
Fonts& fonts();

/// Gives the current ImGui context our style.
void applyTheme(const Theme& theme);

} // namespace lucent::viewer
