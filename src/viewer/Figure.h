#pragma once
/// Figures that techniques put into the panel.

#include "scene/Scene.h"
#include "viewer/Theme.h"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lucent::viewer {

/// One figure, below the controls of an object.
struct Figure {
    std::string owner; ///< the object's name
    std::string text;  ///< the same for those who cannot see it
    float height;      ///< CSS pixels
    /// Its numbers: a JSON object with "owner" and "text".
    std::function<std::string()> json;
    /// Draws it at a place [CSS pixels], so wide. Needs a current ImGui window.
    std::function<void(ImDrawList&, vec2, float, const Theme&)> draw;
    Group place = Group::Subsurface; ///< among whose controls it stands
    bool isPending = false;          ///< is to be asked for again: it takes longer; there is its owner alone
};

/// What a technique adds to the panel.
struct PanelPart {
    /// Figures of the visible objects that have any, in the scene's order.
    ///
    /// @param ms  after which those that are not worked out yet are pending; one more is each time
    std::vector<Figure> (*figures)(const scene::Scene&, double ms);
};
/// Those of all techniques that are built in; the list is made by CMake.
std::span<const PanelPart* const> panelParts();

/// All figures of a scene, some of them pending.
std::vector<Figure> figuresOf(const scene::Scene& scene, double ms);
/// JSON array of them; {"owner", "pending": true} of those that are pending.
///
/// @param numbers  false: "owner" and "text" alone, which take no time
std::string figuresJson(const std::vector<Figure>& figures, bool numbers);

} // namespace lucent::viewer
