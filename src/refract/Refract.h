#pragma once
/// Light through many interfaces of refractive objects (multiple-refractions thesis 2008), traced through the
/// layered images of the camera's view.

#include "views/Layers.h"

#include <optional>
#include <string>

namespace lucent::refract {

struct Settings {
    int maxLayers = views::kMostLayers; ///< surfaces behind each other that are drawn, at most
};

struct Inputs {
    const views::Eye& eye;
    const std::vector<views::PosedMesh>& glass; ///< refractive objects, as the layers number them
    const views::Layers& layers;
    graph::TextureId opaque;          ///< shaded opaque surfaces, premultiplied by coverage; or none
    graph::TextureId solid;           ///< their depths (views.geometry); with `opaque`
    graph::TextureHandle environment; ///< lat-long map; None without one
    const scene::Environment* light;  ///< the same, or null
    graph::TextureId target;          ///< RGBA32F
    scene::Aov show;                  ///< Color or Direction
};

class Refract {
public:
    static const ParamTable& params();
    /// Why the scene needs this technique; nothing when it does not.
    static std::optional<std::string> need(const scene::Scene& scene);

    explicit Refract(gl::Context& context) : context_(context) {}

    /// Adds the pass that draws the picture with everything seen through the layers.
    ///
    /// @return  Error (Fault::Machine) for more than views::kMostGlass refractive objects
    Status record(graph::FrameGraph& graph, const Inputs& in, ivec2 size) const;

private:
    gl::Context& context_;
};

} // namespace lucent::refract
