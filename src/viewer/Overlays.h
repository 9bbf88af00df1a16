#pragma once
/// What is drawn over the picture itself: the light's dot, messages, help, the cost of the picture, tooltips.
/// All need a current ImGui context between NewFrame and Render; all places are CSS pixels.

#include "frame/Renderer.h"
#include "viewer/Interaction.h"
#include "viewer/Panel.h"

#include <optional>
#include <string>

namespace lucent::viewer {

/// A ring in the light's colour (linear), with a dot or an arrow; a second ring where it is the chosen one.
void drawLightHandle(const LightHandle& handle, vec3 color, bool isChosen);

/// A card at the top with a message. @return true when its close button was pressed
bool drawMessage(const std::string& message, vec2 picture, const Theme& theme);

/// What a drag on the picture is for: a relief's light, the camera where there is none, or a brush.
enum class Hand { Light, Camera, Brush };
/// The list of gestures and keys. @return true when it was closed
bool drawHelp(Hand hand, vec2 picture, const Theme& theme);

/// One line at the bottom.
void drawLine(const std::string& text, vec2 picture, const Theme& theme);
/// The same: what the last complete picture cost.
void drawStats(const frame::Stats& stats, vec2 picture, const Theme& theme);

/// The line between a picture and what stands right of it, with their names. `lively`: it is being moved.
struct SideNames {
    std::string left, right;
};
void drawDivider(float x, Rect picture, const SideNames& names, bool lively, const Theme& theme);

/// A sentence on a card in the middle of a part of the picture; not drawn where that is too narrow for words.
void drawNotice(std::string_view text, Rect room, const Theme& theme);

/// What the ends of a scale of false colours stand for.
struct ScaleEnds {
    std::string low, high;
};

/// Numbers about the picture, at the bottom; over them the false colours where it has them. @return  the
/// card's top
float drawNumbersCard(const std::string& text, const std::optional<ScaleEnds>& scale, vec2 room,
                      const Theme& theme);

/// A sentence beside the control that it explains, inside the canvas.
void drawTooltip(std::string_view text, Rect control, vec2 canvas, const Theme& theme);

} // namespace lucent::viewer
