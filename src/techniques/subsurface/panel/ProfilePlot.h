#pragma once
/// How far light spreads inside an object, as a curve and as words: R_d over the distance between the places
/// where light enters and leaves (image-space dissertation 2007, figures 7.1 to 7.5).

#include "diffusion/Profile.h"
#include "viewer/Figure.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace lucent::subsurface {

/// Of one object, each colour by itself.
struct ProfilePlot {
    std::string owner;             ///< the object's name
    std::string_view profile;      ///< as technique.subsurface.profile spells it
    std::array<double, 3> reach{}; ///< mm: within it lies all but technique.subsurface.epsilon of the light
    std::array<double, 3> whole{}; ///< share of the light that entered which leaves again
    std::vector<double> distances; ///< mm, from just above 0 to the largest reach
    std::vector<dvec3> values;     ///< R_d there, 1/mm²
};

/// One for each visible object that scatters, in the scene's order.
std::vector<ProfilePlot> profilePlots(const scene::Scene& scene);

/// The same for those who cannot see curves: "R_d of bunny by the dipole: red reaches 12.3 mm, 83.0 % leave;
/// ...".
std::string describe(const ProfilePlot& plot);

} // namespace lucent::subsurface
