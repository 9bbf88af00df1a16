#include "measure/Stopwatch.h"

#include <algorithm>

namespace lucent::measure {

namespace {
// An answer that has not come by then was disturbed and is measured again.
constexpr int kPatience = 1000;

bool hasTimer(const gl::Context& context) { return context.caps().timerQuery && !context.caps().software; }
} // namespace

std::string_view Stopwatch::kind(const gl::Context& context) {
    return hasTimer(context) ? "gpu-timer" : "finished-frame";
}

Stopwatch::Stopwatch(const gl::Context& context, Work work, Work without, Repeats repeats)
    : timer_(context), work_(std::move(work)), without_(std::move(without)), repeats_(repeats),
      usesTimer_(hasTimer(context)) {}

Result<bool> Stopwatch::step() {
    if (asked_ == 0) return run();
    if (const auto answer = timer_.milliseconds()) {
        asked_ = 0;
        return record(*answer);
    }
    asked_ = asked_ < kPatience ? asked_ + 1 : 0;
    return false;
}

Result<bool> Stopwatch::run() {
    started_ = std::chrono::steady_clock::now();
    if (usesTimer_) timer_.begin();
    const Status done = runsWork_ ? work_() : without_();
    if (usesTimer_) timer_.end();
    if (!done) return done.error();
    if (usesTimer_) {
        asked_ = 1;
        return false;
    }
    return record(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - started_).count());
}

bool Stopwatch::record(double milliseconds) {
    spentMs_ += milliseconds;
    runsWork_ = !runsWork_;
    if (!runsWork_) {
        withMs_ = milliseconds;
        return false;
    }
    if (!warm_) {
        warm_ = true;
        spentMs_ = 0;
        return false;
    }
    times_.push_back(std::max(1e-3, withMs_ - milliseconds));
    const int count = int(times_.size());
    return count >= repeats_.most || (count >= repeats_.least && spentMs_ >= repeats_.enoughMs);
}

} // namespace lucent::measure
