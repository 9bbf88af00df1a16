#pragma once
/// Benchmark reports as one page that opens by itself.

#include "base/Result.h"

#include <string>
#include <vector>

namespace lucent::cli {

/// Refuses text that is no benchmark report, naming `name`.
Status checkReport(const std::string& json, const std::string& name);

/// The page beside the program, with reports ("lucent-bench-1" each) put in.
///
/// @return Error (Fault::Machine) when the page was not built
Result<std::string> reportPage(const std::vector<std::string>& reports);

} // namespace lucent::cli
