#pragma once
/// Which of the exact solutions belongs to what a scene shows.

#include "scene/Scene.h"

#include <optional>
#include <string>

namespace lucent::measure {

/// The models that pictures are drawn by, as `src/truth` solves them.
enum class TruthModel {
    Relief, ///< one height field alone, by lamps that are points or directions, discs of these, and an
            ///< environment
    Glass,  ///< what is seen past interfaces and mirrors, and matt things by light that comes straight
    Light,  ///< light of lamps and environment by way of interfaces and mirrors
    Dipole  ///< subsurface scattering
};

/// What a scene is solved by unless somebody says otherwise: radiosity, and colours of what scatters light
/// inside, by the dipole; irradiance, and colours where caustics belong to what is drawn, by light; height
/// fields alone by the relief model; all else by what is seen through glass.
TruthModel usualTruth(const scene::Scene& scene);

/// Which object sends light on to which other; nothing where none does.
std::optional<std::string> causticOf(const scene::Scene& scene);

} // namespace lucent::measure
