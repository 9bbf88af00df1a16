#pragma once
/// lucent convert with a folder as its output: files become a scene of their own there.

#include "base/Result.h"

#include <string>
#include <vector>

namespace lucent::cli {

/// Writes the scene of pictures that belong together, of one mesh, of a PTM file, or of the photographs that
/// a light file (.lp) names, with all that it names.
///
/// @param folder   is made where it is not there
/// @param allowed  folders beneath which files may be read that the inputs name, beside their own
Status bringInto(const std::string& folder, const std::vector<std::string>& inputs,
                 const std::vector<std::string>& allowed);

} // namespace lucent::cli
