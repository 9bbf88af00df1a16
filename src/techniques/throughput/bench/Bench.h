#pragma once
/// The benchmark of precomputed throughput: table 1 of the 2002 paper on our models, what leaves against the
/// exact dipole, and when a bake has paid.

#include "measure/TechniqueBench.h"
#include "techniques/throughput/Throughput.h"

namespace lucent::throughput {

inline Settings& settingsOf(scene::Scene& scene) {
    return *static_cast<Settings*>(scene.technique.at("throughput").data());
}

/// The preset, precomputed.
scene::Material bakedMarble();

/// A ball of it, 20 mm wide, of so many segments around, under light of 1 W/m² from the right; what is shown
/// is the radiosity.
scene::Scene bakedBall(int segments, int size);

} // namespace lucent::throughput
