#pragma once
/// What leaves bodies that have subsurface scattering, exactly: by the model that is drawn, and by the
/// physics that it stands for.

#include "scene/Scene.h"
#include "truth/Dipole.h"
#include "truth/Picture.h"

#include <optional>

namespace lucent::measure {

/// The model that the scene's settings of technique subsurface draw, as far as it is one of the truth's.
truth::DipoleOptions dipoleOptionsOf(const scene::Scene& scene);

/// Rows of the radiosity that the scene shows: the model's, by brute force over the surface; or, where the
/// scene's method is diffusion, that of random walks. Around one ball under one distant light both depend on
/// the angle from the light alone: there the model is solved at some hundred angles, and the walk's light is
/// averaged over rings two degrees wide.
///
/// @param threads  0: as many as the machine has
Result<truth::Picture> solveSubsurface(const scene::Scene& scene, const truth::Tile& rows, int threads);

/// The same of random walks alone, but only light that was scattered once: what diffusion leaves out.
Result<truth::Picture> solveScatteredOnce(const scene::Scene& scene, int threads);

/// A ball in the middle of the world under one distant light and nothing else.
struct LitBall {
    double radius; ///< m
    dvec3 toLight; ///< unit
};
std::optional<LitBall> litBallOf(const scene::Scene& scene);

} // namespace lucent::measure
