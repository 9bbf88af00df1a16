#pragma once
/// What solving a truth and merging its parts write alike.

#include "base/Result.h"
#include "truth/Part.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace lucent::cli {

/// Where a truth goes.
struct TruthOutput {
    std::string picture;
    std::string errors; ///< empty: not written

    void addTo(CLI::App& parser);
    /// Where the facts go.
    std::string facts() const { return picture + ".json"; }
    /// Refuses paths that could not be written after hours of work, or are read.
    Status check(const std::vector<std::string>& inputs) const;
    /// Writes the picture, its facts beside it as PICTURE.json, and the standard errors where they are
    /// wanted; prints what the picture's own noise is. All or nothing.
    Status write(const truth::Facts& what, const truth::Picture& solved) const;
};

} // namespace lucent::cli
