#pragma once
/// Bytes in and out. Loaders never open files themselves: they ask a ReadFile, so that the page can hand them
/// what it fetched and the program what lies on disk.

#include "base/Result.h"

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lucent {

using Bytes = std::vector<std::byte>;

/// Gives the content of a file named by a scene, or an error that names it.
using ReadFile = std::function<Result<Bytes>(const std::string& path)>;

/// Reads a whole file from disk.
///
/// @return the bytes, or "PATH: cannot be read (reason)"
Result<Bytes> readFile(const std::string& path);

/// Writes a whole file or nothing: the bytes go to a temporary neighbour that is renamed at the end.
Status writeFile(const std::string& path, std::span<const std::byte> bytes);

/// `path` as seen from the folder of `from`; absolute paths stay as they are.
///
/// resolvePath("scenes/coin.json", "coin.png") == "scenes/coin.png"
std::string resolvePath(std::string_view from, std::string_view path);

} // namespace lucent
