#pragma once
/// How a glossy surface sends light back, as a body whose radius is the BRDF, as curves and as words
/// (image-space dissertation 2007, figure 2.11).

#include "scene/Scene.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace lucent::brdf {

/// Of one object, for light from one direction.
struct LobePlot {
    static constexpr int kRings = 12, kSpokes = 24; ///< from the normal to the horizon, and around it
    static constexpr int kSlice = 90;               ///< directions from horizon to horizon
    static constexpr std::size_t kTables = 4;
    static constexpr int kTableSizes[kTables] = {4, 8, 16, 32};

    std::string owner;       ///< the object's name
    std::string_view model;  ///< as material.kind spells it
    float lightAngle = 0;    ///< degrees from the normal, as the first lamp stands above the object
    float lightTurn = 0;     ///< radians around it
    std::vector<vec3> lobe;  ///< BRDF [1/sr], ring after ring of spokes, the first ring at the normal
    std::vector<vec3> slice; ///< the same in the plane of light and normal, from the light's side
    struct Laws {
        vec3 albedo[3];        ///< directionalAlbedo() at 0, 60 and 80 degrees
        float reciprocity = 0; ///< reciprocityError()
        /// tableError() of the two forms with blocks, over n (rows) and m, each of kTableSizes.
        std::array<float, kTables * kTables> projected, equalArea;
    };
    Laws laws; ///< which no light changes
};

/// One for each visible glossy object, in the scene's order.
std::vector<LobePlot> lobePlots(const scene::Scene& scene);

/// The same for those who cannot see bodies: "Reflectance of ball, glossy: ... % of even light is seen from
/// above, ...".
std::string describe(const LobePlot& plot);

} // namespace lucent::brdf
