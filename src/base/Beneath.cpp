#include "base/Beneath.h"

#include <algorithm>
#include <filesystem>

namespace lucent {
namespace {

namespace fs = std::filesystem;

// With all links followed; what is not there yet keeps its name.
fs::path resolved(const fs::path& path) {
    std::error_code failed;
    const fs::path found = fs::weakly_canonical(fs::absolute(path), failed);
    return failed ? fs::path() : found;
}

bool isBeneath(const fs::path& path, const fs::path& folder) {
    return !path.empty() &&
           std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

fs::path folderOf(const std::string& path) {
    const fs::path folder = fs::path(path).parent_path();
    return folder.empty() ? "." : folder;
}

} // namespace

ReadFile readBeneath(const std::string& path, const std::vector<std::string>& allowed) {
    std::vector<fs::path> folders{resolved(folderOf(path))};
    for (const std::string& folder : allowed)
        folders.push_back(resolved(folder));
    return [=](const std::string& wanted) -> Result<Bytes> {
        if (wanted == path) return readFile(wanted);
        const fs::path place = resolved(wanted);
        const auto holds = [&](const fs::path& folder) { return isBeneath(place, folder); };
        if (std::none_of(folders.begin(), folders.end(), holds))
            return Error{wanted + ": lies outside " + folderOf(path).string() +
                         "; must lie beneath it, or beneath a folder that --allow names"};
        return readFile(wanted);
    };
}

} // namespace lucent
