// Frames of ImGui: the panel and what lies over the picture.
#include "viewer/State.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace lucent::viewer {

namespace {

constexpr double kTooltipAfter = 0.5; // s

// Keys that a text field of ImGui knows, by KeyboardEvent.key.
int textKey(std::string_view key) {
    struct Known {
        std::string_view name;
        ImGuiKey key;
    };
    static constexpr Known known[] = {{"ArrowLeft", ImGuiKey_LeftArrow},
                                      {"ArrowRight", ImGuiKey_RightArrow},
                                      {"Home", ImGuiKey_Home},
                                      {"End", ImGuiKey_End},
                                      {"Delete", ImGuiKey_Delete},
                                      {"Backspace", ImGuiKey_Backspace},
                                      {"Enter", ImGuiKey_Enter},
                                      {"Escape", ImGuiKey_Escape},
                                      {"a", ImGuiKey_A},
                                      {"c", ImGuiKey_C},
                                      {"v", ImGuiKey_V},
                                      {"x", ImGuiKey_X},
                                      {"y", ImGuiKey_Y},
                                      {"z", ImGuiKey_Z}};
    for (const Known& one : known)
        if (one.name == key) return one.key;
    return -1;
}

std::uint64_t mixed(std::uint64_t hash, const void* data, int bytes) { // FNV-1a, of words in place of bytes
    const auto* at = static_cast<const unsigned char*>(data);
    for (std::uint32_t word = 0; bytes > 0; at += sizeof word, bytes -= int(sizeof word)) {
        std::memcpy(&word, at, std::min(sizeof word, std::size_t(bytes)));
        hash = (hash ^ word) * 1099511628211u;
    }
    return hash;
}

// Tells whether a frame of ImGui looks like another one.
std::uint64_t hashOf(const ImDrawData& data) {
    std::uint64_t hash = 14695981039346656037u;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        hash = mixed(hash, list.VtxBuffer.Data, list.VtxBuffer.size_in_bytes());
        hash = mixed(hash, list.IdxBuffer.Data, list.IdxBuffer.size_in_bytes());
        for (const ImDrawCmd& command : list.CmdBuffer)
            hash = mixed(hash, &command.ClipRect, sizeof command.ClipRect);
    }
    return hash;
}

} // namespace

void Viewer::State::useImGui(Modifiers modifiers) {
    ImGui::SetCurrentContext(imgui);
    ImGuiIO& io = ImGui::GetIO();
    io.KeyShift = modifiers.shift;
    io.KeyCtrl = modifiers.control;
    io.KeyAlt = modifiers.alt;
}

// One frame of ImGui: what was done in the panel takes effect, nothing is drawn yet.
void Viewer::State::frame() {
    if (pixels.x <= 0 || pixels.y <= 0) return;
    ImGui::SetCurrentContext(imgui);
    ImGuiIO& io = ImGui::GetIO();
    const double now = secondsNow();
    io.DeltaTime = float(std::clamp(now - frameTime, 1e-4, 1.0));
    frameTime = now;
    io.DisplaySize = {canvas().x, canvas().y};
    io.DisplayFramebufferScale = {scale, scale};
    fonts().select(scale);
    panel.setCanvas(canvas());

    const bool isSeen = scene && shownScene == sceneNumber; // the preview comes first
    if (isSeen && !pictureNext && (figuresAt != revision || figuresPend)) {
        figures = allFigures();
        figuresAt = revision;
        figuresPend = std::erase_if(figures, [](const Figure& figure) { return figure.isPending; }) > 0;
    }
    ImGui::NewFrame();
    std::vector<Edit> edits;
    if (scene)
        edits = panel.draw({.title = scene->title,
                            .controls = controls,
                            .actions = actions(),
                            .figures = figures,
                            .focus = focus == "divider" ? "" : focus, // which is not in the panel
                            .canvas = canvas(),
                            .touch = touch},
                           theme(dark));
    overlays();
    ImGui::Render();
    settled = false;
    for (const Edit& edit : edits)
        if (edit.kind == Edit::Kind::Reset) {
            reset(edit.path);
        } else if (Status done = edit.kind == Edit::Kind::Act
                                     ? act(edit.path)
                                     : change(edit.path, edit.text, burst(edit.path));
                   !done) {
            message = done.error().message;
        }
}

void Viewer::State::overlays() {
    const vec2 size = pictureSize();
    if (scene && scene->view.lightDot && !bare)
        for (std::size_t i = 0; i < scene->lights.size(); ++i)
            drawLightHandle(handleOf(i), colorOf(scene->lights[i]), i == light && scene->lights.size() > 1);
    cardTop.reset();
    compareOverlay();
    energyOverlay();
    if (bare) return;
    paintOverlay();
    if (showStats && renderer && compare.mode == CompareMode::Off) // whose card holds the cost as well
        drawStats(renderer->stats(), openSize(), theme(dark));
    else if (play.playing && shown && downscale > 1)
        drawLine("1/" + std::to_string(downscale) + " resolution while it moves", openSize(), theme(dark));
    const Hand hand = painting() ? Hand::Brush : scene && !hasField() ? Hand::Camera : Hand::Light;
    if (help && drawHelp(hand, size, theme(dark))) help = false;
    if (!message.empty() && drawMessage(message, size, theme(dark))) message.clear();
    if (const Control* control = find(tooltip); control && panel.hovered() == tooltip)
        drawTooltip(control->bound.param->doc, panel.hoveredPlace(), canvas(), theme(dark));
}

std::uint64_t Viewer::State::frameHash() const {
    return ImGui::GetDrawData() ? hashOf(*ImGui::GetDrawData()) : 0;
}

// ImGui lays out after what it measured in the frame before: frames until two are alike, or the panel's time
// is up.
void Viewer::State::settle(double until) {
    constexpr int kMostFrames = 5;
    while (settling++ < kMostFrames) {
        frame();
        const std::uint64_t before = std::exchange(lastFrame, frameHash());
        if (lastFrame == before || figuresPend) break; // each frame works some of them out
        if (secondsNow() > until) return;
    }
    settled = !figuresPend;
    settling = 0;
    lastFrame = 0;
}

void Viewer::State::typeKey(const std::string& key, Modifiers modifiers) {
    ImGuiIO& io = ImGui::GetIO();
    const bool isText =
        !modifiers.control && !key.empty() && (key.size() == 1 || (unsigned char)key[0] >= 0x80);
    if (isText) io.AddInputCharactersUTF8(key.c_str());
    const int special = isText ? -1 : textKey(key);
    for (const bool pressed : {true, false}) {
        if (special >= 0) io.KeysDown[special] = pressed;
        frame();
    }
}

// Shows a tooltip after a short rest on a control. @return seconds until then, 0 when nothing is awaited
double Viewer::State::tooltipWait(double now) {
    if (panel.hovered() != hovered) {
        hovered = panel.hovered();
        hoverTime = now;
        if (!tooltip.empty()) settled = false;
        tooltip.clear();
    }
    if (hovered.empty() || tooltip == hovered) return 0;
    if (now - hoverTime < kTooltipAfter) return kTooltipAfter - (now - hoverTime);
    tooltip = hovered;
    settled = false;
    return 0;
}

} // namespace lucent::viewer
