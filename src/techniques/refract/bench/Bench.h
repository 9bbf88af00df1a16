#pragma once
/// The benchmark of refraction: directions of light behind glass, and what they cost over triangles.

#include "measure/TechniqueBench.h"

namespace lucent::refract {

/// What quality.maxError chooses of the number of surfaces behind each other: ten scenes of one to nine clear
/// objects under two environments, against ray tracing in double precision.
Result<measure::Proof> proveBudget(const measure::BenchRun& run);

} // namespace lucent::refract
