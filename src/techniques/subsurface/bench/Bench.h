#pragma once
/// The benchmark of subsurface scattering: what leaves bodies, by every method and profile, and what it
/// costs.

#include "measure/TechniqueBench.h"
#include "techniques/subsurface/Subsurface.h"

namespace lucent::subsurface {

inline Settings& settingsOf(scene::Scene& scene) {
    return *static_cast<Settings*>(scene.technique.at("subsurface").data());
}

/// The preset.
scene::Material marble();

/// A ball of marble, 20 mm wide, seen along -z under light of 1 W/m² from the right; what is shown is the
/// radiosity.
scene::Scene marbleBall(int size);

/// What has no scale of its own or too fine a one for any picture: on that ball, whose light is known by its
/// angle.
measure::HardTable hardCases();

/// What leaves a half space under even light of irradiance 1 from straight above, W/m² of each colour: the
/// share that enters, by the dipole's integral over a plane (Jensen et al. 2001, with the dissertation's
/// Fresnel factor).
dvec3 radiosityOfHalfSpace(const scene::Material& material);

} // namespace lucent::subsurface
