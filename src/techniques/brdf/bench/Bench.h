#pragma once
/// The benchmark of glossy surfaces.

#include "measure/TechniqueBench.h"

namespace lucent::brdf {

/// The white furnace, reciprocity, and tables against the models that they are made of.
Result<measure::Proof> proveModels(const measure::BenchRun& run);

} // namespace lucent::brdf
