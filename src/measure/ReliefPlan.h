#pragma once
/// The benchmark of relief: fields, environments, methods and promises.

#include "measure/Plan.h"
#include "measure/Sweep.h"

#include <memory>
#include <string>
#include <vector>

namespace lucent::measure {

/// A height map to measure on, as a field 1 m wide.
struct BenchField {
    std::string name;
    std::shared_ptr<const Image> heights;
    float heightScale; ///< m
};

/// Light from all around to measure under.
struct BenchEnvironment {
    std::string name;
    std::shared_ptr<const Image> map; ///< 3 channels, linear
};

/// Parts of the benchmark.
struct ReliefParts {
    bool relief = true;      ///< methods against each other under distant lights
    bool environment = true; ///< sums of directions and projections under environments
    bool scaling = true;     ///< time over texels, pixels and lights
    bool hard = true;        ///< hard cases x methods
    bool budget = false;     ///< the proof of quality.maxError (BudgetProof.h), which takes long
};

/// @param fields        measured beside synthetic noise
/// @param environments  measured beside the rainbow and the sky
/// @param quick         smaller scenes and fewer repeats: at most two minutes on two cores without a GPU
Plan reliefPlan(const ReliefParts& parts, const std::vector<BenchField>& fields,
                const std::vector<BenchEnvironment>& environments, bool quick);

/// The field with one pixel a texel, seen from above, `depth` metres deep, without lights; shows d.
scene::Scene fieldScene(const BenchField& field, float depth);

/// Sum of sines of falling amplitude over seven octaves, heights in [0, 1].
BenchField benchNoise(int size);

/// The hard cases of the relief model.
///
/// @param quick  leaves out the field of 4096 x 4096 texels
std::vector<HardCase> reliefHardCases(bool quick);

/// Rows of the exact solution of what the scene shows (d or colours), by its own attenuation and light sum.
///
/// @param threads  0: as many as the machine has
Result<truth::Picture> solveRelief(const scene::Scene& scene, int directions, const truth::Tile& rows,
                                   int threads);

} // namespace lucent::measure
