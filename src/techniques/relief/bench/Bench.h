#pragma once
/// The benchmark of relief: fields, environments, methods and promises.

#include "measure/TechniqueBench.h"
#include "techniques/relief/Relief.h"

#include <vector>

namespace lucent::relief {

inline Settings& settingsOf(scene::Scene& scene) {
    return *static_cast<Settings*>(scene.technique.at("relief").data());
}

/// Scenes on which the methods tend to break.
///
/// @param quick  leaves out the field of 4096 x 4096 texels
std::vector<measure::HardCase> hardCases(bool quick);

/// Ten kinds of fields under six kinds of light, against 8192 directions and 1024 samples a lamp, summed
/// exactly: half an hour. The sample size and the safety of frame/Budget were chosen on smooth noise under a
/// sky and one light probe, which are not among them.
Result<measure::Proof> proveBudget(const measure::BenchRun& run);

} // namespace lucent::relief
