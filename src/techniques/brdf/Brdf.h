#pragma once
/// Opaque surfaces and mirrors that are no height fields, shaded in one screen pass over the surface image;
/// lamps with shadows.

#include "graph/FrameGraph.h"
#include "scene/Scene.h"
#include "views/Surface.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lucent::brdf {

struct Settings {
    int lightSamples = 16; ///< points that stand for a lamp with a size
    int shadowSize = 1024; ///< texels a side of a shadow map; of lamps with a size half as many
};

struct Inputs {
    const scene::Scene& scene;
    const views::Eye& eye;
    const std::vector<views::PosedMesh>& solids;  ///< visible opaque objects and mirrors
    const std::vector<views::PosedMesh>& casters; ///< all that casts shadows, hidden or not: opaque,
                                                  ///< scattering, mirrors and refractive
    graph::TextureId surface;                     ///< views.surface
    graph::TextureId flux;                        ///< irradiance of caustics on each pixel; or none
    graph::TextureHandle environment;             ///< lat-long map of scene.environment; None without one
    graph::TextureId target;                      ///< RGBA32F
    scene::Aov show;                              ///< Color or Irradiance
    ivec2 size;
    std::span<const views::DrawnObject> fields{}; ///< height fields that cast shadows too
};

/// Radiance of a matt surface: base + diffuse * E / pi, with E of
/// - the lamps in physical units (views/Lamps.h), past everything that casts shadows: refractive objects cast
/// full
///   ones, since the light that they let through is that of caustics;
/// - the flux of caustics;
/// - the environment, which nothing stands in the way of (SkyIrradiance.h).
/// Radiance of a mirror: reflectance times the environment in the mirrored direction, whatever lies there.
///
/// A surface is lit on the side that is seen.
class Brdf {
public:
    static const ParamTable& params();
    /// Why the scene needs this technique; nothing when it does not.
    static std::optional<std::string> need(const scene::Scene& scene);

    explicit Brdf(gl::Context& context) : context_(context) {}

    /// Adds the passes that draw the pixels of `solids` into the target and leave the others as they are:
    /// linear Rec. 709, or of Irradiance W/m² (0 on mirrors); a: 1.
    ///
    /// @return  Error (Fault::Machine) when a shadow map is larger than the GPU's textures
    Status record(graph::FrameGraph& graph, const Inputs& in, const Settings& settings) const;

private:
    gl::Context& context_;
};

} // namespace lucent::brdf
