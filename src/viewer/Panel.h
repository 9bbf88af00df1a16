#pragma once
/// The panel beside the picture, made from parameter descriptors: nothing about a parameter is typed here.

#include "base/Param.h"
#include "viewer/Figure.h"
#include "viewer/Theme.h"

#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lucent::viewer {

/// A parameter of the scene together with the value to which its reset mark goes back.
struct Control {
    BoundParam bound;
    std::string loaded; ///< as text
    std::vector<std::string_view> choices = {bound.param->choices.begin(),
                                             bound.param->choices.end()}; ///< offered
};

/// Whose value a control shows, where several may have one of that label: "coin", "light 2"; "" for all
/// others.
std::string ownerOf(const BoundParam& bound);
/// The same where its group has controls of several; else "".
std::string headingOf(const Control& control, std::span<const Control> controls);

/// What a person did in the panel: the parameter and its new value as text, not yet checked; or an action.
struct Edit {
    enum class Kind { Set, Reset, Act };
    std::string path, text;
    Kind kind = Kind::Set; ///< Reset: back to the value as loaded, which is `text`
};

/// What is done at once: a button.
struct Action {
    std::string_view path, label, doc;
    Group group = Group::Mode; ///< below whose controls it stands
};

/// CSS pixels from the top left corner.
struct Rect {
    vec2 low{0}, high{0};
};

/// What the panel shows in one frame.
struct PanelInput {
    std::string_view title;
    std::span<const Control> controls;
    std::span<const Action> actions;
    std::span<const Figure> figures; ///< each stands below the controls of its object
    std::string_view focus;          ///< path of the control whose twin has the keyboard focus
    vec2 canvas;                     ///< CSS pixels
    bool touch = false;              ///< a finger scrolls by dragging
};

/// Draws and remembers what is open, typed and gripped. Needs a current ImGui context between NewFrame and
/// Render.
class Panel {
public:
    /// @return the edits of this frame, in order
    std::vector<Edit> draw(const PanelInput& input, const Theme& theme);

    bool visible() const { return visible_; }
    void setVisible(bool visible) { visible_ = visible; }
    /// A canvas below layout::kSheetBelow gets a sheet at its bottom, closed until its header is clicked.
    void setCanvas(vec2 canvas);
    /// The part of the canvas that is left for the picture; it starts at the left.
    vec2 pictureSize(vec2 canvas) const;
    /// The part of that over which nothing of the panel lies: a sheet covers the picture's lower end.
    vec2 openSize(vec2 canvas) const;
    /// Whether a wheel over the panel moves its column: not beyond its ends. @param down  towards its lower
    /// end
    bool scrolls(bool down) const { return down ? scroll_.x < scroll_.y : scroll_.x > 0; }
    /// True while a value is being typed: keys belong to the panel.
    bool typing() const { return !typing_.path.empty(); }

    /// Where the widgets of the controls and actions are that can be seen in full, by path. The rows of a
    /// vector share their height equally.
    const std::map<std::string, Rect>& widgets() const { return widgets_; }
    /// Control under the pointer ("" for none) and where it is.
    const std::string& hovered() const { return hovered_; }
    Rect hoveredPlace() const { return hoveredPlace_; }

private:
    class Frame;
    struct Typing {
        std::string path;
        int component = 0; ///< -1: the whole value
        int frames = 0;
        char text[64] = "";
    };
    Rect place(vec2 canvas) const;

    bool visible_ = true, sheet_ = false, collapsed_ = false;
    std::array<bool, std::size_t(Group::View) + 1> folded_{}; // by group
    Typing typing_;
    std::string picker_; ///< path of the colour whose picker is open
    vec3 pickerHsv_{0};
    int handle_ = 0; ///< gripped end of a range
    std::string seenFocus_;
    vec2 scroll_{0}; ///< of the column: pixels, and the most that they can be
    std::map<std::string, Rect> widgets_;
    std::string hovered_;
    Rect hoveredPlace_;
};

} // namespace lucent::viewer
