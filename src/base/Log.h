#pragma once
/// Lines for people on stderr; stdout belongs to results.

#include <string>

namespace lucent {

/// Prints one line.
void logInfo(const std::string& message);

/// Prints "warning: MESSAGE" the first time this text comes by: a fallback is named once, with its
/// consequence.
void warnOnce(const std::string& message);

} // namespace lucent
