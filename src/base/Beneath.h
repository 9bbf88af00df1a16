#pragma once
/// How far a file may reach that names others.

#include "base/File.h"

#include <span>
#include <string>
#include <vector>

namespace lucent {

/// Reads `path` itself, and of what it names only files that lie beneath its own folder or one of the folders
/// `allowed`, wherever links and ".." lead. Nothing is opened outside, and messages do not tell what is
/// there.
///
/// @return  what readFile() gives, or "PATH: lies outside FOLDER; must lie beneath it, or beneath a folder
/// that
///          --allow names"
ReadFile readBeneath(const std::string& path, const std::vector<std::string>& allowed);

} // namespace lucent
