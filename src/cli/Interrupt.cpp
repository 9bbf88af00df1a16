#include "cli/Interrupt.h"

#include <csignal>

namespace lucent::cli {

namespace {
std::atomic<bool> isInterrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free); // or a signal handler must not touch it
} // namespace

const std::atomic<bool>& catchInterrupt() {
    std::signal(SIGINT, [](int) {
        isInterrupted = true;
        std::signal(SIGINT, SIG_DFL);
    });
    return isInterrupted;
}

} // namespace lucent::cli
