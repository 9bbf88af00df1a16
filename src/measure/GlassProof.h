#pragma once
/// Whether quality.maxError keeps what it promises for light through glass, where it chooses how many
/// surfaces behind each other are drawn.

#include "measure/BudgetProof.h"

namespace lucent::measure {

/// Ten scenes of one to nine clear objects under each environment, against ray tracing in double precision.
///
/// @param environments  light probes, beside the rainbow
/// @param side          of the pictures, in pixels
Result<BudgetReport> proveGlassBudget(gl::Context& context, const std::vector<BenchEnvironment>& environments,
                                      int side, const Say& say);

} // namespace lucent::measure
