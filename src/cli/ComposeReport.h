#pragma once
/// `lucent bench compose`: the matrix of everything on everything, measured and shown as one coloured table.

#include "base/Result.h"
#include "gl/Context.h"

#include <string>

namespace lucent::cli {

/// Measures every cell and writes compose.json, compose.html and the cells' pictures beside their truths.
///
/// @param folder  must exist
/// @param quick   two kinds of lamps in place of all
/// @param some    only cells whose name contains it. Error where none does
Status benchCompose(gl::Context& context, const std::string& folder, bool quick, const std::string& some);

} // namespace lucent::cli
