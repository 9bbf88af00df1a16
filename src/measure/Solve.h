#pragma once
/// Exact solutions of whatever a benchmark's scene shows.

#include "scene/Scene.h"
#include "truth/Picture.h"

namespace lucent::measure {

/// By what the scene shows: directions and layers of glass, irradiance by way of glass and mirrors, radiosity
/// of bodies that have subsurface scattering; else relief.
///
/// @param directions  that stand for an environment
/// @param part        rows of the picture; of what rays of light find, a whole picture by its own rays
/// @param threads     0: as many as the machine has
Result<truth::Picture> solveWhatIsShown(const scene::Scene& scene, int directions, const truth::Tile& part,
                                        int threads);

} // namespace lucent::measure
