#pragma once
/// What this device makes of closed forms, and what it can do: the same two tables natively and in a page.

#include "gl/Context.h"
#include "measure/Capabilities.h"
#include "scene/Scene.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lucent::frame {
class Renderer;
}

namespace lucent::measure {

/// Draws the small pictures of the checks.
class Studio {
public:
    explicit Studio(gl::Context& context);
    ~Studio();

    /// Linear values of a scene at its own size, 4 channels. After an error every value is NaN, which no
    /// check accepts, and error() says why.
    Image draw(const scene::Scene& scene, scene::Aov aov = scene::Aov::Illumination);
    /// The same as displayed: exposure, sRGB curve, 8 bits; values in [0,1].
    Image display(const scene::Scene& scene);

    gl::Context& context() { return context_; }
    /// NaN and infinite values in all pictures so far.
    int brokenValues() const { return broken_; }
    /// The first error since the last call, "" when there was none.
    std::string takeError() { return std::exchange(error_, {}); }

private:
    Image take(Result<Image> drawn, ivec2 size);
    gl::Context& context_;
    std::unique_ptr<frame::Renderer> renderer_;
    std::uint64_t revision_ = 0;
    int broken_ = 0;
    std::string error_;
};

/// A value that should be `expected`. Of several it keeps the one that stands farthest from its own.
class Finding {
public:
    void take(double expected, double found);
    double expected() const { return expected_; }
    double found() const { return found_; }

private:
    double expected_ = 0, found_ = 0;
    bool any_ = false;
};

/// How far from the expected value still passes, absolute, and why that far.
struct Tolerance {
    double value;
    std::string_view reason;
};

/// One line of the table.
struct Check {
    std::string_view name;
    std::string_view meaning; ///< the closed form, in words
    Tolerance tolerance;
    Finding (*measure)(Studio& studio);
};

/// Closed forms of a technique.
struct Forms {
    std::span<const Check> checks;
};
/// Those of all techniques that are built in; the list is made by CMake.
std::span<const Forms* const> techniqueForms();
/// The whole table: theirs, then what holds of everything that was drawn.
std::span<const Check> closedForms();

/// What became of a check.
struct CheckResult {
    Check check;
    double expected, found;
    std::string message; ///< why nothing could be measured, else ""
    bool passed() const;
};

/// Runs both tables, a line a step, so that a page stays alive meanwhile.
class SelfCheck {
public:
    explicit SelfCheck(gl::Context& context, std::span<const Check> checks = closedForms());

    /// Measures one line more (up to some hundred milliseconds on a software driver).
    ///
    /// @return true while lines are left
    bool step();
    float progress() const; ///< finished part, [0,1]
    bool passed() const;    ///< every line was measured and passes

    const std::vector<CheckResult>& results() const { return results_; }
    const std::vector<Capability>& capabilities() const { return capabilities_.rows(); }
    /// Both tables with the driver's name, as far as they go.
    std::string json() const;

private:
    gl::Context& context_;
    std::span<const Check> checks_;
    Studio studio_;
    Capabilities capabilities_;
    std::vector<CheckResult> results_;
};

} // namespace lucent::measure
