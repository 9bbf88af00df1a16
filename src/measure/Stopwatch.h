#pragma once
/// Times work on the GPU: warms up, repeats, gives median and spread.

#include "base/Result.h"
#include "gl/Context.h"
#include "gl/Timer.h"
#include "measure/Statistics.h"

#include <chrono>
#include <functional>
#include <string_view>
#include <vector>

namespace lucent::measure {

/// Quick work is repeated until `enoughMs` have gone into it, slow work at least `least` times.
struct Repeats {
    int least = 3, most = 31;
    double enoughMs = 400;
};

/// Runs work with and without what is to be timed, in turn, so that whatever else the machine does hits both;
/// a time is the difference of two neighbouring runs. The first pair compiles and uploads and does not count.
///
/// Hardware drivers are asked for GPU time (timer queries). Software drivers draw in worker threads, which a
/// query does not see, and some drivers have no queries: there a time ends when the work has read a pixel
/// back.
class Stopwatch {
public:
    /// Does it all and waits for the GPU.
    using Work = std::function<Status()>;

    /// "gpu-timer" or "finished-frame": how times are taken on this driver.
    static std::string_view kind(const gl::Context& context);

    /// @param without  the same work less what is to be timed
    Stopwatch(const gl::Context& context, Work work, Work without, Repeats repeats);

    /// Runs the work once, or asks for an answer of the GPU that is late.
    ///
    /// @return true when everything is known; the work's error
    Result<bool> step();

    /// What is known so far; valid after the first true of step(). Differences below the clocks' step of 1 µs
    /// count as 1 µs.
    Spread spread() const { return spreadOf(times_); }

private:
    Result<bool> run();
    bool record(double milliseconds);

    gl::Timer timer_;
    Work work_, without_;
    Repeats repeats_;
    bool usesTimer_;
    bool runsWork_ = true; // else runs what is without
    bool warm_ = false;
    double withMs_ = 0;
    int asked_ = 0; // times that the GPU was asked for the answer under way; 0: none is
    std::chrono::steady_clock::time_point started_;
    double spentMs_ = 0;
    std::vector<double> times_;
};

} // namespace lucent::measure
