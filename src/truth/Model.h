#pragma once
/// What of a scene's settings belongs to the model that is drawn, and not to how it is drawn: an exact
/// solution must know it.

#include "truth/Dipole.h"
#include "truth/Relief.h"

namespace lucent::truth {

struct Model {
    Attenuation attenuation = Attenuation::Ratio;
    bool normalise = false;           ///< light is divided by the number of lights
    DipoleOptions dipole{};           ///< of what scatters light; samples and seed are the solver's
    bool overPixels = false;          ///< colours are means over pixels, not what their middles show
    bool environmentCaustics = false; ///< caustics of the environment too: rays of light tell
    bool walks = false; ///< light is scattered by diffusion in the body itself: random walks tell
};

} // namespace lucent::truth
