#include "viewer/Panel.h"

#include "viewer/Compare.h"
#include "viewer/ValueText.h"

#include <imgui_internal.h> // who is active

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

namespace lucent::viewer {

using namespace layout;

namespace {

constexpr float kTrack = 4, kKnob = 7;           // thickness and radius
constexpr vec2 kSwitch{34, 18}, kSwatch{34, 18}; // toggle and colour
constexpr float kAxis = 18, kInlineValue = 76;   // letter and value beside the slider of a vector's component
constexpr float kChip = 28, kChipGap = 6;
constexpr float kPickerHeight = 120, kHueBar = 14;

ImVec2 im(vec2 v) { return {v.x, v.y}; }
vec2 glmVec(ImVec2 v) { return {v.x, v.y}; }
float textWidth(std::string_view text) {
    return ImGui::CalcTextSize(text.data(), text.data() + text.size()).x;
}

// --- colours

ImU32 packed(vec3 color) { return ImGui::ColorConvertFloat4ToU32({color.x, color.y, color.z, 1}); }

vec3 rgbFromHsv(vec3 hsv) {
    vec3 rgb;
    ImGui::ColorConvertHSVtoRGB(hsv.x, hsv.y, hsv.z, rgb.x, rgb.y, rgb.z);
    return rgb;
}

vec3 hsvFromRgb(vec3 rgb) {
    vec3 hsv;
    ImGui::ColorConvertRGBtoHSV(rgb.x, rgb.y, rgb.z, hsv.x, hsv.y, hsv.z);
    return hsv;
}

// Groups in the order in which their controls come.
std::vector<Group> groupsOf(std::span<const Control> controls) {
    std::vector<Group> groups;
    for (const Control& control : controls) {
        const Group group = control.bound.group();
        if (group != Group::None && std::find(groups.begin(), groups.end(), group) == groups.end())
            groups.push_back(group);
    }
    return groups;
}

} // namespace

// "objects.coin" is called coin, its first layer "coin, layer 1", "lights.1" is called light 2, settings of
// the picture beside it by their place, a technique as its table says.
std::string ownerOf(const BoundParam& bound) {
    std::string_view path = bound.path;
    const bool isBeside = path.starts_with(kBeside);
    if (isBeside) path.remove_prefix(kBeside.size());
    const std::size_t start = path.find('.') + 1;
    const std::string name(path.substr(start, path.find('.', start) - start));
    if (isBeside && isOfRight(CompareMode::Materials, path)) return besideOwner(name);
    if (isBeside) return "right of the divider";
    if (path.starts_with("objects."))
        return bound.label.empty() ? name : name + ", " + std::string(bound.label);
    if (path.starts_with("lights.")) return "light " + std::to_string(std::atoi(name.c_str()) + 1);
    return std::string(bound.label);
}

std::string headingOf(const Control& control, std::span<const Control> controls) {
    const std::string owner = ownerOf(control.bound);
    const bool several = std::any_of(controls.begin(), controls.end(), [&](const Control& other) {
        return other.bound.group() == control.bound.group() && ownerOf(other.bound) != owner;
    });
    return several ? owner : "";
}

// --- one frame

class Panel::Frame {
public:
    Frame(Panel& panel, const PanelInput& input, const Theme& theme)
        : panel_(panel), input_(input), theme_(theme) {}
    std::vector<Edit> draw();

private:
    void header(Rect place);
    void body(Rect place);
    bool groupHeading(Group group);
    void groupControls(Group group);
    void groupActions(Group group);
    void ownerHeading(const std::string& owner);
    void figureOf(const std::string& owner, Group group);
    void control(const Control& control);
    void editor(const Control& control);

    void labelLine(const Control& control, const std::string& value, int component, float rightInset = 0);
    void resetMark(const Control& control, vec2 at);
    void number(const Control& control);
    void vector(const Control& control);
    void range(const Control& control);
    void toggle(const Control& control);
    void choice(const Control& control);
    void color(const Control& control);
    void picker(const Control& control);
    void slider(const Control& control, int component, vec2 at, float width);

    void value(const Control& control, int component, const std::string& text, vec2 right);
    void startTyping(const Control& control, int component);
    void typedValue(const Control& control, vec2 right);
    bool heldArea(const char* id, vec2 at, vec2 size, vec2& t);
    bool button(const char* id, vec2 at, vec2 size);
    void scrollByFinger();

    void text(vec2 at, ImU32 color, std::string_view text) {
        list_->AddText(im(at), color, text.data(), text.data() + text.size());
    }
    void track(vec2 at, float width, float from, float to);
    void knob(vec2 center, bool lively);
    void chevron(vec2 center, vec2 towards);
    // The next `height` pixels of the column.
    vec2 take(float height) {
        const vec2 at = glmVec(ImGui::GetCursorScreenPos());
        ImGui::Dummy({width_, height});
        return at;
    }
    void seen(std::string_view path, vec2 low, vec2 high);
    void edit(const Control& control, std::string text) {
        edits_.push_back({control.bound.path, std::move(text), Edit::Kind::Set});
    }
    void editComponent(const Control& control, int component, const std::string& text) {
        edit(control, withComponent(control.bound, component, text));
    }

    Panel& panel_;
    const PanelInput& input_;
    const Theme& theme_;
    ImDrawList* list_ = nullptr;
    float width_ = 0;
    Rect clip_;
    std::vector<Edit> edits_;
};

std::vector<Edit> Panel::draw(const PanelInput& input, const Theme& theme) {
    widgets_.clear();
    hovered_.clear();
    if (!visible_ || input.controls.empty()) return {};
    return Frame(*this, input, theme).draw();
}

void Panel::setCanvas(vec2 canvas) {
    const bool sheet = canvas.x < kSheetBelow;
    if (sheet != sheet_) collapsed_ = sheet;
    sheet_ = sheet;
}

Rect Panel::place(vec2 canvas) const {
    if (sheet_) {
        const float height = collapsed_ ? kHeader : std::max(kHeader, std::min(kSheet, canvas.y / 2));
        return {{0, canvas.y - height}, canvas};
    }
    const vec2 low(canvas.x - kPanel - kMargin, kMargin);
    return {low, {canvas.x - kMargin, collapsed_ ? low.y + kHeader : canvas.y - kMargin}};
}

vec2 Panel::pictureSize(vec2 canvas) const {
    if (!visible_ || sheet_ || collapsed_) return canvas;
    return {canvas.x - kPanel - 2 * kMargin, canvas.y};
}

vec2 Panel::openSize(vec2 canvas) const {
    const vec2 size = pictureSize(canvas);
    return visible_ && sheet_ ? vec2(size.x, place(canvas).low.y) : size;
}

std::vector<Edit> Panel::Frame::draw() {
    if (panel_.seenFocus_ != input_.focus && !input_.focus.empty()) panel_.collapsed_ = false;
    const Rect place = panel_.place(input_.canvas);
    ImGui::SetNextWindowPos(im(place.low));
    ImGui::SetNextWindowSize(im(place.high - place.low));
    ImGui::Begin("panel", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoSavedSettings);
    list_ = ImGui::GetWindowDrawList();
    list_->AddRect(im(place.low), im(place.high), theme_.cardBorder, kRound);
    header(place);
    panel_.scroll_ = vec2(0);
    if (!panel_.collapsed_) body(place);
    ImGui::End();
    panel_.seenFocus_ = input_.focus;
    return std::move(edits_);
}

void Panel::Frame::header(Rect place) {
    const float middle = place.low.y + kHeader / 2;
    if (button("header", place.low, {place.high.x - place.low.x, kHeader}))
        panel_.collapsed_ = !panel_.collapsed_;
    const vec2 end(place.high.x - kPadding - 20, place.low.y + kHeader);
    list_->PushClipRect(im(place.low), im(end), true);
    text({place.low.x + kPadding, middle - kText / 2}, theme_.text,
         input_.title.empty() ? "Controls" : input_.title);
    list_->PopClipRect();
    chevron({place.high.x - kPadding - 6, middle},
            panel_.collapsed_ == panel_.sheet_ ? vec2(0, -1) : vec2(0, 1));
}

void Panel::Frame::body(Rect place) {
    const vec2 low(place.low.x, place.low.y + kHeader);
    list_->AddLine({low.x, low.y}, {place.high.x, low.y}, theme_.cardBorder);
    ImGui::SetCursorScreenPos(im(low));
    ImGui::BeginChild("body", im(place.high - low), false, ImGuiWindowFlags_NoNav);
    list_ = ImGui::GetWindowDrawList();
    clip_ = {low, place.high};
    width_ = place.high.x - low.x - 2 * kPadding;
    ImGui::Indent(kPadding);
    for (const Group group : groupsOf(input_.controls))
        if (groupHeading(group)) groupControls(group);
    take(kPadding);
    scrollByFinger();
    panel_.scroll_ = {ImGui::GetScrollY(), ImGui::GetScrollMaxY()};
    ImGui::EndChild();
}

// A finger that holds nothing drags the column.
void Panel::Frame::scrollByFinger() {
    const ImGuiID active = ImGui::GetActiveID();
    const bool holdsWidget = active != 0 && active != ImGui::GetCurrentWindowRead()->MoveId;
    if (!input_.touch || holdsWidget || !ImGui::IsMouseDown(0)) return;
    if (ImGui::IsMouseHoveringRect(im(clip_.low), im(clip_.high), false))
        ImGui::SetScrollY(ImGui::GetScrollY() - ImGui::GetIO().MouseDelta.y);
}

bool Panel::Frame::groupHeading(Group group) {
    bool& folded = panel_.folded_[std::size_t(group)];
    for (const Control& c : input_.controls)
        if (c.bound.path == input_.focus && panel_.seenFocus_ != input_.focus && c.bound.group() == group)
            folded = false;
    const vec2 at = take(40);
    if (button(name(group).data(), {at.x - kPadding, at.y}, {width_ + 2 * kPadding, 40})) folded = !folded;
    text({at.x, at.y + 20 - kText / 2}, theme_.text, name(group));
    chevron({at.x + width_ - 6, at.y + 20}, folded ? vec2(1, 0) : vec2(0, 1));
    return !folded;
}

void Panel::Frame::groupControls(Group group) {
    std::string before, owner;
    for (const Control& c : input_.controls) {
        if (c.bound.group() != group) continue;
        if (ownerOf(c.bound) != owner) figureOf(owner, group);
        owner = ownerOf(c.bound);
        const std::string heading = headingOf(c, input_.controls);
        if (heading != before && !heading.empty()) ownerHeading(heading);
        before = heading;
        control(c);
    }
    figureOf(owner, group);
    groupActions(group);
    const vec2 at = take(kGap);
    list_->AddLine({at.x, at.y + kGap - 1}, {at.x + width_, at.y + kGap - 1}, theme_.cardBorder);
}

void Panel::Frame::groupActions(Group group) {
    const vec2 start = glmVec(ImGui::GetCursorScreenPos());
    vec2 at = start;
    for (const Action& action : input_.actions) {
        if (action.group != group) continue;
        const vec2 size(textWidth(action.label) + 20, kChip);
        if (at.x > start.x && at.x + size.x > start.x + width_) at = {start.x, at.y + kChip + kChipGap};
        list_->AddRectFilled(im(at), im(at + size), theme_.track, kRound);
        if (button(action.path.data(), at, size))
            edits_.push_back({std::string(action.path), "", Edit::Kind::Act});
        if (action.path == input_.focus)
            list_->AddRect(im(at - vec2(2)), im(at + size + vec2(2)), theme_.accentFaint, kRound, 0, 2);
        text({at.x + 10, at.y + (kChip - kText) / 2 - 1}, theme_.text, action.label);
        seen(action.path, at, at + size);
        at.x += size.x + kChipGap;
    }
    if (at != start) take(at.y + kChip + kGap - start.y);
}

void Panel::Frame::ownerHeading(const std::string& owner) {
    const vec2 at = take(kLine);
    text({at.x, at.y + 4}, theme_.accent, owner);
}

void Panel::Frame::figureOf(const std::string& owner, Group group) {
    for (const Figure& figure : input_.figures)
        if (figure.owner == owner && figure.place == group) {
            const vec2 at = take(figure.height);
            // Lines of a dozen figures that are scrolled out of sight would be more than a list can number.
            if (ImGui::IsRectVisible(im(at), im(at + vec2(width_, figure.height))))
                figure.draw(*list_, at, width_, theme_);
            take(kGap);
        }
}

void Panel::Frame::control(const Control& control) {
    ImGui::PushID(control.bound.path.c_str());
    const vec2 low = glmVec(ImGui::GetCursorScreenPos()) - vec2(8, 4);
    editor(control);
    const vec2 high = glmVec(ImGui::GetCursorScreenPos()) + vec2(width_ + 8, 4);
    take(kGap);
    if (control.bound.path == input_.focus) {
        list_->AddRect(im(low), im(high), theme_.accentFaint, kRound, 0, 2);
        const bool outside = low.y < clip_.low.y || high.y > clip_.high.y;
        if (outside && panel_.seenFocus_ != input_.focus)
            ImGui::SetScrollFromPosY((low.y + high.y) / 2 - ImGui::GetWindowPos().y, 0.5f);
    }
    const bool under = ImGui::IsMouseHoveringRect(im(low), im(high)) && ImGui::IsWindowHovered();
    if (under && !ImGui::IsMouseDown(0) && panel_.typing_.path.empty()) {
        panel_.hovered_ = control.bound.path;
        panel_.hoveredPlace_ = {low, high};
    }
    ImGui::PopID();
}

void Panel::Frame::editor(const Control& control) {
    switch (control.bound.param->kind) {
    case Kind::Number:
    case Kind::Integer:
        return number(control);
    case Kind::Toggle:
        return toggle(control);
    case Kind::Choice:
        return choice(control);
    case Kind::Color:
        return color(control);
    case Kind::Vector:
    case Kind::Pair:
        return vector(control);
    case Kind::Range:
        return range(control);
    }
}

// --- lines and marks

void Panel::Frame::labelLine(const Control& control, const std::string& valueText, int component,
                             float rightInset) {
    const vec2 at = take(kLine);
    const std::string_view label = control.bound.param->label;
    text({at.x, at.y + 5}, theme_.muted, label);
    if (getText(*control.bound.param, control.bound.data) != control.loaded)
        resetMark(control, {at.x + textWidth(label) + 14, at.y + kLine / 2});
    if (!valueText.empty()) value(control, component, valueText, {at.x + width_ - rightInset, at.y + 5});
}

// An arrow that turns back, drawn because it must look the same in every type size.
void Panel::Frame::resetMark(const Control& control, vec2 at) {
    if (button("reset", at - vec2(11), vec2(22)))
        edits_.push_back({control.bound.path, control.loaded, Edit::Kind::Reset});
    const ImU32 ink = ImGui::IsItemHovered() ? theme_.text : theme_.accent;
    list_->PathArcTo(im(at), 4.5f, -2.2f, 3.0f, 16);
    list_->PathStroke(ink, 0, 1.5f);
    const vec2 tip = at + 4.5f * vec2(std::cos(-2.2f), std::sin(-2.2f));
    list_->AddTriangleFilled(im(tip + vec2(-3.2f, 2.2f)), im(tip + vec2(-1.6f, -3.6f)),
                             im(tip + vec2(3.2f, 0.6f)), ink);
}

void Panel::Frame::track(vec2 at, float width, float from, float to) {
    const vec2 low(at.x, at.y + (kSlider - kTrack) / 2), high(at.x + width, low.y + kTrack);
    list_->AddRectFilled(im(low), im(high), theme_.track, kTrack / 2);
    list_->AddRectFilled({low.x + from * width, low.y}, {low.x + to * width, high.y}, theme_.accent,
                         kTrack / 2);
}

void Panel::Frame::knob(vec2 center, bool lively) {
    list_->AddCircleFilled(im(center + vec2(0, 1)), kKnob + 1, IM_COL32(0, 0, 0, 50));
    list_->AddCircleFilled(im(center), lively ? kKnob + 1 : kKnob, theme_.knob);
    list_->AddCircle(im(center), lively ? kKnob + 1 : kKnob, theme_.accent, 0, 2);
}

void Panel::Frame::chevron(vec2 center, vec2 towards) {
    const vec2 along = 4.0f * vec2(towards.y, towards.x), across = 2.0f * towards;
    const ImVec2 points[] = {im(center - along - across), im(center + across), im(center + along - across)};
    list_->AddPolyline(points, 3, theme_.muted, 0, 1.5f);
}

bool Panel::Frame::button(const char* id, vec2 at, vec2 size) {
    const ImVec2 cursor = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos(im(at));
    const bool pressed = ImGui::InvisibleButton(id, im(size));
    if (ImGui::IsItemHovered()) list_->AddRectFilled(im(at), im(at + size), theme_.hover, kRound);
    ImGui::SetCursorScreenPos(cursor);
    return pressed;
}

// A surface that follows the pointer while it is held; t is the pointer's place on it.
bool Panel::Frame::heldArea(const char* id, vec2 at, vec2 size, vec2& t) {
    const ImVec2 cursor = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos(im(at));
    ImGui::InvisibleButton(id, im(size));
    ImGui::SetCursorScreenPos(cursor);
    t = glm::clamp((glmVec(ImGui::GetIO().MousePos) - at) / size, vec2(0), vec2(1));
    return ImGui::IsItemActive();
}

void Panel::Frame::seen(std::string_view path, vec2 low, vec2 high) {
    if (low.y >= clip_.low.y && high.y <= clip_.high.y) panel_.widgets_[std::string(path)] = {low, high};
}

// --- typing

void Panel::Frame::startTyping(const Control& control, int component) {
    Typing& typing = panel_.typing_;
    typing = {control.bound.path, component};
    const bool hex = control.bound.param->kind == Kind::Color;
    const std::string now =
        hex ? colorText(control.bound) : componentTexts(control.bound)[std::size_t(component)];
    std::snprintf(typing.text, sizeof typing.text, "%s", now.c_str());
}

void Panel::Frame::value(const Control& control, int component, const std::string& shown, vec2 right) {
    const Typing& typing = panel_.typing_;
    if (typing.path == control.bound.path && typing.component == component) return typedValue(control, right);
    const float width = textWidth(shown);
    ImGui::PushID(component);
    const bool pressed = button("value", {right.x - width - 6, right.y - 3}, {width + 12, kText + 7});
    ImGui::PopID();
    text({right.x - width, right.y}, theme_.text, shown);
    if (pressed) startTyping(control, component);
}

void Panel::Frame::typedValue(const Control& control, vec2 right) {
    Typing& typing = panel_.typing_;
    const float width = control.bound.param->kind == Kind::Color ? 130 : 96;
    const ImVec2 cursor = ImGui::GetCursorScreenPos();
    ImGui::SetCursorScreenPos({right.x - width + 6, right.y - 4});
    ImGui::SetNextItemWidth(width);
    if (typing.frames == 0) ImGui::SetKeyboardFocusHere();
    const bool entered =
        ImGui::InputText("typed", typing.text, sizeof typing.text,
                         ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
    const bool left = ImGui::IsItemDeactivated();
    if (entered || ImGui::IsItemDeactivatedAfterEdit()) editComponent(control, typing.component, typing.text);
    ImGui::SetCursorScreenPos(cursor);
    // The field gets the focus in its second frame.
    if (++typing.frames > 2 && (entered || left || !ImGui::IsItemActive())) typing = {};
}

// --- editors

void Panel::Frame::slider(const Control& control, int component, vec2 at, float width) {
    const Param& param = *control.bound.param;
    const float t = float(placeOf(param, getComponent(param, control.bound.data, component)));
    const bool bipolar = param.low < 0 && param.high > 0;
    const float zero = bipolar ? float(placeOf(param, 0)) : 0;
    track(at, width, std::min(zero, t), std::max(zero, t));
    ImGui::PushID(component);
    vec2 pointer;
    const bool held = heldArea("slider", at, {width, kSlider}, pointer);
    ImGui::PopID();
    const bool lively = held || ImGui::IsItemHovered();
    knob({at.x + t * width, at.y + kSlider / 2}, lively);
    const bool type = ImGui::IsItemClicked() && (ImGui::GetIO().KeyCtrl || ImGui::IsMouseDoubleClicked(0));
    if (type) return startTyping(control, component);
    if (held && !ImGui::GetIO().KeyCtrl) {
        const std::string wanted = valueAt(param, pointer.x);
        if (wanted != valueAt(param, t)) editComponent(control, component, wanted);
    }
}

void Panel::Frame::number(const Control& control) {
    const Param& param = *control.bound.param;
    labelLine(control, withUnit(param, numberText(param, getComponent(param, control.bound.data, 0))), 0);
    const vec2 at = take(kSlider);
    slider(control, 0, at, width_);
    seen(control.bound.path, at, at + vec2(width_, kSlider));
}

void Panel::Frame::vector(const Control& control) {
    const Param& param = *control.bound.param;
    labelLine(control, "", 0);
    const vec2 start = glmVec(ImGui::GetCursorScreenPos());
    const float sliderWidth = width_ - kAxis - kInlineValue;
    const int count = componentCount(param.kind);
    for (int i = 0; i < count; ++i) {
        const vec2 at = take(kLine);
        text({at.x, at.y + 4}, theme_.muted, param.axes.substr(std::size_t(i), 1));
        slider(control, i, {at.x + kAxis, at.y + 2}, sliderWidth);
        value(control, i, withUnit(param, numberText(param, getComponent(param, control.bound.data, i))),
              {at.x + width_, at.y + 4});
    }
    seen(control.bound.path, start + vec2(kAxis, 0), start + vec2(kAxis + sliderWidth, float(count) * kLine));
}

void Panel::Frame::range(const Control& control) {
    const Param& param = *control.bound.param;
    const double low = getComponent(param, control.bound.data, 0),
                 high = getComponent(param, control.bound.data, 1);
    const float rightInset = textWidth(" – " + numberText(param, high));
    labelLine(control, numberText(param, low), 0, rightInset);
    const vec2 at = take(kSlider);
    const float right = at.x + width_, line = at.y - kLine + 5;
    text({right - rightInset, line}, theme_.muted, " –");
    value(control, 1, numberText(param, high), {right, line});

    const float a = float(placeOf(param, low)), b = float(placeOf(param, high));
    track(at, width_, a, b);
    vec2 pointer;
    const bool held = heldArea("range", at, {width_, kSlider}, pointer);
    const bool lively = ImGui::IsItemHovered();
    if (ImGui::IsItemActivated()) panel_.handle_ = pointer.x > (a + b) / 2 ? 1 : 0;
    knob({at.x + a * width_, at.y + kSlider / 2}, lively);
    knob({at.x + b * width_, at.y + kSlider / 2}, lively);
    seen(control.bound.path, at, at + vec2(width_, kSlider));
    if (!held) return;
    // An end stops at the other one.
    const float t = panel_.handle_ ? std::max(pointer.x, a) : std::min(pointer.x, b);
    const std::string wanted = valueAt(param, t);
    const double other = panel_.handle_ ? low : high, mine = std::strtod(wanted.c_str(), nullptr);
    const bool crossed = panel_.handle_ ? mine < other : mine > other;
    if (wanted != valueAt(param, panel_.handle_ ? b : a))
        editComponent(control, panel_.handle_,
                      crossed ? componentTexts(control.bound)[panel_.handle_ ? 0 : 1] : wanted);
}

void Panel::Frame::toggle(const Control& control) {
    const bool on = getComponent(*control.bound.param, control.bound.data, 0) != 0;
    labelLine(control, "", 0);
    const vec2 end = glmVec(ImGui::GetCursorScreenPos()) + vec2(width_, 0);
    const vec2 at(end.x - kSwitch.x, end.y - (kLine + kSwitch.y) / 2);
    list_->AddRectFilled(im(at), im(at + kSwitch), on ? theme_.accent : theme_.track, kSwitch.y / 2);
    const float r = kSwitch.y / 2;
    list_->AddCircleFilled({on ? at.x + kSwitch.x - r : at.x + r, at.y + r}, r - 3, theme_.knob);
    if (button("toggle", at, kSwitch)) edit(control, on ? "false" : "true");
    seen(control.bound.path, at, at + kSwitch);
}

void Panel::Frame::choice(const Control& control) {
    const Param& param = *control.bound.param;
    const std::string chosen = getText(param, control.bound.data);
    labelLine(control, "", 0);
    vec2 at = glmVec(ImGui::GetCursorScreenPos());
    const vec2 start = at;
    for (std::size_t i = 0; i < control.choices.size(); ++i) {
        const std::string_view option = control.choices[i];
        const float width = textWidth(option) + 20;
        if (at.x > start.x && at.x + width > start.x + width_) at = {start.x, at.y + kChip + kChipGap};
        const bool on = option == chosen;
        list_->AddRectFilled(im(at), {at.x + width, at.y + kChip}, on ? theme_.accent : theme_.track, kRound);
        ImGui::PushID(int(i));
        if (button("option", at, {width, kChip}) && !on) edit(control, std::string(option));
        ImGui::PopID();
        text({at.x + 10, at.y + (kChip - kText) / 2 - 1}, on ? theme_.onAccent : theme_.text, option);
        at.x += width + kChipGap;
    }
    take(at.y + kChip - start.y);
    seen(control.bound.path, start, {start.x + width_, at.y + kChip});
}

void Panel::Frame::color(const Control& control) {
    labelLine(control, colorText(control.bound), -1, kSwatch.x + 10);
    const vec2 end = glmVec(ImGui::GetCursorScreenPos()) + vec2(width_, 0);
    const vec2 at(end.x - kSwatch.x, end.y - (kLine + kSwatch.y) / 2);
    const bool open = panel_.picker_ == control.bound.path;
    list_->AddRectFilled(im(at), im(at + kSwatch), packed(encoded(control.bound)), kRound);
    list_->AddRect(im(at), im(at + kSwatch), open ? theme_.accent : theme_.cardBorder, kRound, 0,
                   open ? 2.0f : 1.0f);
    if (button("swatch", at, kSwatch)) panel_.picker_ = open ? "" : control.bound.path;
    seen(control.bound.path, at, at + kSwatch);
    if (open) picker(control);
}

void Panel::Frame::picker(const Control& control) {
    const vec3 now = encoded(control.bound);
    vec3& hsv = panel_.pickerHsv_; // remembers the hue of greys and the saturation of black
    if (glm::any(glm::greaterThan(glm::abs(rgbFromHsv(hsv) - now), vec3(0.01f)))) hsv = hsvFromRgb(now);
    take(6);
    const vec2 square = take(kPickerHeight), squareSize(width_, kPickerHeight);
    take(8);
    const vec2 bar = take(kHueBar), barSize(width_, kHueBar);

    const ImU32 white = IM_COL32_WHITE, black = IM_COL32_BLACK, clear = IM_COL32_BLACK_TRANS;
    const ImU32 pure = packed(rgbFromHsv({hsv.x, 1, 1}));
    list_->AddRectFilledMultiColor(im(square), im(square + squareSize), white, pure, pure, white);
    list_->AddRectFilledMultiColor(im(square), im(square + squareSize), clear, clear, black, black);
    for (int i = 0; i < 6; ++i) {
        const ImU32 left = packed(rgbFromHsv({float(i) / 6, 1, 1})),
                    right = packed(rgbFromHsv({float(i + 1) / 6, 1, 1}));
        list_->AddRectFilledMultiColor({bar.x + width_ * float(i) / 6, bar.y},
                                       {bar.x + width_ * float(i + 1) / 6, bar.y + kHueBar}, left, right,
                                       right, left);
    }
    vec2 t;
    const bool inSquare = heldArea("square", square, squareSize, t);
    if (inSquare) hsv = {hsv.x, t.x, 1 - t.y};
    const bool inBar = heldArea("hue", bar, barSize, t);
    if (inBar) hsv.x = std::min(t.x, 0.9999f); // 1 would be 0 again
    knob(square + squareSize * vec2(hsv.y, 1 - hsv.z), inSquare);
    knob(bar + barSize * vec2(hsv.x, 0.5f), inBar);
    if ((inSquare || inBar) && hexText(rgbFromHsv(hsv)) != hexText(now))
        edit(control, hexText(rgbFromHsv(hsv)));
}

} // namespace lucent::viewer
