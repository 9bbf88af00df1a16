#include "viewer/Overlays.h"

#include "base/Image.h"

#include <algorithm>
#include <cstdio>

namespace lucent::viewer {

using namespace measure;

namespace {

constexpr float kDot = 4, kRing = 9;
constexpr float kClose = 28;
constexpr float kKeyColumn = 150;

struct HelpLine {
    const char *keys, *does;
};
constexpr HelpLine kHelp[] = {
    {"Drag", "moves the light, turns the environment"},
    {"Alt + drag", "rolls the environment"},
    {"Shift + drag", "orbits the camera"},
    {"Wheel", "lifts the light, or zooms"},
    {"Ctrl + wheel, pinch", "zooms"},
    {"Arrows", "move the light, turn the environment"},
    {"Page up, Page down", "lift the light, or zoom"},
    {"Shift + arrows", "orbit the camera"},
    {"0, Home", "camera and light as they were"},
    {"Ctrl + Z, Ctrl + Y", "undo, redo"},
    {"Double click", "types a value"},
    {"H", "panel"},
    {"F", "cost of the picture"},
    {"?", "this list"},
};

constexpr int kCard = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav |
                      ImGuiWindowFlags_NoSavedSettings;

void beginCard(const char* id, vec2 at, vec2 size, ImU32 border) {
    ImGui::SetNextWindowPos({at.x, at.y});
    ImGui::SetNextWindowSize({size.x, size.y});
    ImGui::Begin(id, nullptr, kCard);
    ImGui::GetWindowDrawList()->AddRect({at.x, at.y}, {at.x + size.x, at.y + size.y}, border, kRound);
}

bool closeButton(vec2 corner, const Theme& theme) {
    const vec2 at = corner - vec2(kClose + 8, -8), middle = at + vec2(kClose / 2);
    ImGui::SetCursorScreenPos({at.x, at.y});
    const bool pressed = ImGui::InvisibleButton("close", {kClose, kClose});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (ImGui::IsItemHovered())
        list.AddRectFilled({at.x, at.y}, {at.x + kClose, at.y + kClose}, theme.hover, kRound);
    const float r = 4.5f;
    list.AddLine({middle.x - r, middle.y - r}, {middle.x + r, middle.y + r}, theme.muted, 1.5f);
    list.AddLine({middle.x - r, middle.y + r}, {middle.x + r, middle.y - r}, theme.muted, 1.5f);
    return pressed;
}

ImVec2 wrappedSize(std::string_view text, float width) {
    return ImGui::CalcTextSize(text.data(), text.data() + text.size(), false, width);
}

std::string bytesText(std::size_t bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f MB", double(bytes) / 1e6);
    return text;
}

} // namespace

void drawLightDot(vec2 place, vec3 color) {
    vec3 shown;
    const float brightest = std::max({color.r, color.g, color.b, 1e-6f});
    for (int i = 0; i < 3; ++i)
        shown[i] = srgbFromLinear(std::clamp(color[i] / brightest, 0.0f, 1.0f));
    const ImU32 ink = ImGui::ColorConvertFloat4ToU32({shown.x, shown.y, shown.z, 1});
    const ImU32 shadow = IM_COL32(0, 0, 0, 120);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddCircle({place.x, place.y}, kRing, shadow, 32, 4);
    list.AddCircle({place.x, place.y}, kRing, ink, 32, 2);
    list.AddCircleFilled({place.x, place.y}, kDot + 1, shadow, 24);
    list.AddCircleFilled({place.x, place.y}, kDot, ink, 24);
}

bool drawMessage(const std::string& message, vec2 picture, const Theme& theme) {
    const float width = std::min(560.0f, picture.x - 2 * kMargin);
    const float inner = width - 2 * kPadding - kClose;
    const float height = wrappedSize(message, inner).y + 2 * kPadding;
    const vec2 at((picture.x - width) / 2, kMargin);
    beginCard("message", at, {width, height}, theme.error);
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y}, {at.x + 4, at.y + height}, theme.error, kRound,
                                              ImDrawFlags_RoundCornersLeft);
    ImGui::SetCursorScreenPos({at.x + kPadding, at.y + kPadding});
    ImGui::PushTextWrapPos(kPadding + inner);
    ImGui::TextUnformatted(message.data(), message.data() + message.size());
    ImGui::PopTextWrapPos();
    const bool closed = closeButton({at.x + width, at.y}, theme);
    ImGui::End();
    return closed;
}

bool drawHelp(vec2 picture, const Theme& theme) {
    const vec2 size(std::min(470.0f, picture.x - 2 * kMargin), std::size(kHelp) * kLine + 2 * kPadding);
    const vec2 at = glm::max((picture - size) / 2.0f, vec2(kMargin));
    beginCard("help", at, size, theme.cardBorder);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    float y = at.y + kPadding + (kLine - kText) / 2;
    for (const HelpLine& line : kHelp) {
        list.AddText({at.x + kPadding, y}, theme.accent, line.keys);
        list.AddText({at.x + kPadding + kKeyColumn, y}, theme.text, line.does);
        y += kLine;
    }
    const bool closed = closeButton({at.x + size.x, at.y}, theme);
    ImGui::End();
    return closed;
}

void drawStats(const frame::Stats& stats, vec2 picture, const Theme& theme) {
    char text[128];
    std::snprintf(text, sizeof text, "%.1f ms · %d passes · %d draws · %d %s · %s", stats.milliseconds,
                  stats.passes, stats.draws, stats.lights, stats.lights == 1 ? "light" : "lights",
                  bytesText(stats.bytes).c_str());
    const vec2 size(ImGui::CalcTextSize(text).x + 20, 28);
    const ImVec2 low(kMargin, picture.y - kMargin - size.y);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddRectFilled(low, {low.x + size.x, low.y + size.y}, theme.card, kRound);
    list.AddText({low.x + 10, low.y + (size.y - kText) / 2}, theme.text, text);
}

void drawTooltip(std::string_view text, Rect control, vec2 canvas, const Theme& theme) {
    const float inner = std::min(240.0f, canvas.x - 2 * kMargin - 24);
    const ImVec2 measured = wrappedSize(text, inner);
    const vec2 size(measured.x + 24, measured.y + 20);
    // Left of the control; where there is no room, above it.
    vec2 at(control.low.x - size.x - 16, control.low.y);
    if (at.x < kMargin) at = {control.low.x, control.low.y - size.y - 6};
    at = glm::clamp(at, vec2(kMargin), glm::max(canvas - size - kMargin, vec2(kMargin)));
    ImDrawList& list = *ImGui::GetForegroundDrawList();
    const ImVec2 low(at.x, at.y), high(at.x + size.x, at.y + size.y);
    list.AddRectFilled(low, high, theme.card | IM_COL32_A_MASK, kRound);
    list.AddRect(low, high, theme.cardBorder, kRound);
    list.AddText(nullptr, 0, {at.x + 12, at.y + 10}, theme.text, text.data(), text.data() + text.size(),
                 inner);
}

} // namespace lucent::viewer
