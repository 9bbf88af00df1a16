#include "viewer/Theme.h"

#include "viewer/FontData.h"

namespace lucent::viewer {

namespace {

// What scripts/embed_font.py leaves in the font beside ASCII.
constexpr ImWchar kGlyphs[] = {0x20,   0x7e,   0xa0,   0xff,   0x3bb,  0x3c3, 0x2010,
                               0x2027, 0x2190, 0x2193, 0x21ba, 0x21ba, 0};
constexpr float kFine = 2; // pixels a CSS pixel for which the finer cut is made

constexpr Theme kLight{
    .card = IM_COL32(252, 251, 249, 236),
    .cardBorder = IM_COL32(40, 34, 24, 34),
    .text = IM_COL32(36, 34, 31, 255),
    .muted = IM_COL32(106, 101, 94, 255),
    .accent = IM_COL32(173, 98, 0, 255),
    .onAccent = IM_COL32(255, 255, 255, 255),
    .accentFaint = IM_COL32(173, 98, 0, 150),
    .track = IM_COL32(60, 50, 36, 36),
    .hover = IM_COL32(60, 50, 36, 16),
    .knob = IM_COL32(255, 255, 255, 255),
    .error = IM_COL32(179, 38, 30, 255),
};

constexpr Theme kDark{
    .card = IM_COL32(27, 27, 30, 232),
    .cardBorder = IM_COL32(255, 255, 255, 34),
    .text = IM_COL32(236, 234, 230, 255),
    .muted = IM_COL32(160, 157, 151, 255),
    .accent = IM_COL32(242, 178, 82, 255),
    .onAccent = IM_COL32(33, 24, 8, 255),
    .accentFaint = IM_COL32(242, 178, 82, 150),
    .track = IM_COL32(255, 250, 240, 40),
    .hover = IM_COL32(255, 250, 240, 16),
    .knob = IM_COL32(245, 243, 240, 255),
    .error = IM_COL32(255, 138, 122, 255),
};

ImFont* cut(ImFontAtlas& atlas, float size) {
    ImFontConfig config;
    config.FontDataOwnedByAtlas = false;
    config.OversampleH = 2;
    config.PixelSnapH = false;
    return atlas.AddFontFromMemoryTTF(const_cast<unsigned char*>(kFontData), int(kFontSize), size, &config,
                                      kGlyphs);
}

ImVec4 unpacked(ImU32 color) { return ImGui::ColorConvertU32ToFloat4(color); }

} // namespace

const Theme& theme(bool dark) { return dark ? kDark : kLight; }

Fonts::Fonts() : plain_(cut(atlas, layout::kText)), fine_(cut(atlas, layout::kText * kFine)) {
    atlas.Flags |= ImFontAtlasFlags_NoMouseCursors;
    atlas.Build();
}

void Fonts::select(float scale) {
    const bool fine = scale > 1.25f;
    ImGuiIO& io = ImGui::GetIO();
    io.FontDefault = fine ? fine_ : plain_;
    io.FontGlobalScale = fine ? 1 / kFine : 1;
    ImGui::GetStyle().CircleTessellationMaxError = 0.2f / scale;
}

Fonts& fonts() {
    static Fonts shared;
    return shared;
}

void applyTheme(const Theme& theme) {
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = style.FrameRounding = style.ScrollbarRounding = layout::kRound;
    style.WindowPadding = {0, 0};
    style.WindowBorderSize = style.ChildBorderSize = 0;
    style.ItemSpacing = {0, 0};
    style.FramePadding = {6, 3};
    style.ScrollbarSize = 8;
    style.WindowMinSize = {1, 1};
    const auto set = [&](ImGuiCol index, ImU32 color) { style.Colors[index] = unpacked(color); };
    set(ImGuiCol_Text, theme.text);
    set(ImGuiCol_WindowBg, theme.card);
    set(ImGuiCol_ChildBg, 0);
    set(ImGuiCol_FrameBg, theme.track);
    set(ImGuiCol_TextSelectedBg, theme.accentFaint);
    set(ImGuiCol_ScrollbarBg, 0);
    set(ImGuiCol_ScrollbarGrab, theme.track);
    set(ImGuiCol_ScrollbarGrabHovered, theme.muted);
    set(ImGuiCol_ScrollbarGrabActive, theme.muted);
}

} // namespace lucent::viewer
