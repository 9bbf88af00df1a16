#pragma once
/// How long a page stands still while it draws a scene.

#include "gl/Context.h"
#include "scene/Scene.h"

#include <span>
#include <string>

namespace lucent::measure {

/// A picture as a viewer makes it: a preview, then the light, then samples of the pixels, step by step; a
/// step is a call of frame::Renderer::advance(). ms of a clock.
struct StepTimes {
    std::string scene;
    int steps = 0;
    double longest = 0;  ///< step
    std::string where;   ///< it was: "preview", "light" or "samples", and its number
    double preview = 0;  ///< until the first picture is there
    double complete = 0; ///< until all light is there
    std::string message; ///< why nothing was measured
};

inline constexpr double kLongestStep = 100, kLongestPreview = 1000; ///< ms: targets

/// @param patience  ms after which the picture is left as it is: its longest steps are its first
StepTimes timeSteps(gl::Context& context, const std::string& name, const scene::Scene& scene,
                    double patience = 20000);

std::string stepsText(std::span<const StepTimes> times);
std::string stepsJson(std::span<const StepTimes> times);

} // namespace lucent::measure
