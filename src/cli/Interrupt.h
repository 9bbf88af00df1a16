#pragma once
/// Ctrl-C during long work: the first one stops it where it is, the next one ends the program.

#include <atomic>

namespace lucent::cli {

/// Catches SIGINT from now on. @return  set once it came
const std::atomic<bool>& catchInterrupt();

} // namespace lucent::cli
