#pragma once
/// GPU time of what is drawn between two calls, where the driver has timer queries.

#include <optional>

namespace lucent::gl {

class Context;

/// The answer arrives some frames later, never within the frame. On software drivers a query times the
/// submission to worker threads: there, time draw + Device::wait() instead (Caps::software says so).
class Timer {
public:
    explicit Timer(const Context& context);
    ~Timer();
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

    bool available() const { return query_ != 0; }
    void begin();
    void end();
    /// Milliseconds of the last begin/end pair once they are known; nothing while they are not, or when the
    /// measurement was disturbed.
    std::optional<double> milliseconds();

private:
    unsigned query_ = 0;
    bool pending_ = false;
};

} // namespace lucent::gl
