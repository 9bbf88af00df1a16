#include "base/File.h"

namespace lucent {

std::string resolvePath(std::string_view from, std::string_view path) {
    const bool absolute = path.starts_with('/') || path.find(':') != path.npos; // ':' of https:, blob:, data:
    const std::size_t slash = from.rfind('/');
    if (absolute || slash == from.npos) return std::string(path);
    return std::string(from.substr(0, slash + 1)) += path;
}

} // namespace lucent
