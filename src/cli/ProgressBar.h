#pragma once
/// A line on stderr that says how far long work is. Silent when stderr is no terminal.

#include <chrono>
#include <string>

namespace lucent::cli {

class ProgressBar {
public:
    ProgressBar();
    ~ProgressBar(); ///< wipes the line
    /// @param share  finished part of the work, [0,1]
    void show(double share);

private:
    bool visible_;
    std::chrono::steady_clock::time_point start_;
    std::string last_;
};

/// "[#####...............]  25 %, 1 min 30 s left"; without the time while nothing is known about it.
std::string progressLine(double share, double elapsedSeconds);

} // namespace lucent::cli
