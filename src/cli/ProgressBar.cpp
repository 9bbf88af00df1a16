#include "cli/ProgressBar.h"

#include <cmath>
#include <cstdio>
#include <unistd.h>

namespace lucent::cli {

ProgressBar::ProgressBar() : visible_(isatty(STDERR_FILENO) == 1), start_(std::chrono::steady_clock::now()) {}

ProgressBar::~ProgressBar() {
    if (visible_) std::fputs("\r\33[K", stderr);
}

void ProgressBar::show(double share) {
    if (!visible_) return;
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
    const std::string line = progressLine(share, elapsed.count());
    if (line == last_) return;
    std::fprintf(stderr, "\r\33[K%s", line.c_str());
    last_ = line;
}

std::string progressLine(double share, double elapsedSeconds) {
    constexpr int kWidth = 20;
    const int done = int(share * kWidth);
    std::string line =
        "[" + std::string(std::size_t(done), '#') + std::string(std::size_t(kWidth - done), '.') + "] ";
    line += std::to_string(int(100 * share)) + " %";
    if (share <= 0 || elapsedSeconds < 1) return line;
    const long left = std::lround(elapsedSeconds * (1 - share) / share);
    if (left >= 60)
        return line + ", " + std::to_string(left / 60) + " min " + std::to_string(left % 60) + " s left";
    return line + ", " + std::to_string(left) + " s left";
}

} // namespace lucent::cli
