#include "viewer/Overlays.h"

#include "base/Image.h"
#include "measure/Metrics.h"

#include <algorithm>
#include <cstdio>

namespace lucent::viewer {

using namespace layout;

namespace {

constexpr float kDot = 4, kArrow = 6, kRing = 9; // radii
constexpr float kClose = 28;
constexpr float kKeyColumn = 150;
constexpr float kHandle = 14;   // radius of the divider's
constexpr float kScaleBar = 16; // height

struct HelpLine {
    const char *keys, *does;
};
constexpr HelpLine kReliefHelp[] = {
    {"Drag", "moves the light, turns the environment"},
    {"Alt + drag", "rolls the environment"},
    {"Shift + drag", "orbits the camera"},
    {"Wheel", "lifts the light, or zooms"},
    {"Ctrl + wheel, pinch", "zooms"},
    {"Arrows", "move the light, turn the environment"},
    {"Page up, Page down", "lift the light, or zoom"},
    {"Shift + arrows", "orbit the camera"},
    {"Space", "plays what moves, or stops it"},
};
constexpr HelpLine kOrbitHelp[] = {
    {"Drag", "orbits the camera, moves a light by its dot"},
    {"Drag on water, D", "drops; Ctrl + drag orbits there"},
    {"Alt + drag", "rolls the environment"},
    {"Shift + drag", "turns the environment, or moves the light"},
    {"Wheel, pinch", "zooms"},
    {"Arrows", "orbit the camera"},
    {"Page up, Page down", "zoom"},
    {"Shift + arrows", "turn the environment, or move the light"},
    {"Space", "plays what moves, or stops it"},
};
constexpr HelpLine kPaintHelp[] = {
    {"Drag", "paints what is translucent, else orbits"},
    {"Shift + drag", "orbits the camera"},
    {"1, 2, 3, 4", "translucency, blur, glow, outgoing"},
    {"[ and ]", "make the brush smaller, larger"},
    {"X", "erases: back to how the object began"},
    {"G", "fills all of the object"},
    {"Wheel, pinch", "zooms"},
    {"Arrows", "orbit the camera"},
    {"Space", "plays what moves, or stops it"},
};
// One card for all.
static_assert(std::size(kReliefHelp) == std::size(kOrbitHelp));
static_assert(std::size(kReliefHelp) == std::size(kPaintHelp));
constexpr HelpLine kHelp[] = {
    {"0, Home", "camera and light as they were"},
    {"Ctrl + Z, Ctrl + Y", "undo, redo"},
    {"Double click", "types a value"},
    {"H", "panel"},
    {"F", "cost of the picture"},
    {"C", "beside truth, error, other methods, or alone"},
    {"L", "chooses the next lamp"},
    {"M", "translucent objects as if they were matt"},
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

// A word on a dark ground, so that it is read over any picture; `right` is the share of it left of `at`.
void label(ImDrawList& list, const std::string& word, vec2 at, float right, Rect picture) {
    const float width = ImGui::CalcTextSize(word.c_str()).x + 12;
    const float x = at.x - right * width;
    if (x < picture.low.x || x + width > picture.high.x) return; // no room beside the divider
    list.AddRectFilled({x, at.y}, {x + width, at.y + kText + 8}, IM_COL32(0, 0, 0, 150), kRound);
    list.AddText({x + 6, at.y + 3}, IM_COL32_WHITE, word.c_str());
}

// The false colours with what their ends stand for.
void drawScale(ImDrawList& list, vec2 at, float width, const ScaleEnds& ends, const Theme& theme) {
    const auto widthOf = [](const std::string& text) { return ImGui::CalcTextSize(text.c_str()).x; };
    const float left = at.x + widthOf(ends.low) + 6, right = at.x + width - widthOf(ends.high) - 6;
    list.AddText({at.x, at.y}, theme.muted, ends.low.c_str());
    list.AddText({right + 6, at.y}, theme.muted, ends.high.c_str());
    const auto ink = [](float share) {
        const vec3 color(measure::heatColor(double(share)));
        return ImGui::ColorConvertFloat4ToU32(
            {srgbFromLinear(color.r), srgbFromLinear(color.g), srgbFromLinear(color.b), 1});
    };
    constexpr int kParts = 24;
    for (int i = 0; i < kParts; ++i) {
        const float a = float(i) / kParts, b = float(i + 1) / kParts;
        list.AddRectFilledMultiColor({glm::mix(left, right, a), at.y + 3},
                                     {glm::mix(left, right, b), at.y + kText}, ink(a), ink(b), ink(b),
                                     ink(a));
    }
}

std::string bytesText(std::size_t bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f MB", double(bytes) / 1e6);
    return text;
}

} // namespace

void drawLightHandle(const LightHandle& handle, vec3 color, bool isChosen) {
    const vec2 place = handle.place;
    vec3 shown;
    const float brightest = std::max({color.r, color.g, color.b, 1e-6f});
    for (int i = 0; i < 3; ++i)
        shown[i] = srgbFromLinear(std::clamp(color[i] / brightest, 0.0f, 1.0f));
    const ImU32 ink = ImGui::ColorConvertFloat4ToU32({shown.x, shown.y, shown.z, 1});
    const ImU32 shadow = IM_COL32(0, 0, 0, 120);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddCircle({place.x, place.y}, kRing, shadow, 32, 4);
    list.AddCircle({place.x, place.y}, kRing, ink, 32, 2);
    if (isChosen) list.AddCircle({place.x, place.y}, kRing + 4, ink, 32, 1.5f);
    if (!handle.towards) {
        list.AddCircleFilled({place.x, place.y}, kDot + 1, shadow, 24);
        list.AddCircleFilled({place.x, place.y}, kDot, ink, 24);
        return;
    }
    const vec2 along = *handle.towards, aside(-along.y, along.x);
    const auto triangle = [&](float size, ImU32 color) {
        const vec2 tip = place + along * size * 1.2f,
                   left = place - along * size * 0.7f + aside * size * 0.6f,
                   right = place - along * size * 0.7f - aside * size * 0.6f;
        list.AddTriangleFilled({tip.x, tip.y}, {left.x, left.y}, {right.x, right.y}, color);
    };
    triangle(kArrow + 2, shadow);
    triangle(kArrow, ink);
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

bool drawHelp(Hand hand, vec2 picture, const Theme& theme) {
    const std::size_t lines = std::size(kReliefHelp) + std::size(kHelp);
    const vec2 size(std::min(470.0f, picture.x - 2 * kMargin), float(lines) * kLine + 2 * kPadding);
    const vec2 at = glm::max((picture - size) / 2.0f, vec2(kMargin));
    beginCard("help", at, size, theme.cardBorder);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    float y = at.y + kPadding + (kLine - kText) / 2;
    const auto write = [&](std::span<const HelpLine> part) {
        for (const HelpLine& line : part) {
            list.AddText({at.x + kPadding, y}, theme.accent, line.keys);
            list.AddText({at.x + kPadding + kKeyColumn, y}, theme.text, line.does);
            y += kLine;
        }
    };
    constexpr std::span<const HelpLine> kOfHands[] = {kReliefHelp, kOrbitHelp, kPaintHelp};
    write(kOfHands[int(hand)]);
    write(kHelp);
    const bool closed = closeButton({at.x + size.x, at.y}, theme);
    ImGui::End();
    return closed;
}

void drawLine(const std::string& text, vec2 picture, const Theme& theme) {
    const vec2 size(ImGui::CalcTextSize(text.c_str()).x + 20, 28);
    const ImVec2 low(kMargin, picture.y - kMargin - size.y);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddRectFilled(low, {low.x + size.x, low.y + size.y}, theme.card, kRound);
    list.AddText({low.x + 10, low.y + (size.y - kText) / 2}, theme.text, text.c_str());
}

void drawStats(const frame::Stats& stats, vec2 picture, const Theme& theme) {
    char cost[128];
    std::snprintf(cost, sizeof cost, "%.1f ms · %d passes · %d draws · %d %s · %s", stats.milliseconds,
                  stats.passes, stats.draws, stats.lights, stats.lights == 1 ? "light" : "lights",
                  bytesText(stats.bytes).c_str());
    drawLine(stats.settings.empty() ? cost : stats.settings + " · " + cost, picture, theme);
}

void drawDivider(float x, Rect picture, const SideNames& names, bool lively, const Theme& theme) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const float middle = (picture.low.y + picture.high.y) / 2, half = lively ? 2.0f : 1.0f;
    list.AddRectFilled({x - half - 1, picture.low.y}, {x + half + 1, picture.high.y}, IM_COL32(0, 0, 0, 110));
    list.AddRectFilled({x - half, picture.low.y}, {x + half, picture.high.y}, IM_COL32_WHITE);
    list.AddCircleFilled({x, middle}, kHandle + 1, IM_COL32(0, 0, 0, 110));
    list.AddCircleFilled({x, middle}, kHandle, lively ? theme.accent : IM_COL32_WHITE);
    const ImU32 ink = lively ? theme.onAccent : IM_COL32(40, 40, 40, 255);
    for (const float side : {-1.0f, 1.0f})
        list.AddTriangleFilled({x + side * 9, middle}, {x + side * 4, middle - 4.5f},
                               {x + side * 4, middle + 4.5f}, ink);
    label(list, names.left, {x - 10, picture.low.y + kMargin}, 1, picture);
    label(list, names.right, {x + 10, picture.low.y + kMargin}, 0, picture);
}

void drawNotice(std::string_view text, Rect room, const Theme& theme) {
    constexpr float kLeastWidth = 90, kMostWidth = 280;
    const float inner = std::min(kMostWidth, room.high.x - room.low.x - 2 * kMargin - 24);
    if (inner < kLeastWidth) return;
    const ImVec2 measured = wrappedSize(text, inner);
    const vec2 size(measured.x + 24, measured.y + 20);
    const vec2 low = (room.low + room.high - size) / 2.0f, high = low + size;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddRectFilled({low.x, low.y}, {high.x, high.y}, theme.card, kRound);
    list.AddText(nullptr, 0, {low.x + 12, low.y + 10}, theme.text, text.data(), text.data() + text.size(),
                 inner);
}

float drawNumbersCard(const std::string& text, const std::optional<ScaleEnds>& scale, vec2 room,
                      const Theme& theme) {
    const float most = room.x - 2 * kMargin - 20;
    const float bar = scale ? kScaleBar + 8 : 0;
    const ImVec2 measured = wrappedSize(text, most);
    const vec2 size(std::min(most, measured.x) + 20, measured.y + 16 + bar);
    const vec2 low(kMargin, room.y - kMargin - size.y);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    list.AddRectFilled({low.x, low.y}, {low.x + size.x, low.y + size.y}, theme.card, kRound);
    list.AddText(nullptr, 0, {low.x + 10, low.y + 8 + bar}, theme.text, text.data(),
                 text.data() + text.size(), most);
    if (scale) drawScale(list, low + vec2(10, 8), std::min(220.0f, size.x - 20), *scale, theme);
    return low.y;
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
