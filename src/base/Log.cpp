#include "base/Log.h"

#include <cstdio>
#include <mutex>
#include <set>

namespace lucent {

void logInfo(const std::string& message) { std::fprintf(stderr, "%s\n", message.c_str()); }

void warnOnce(const std::string& message) {
    static std::mutex mutex;
    static std::set<std::string> said;
    const std::lock_guard lock(mutex);
    if (said.insert(message).second) logInfo("warning: " + message);
}

} // namespace lucent
