#pragma once
/// What this device can and cannot, what Lucent does with it, and what doing without costs here.

#include "gl/Context.h"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lucent::measure {

/// One thing in which devices differ. `use` and `fallback` say only what the program does today.
struct Capability {
    std::string_view name;
    std::string_view extension; ///< "" for what every device has
    bool present;
    std::string amount;        ///< of what comes in amounts ("16384 texels"), else ""
    std::string_view use;      ///< what Lucent does with it
    std::string_view fallback; ///< what is done without it, and whether that is so now
    double measured; ///< on this device; NaN: there is nothing to measure, or the device did not answer
    std::string_view measure; ///< what the number is
};

/// Measures one line a step.
class Capabilities {
public:
    static constexpr int kCount = 9;

    explicit Capabilities(gl::Context& context);
    ~Capabilities();

    /// @return true while lines are left; a timer query may need several steps, with the page's other work
    ///         between them
    bool step();
    const std::vector<Capability>& rows() const { return rows_; }

private:
    struct TimedWork;
    std::unique_ptr<TimedWork> startWork();
    bool finishTimers(); ///< false while the query has not answered

    gl::Context& context_;
    std::vector<Capability> rows_;
    std::unique_ptr<TimedWork> work_; // while a query has not answered
};

} // namespace lucent::measure
