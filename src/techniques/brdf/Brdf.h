#pragma once
/// Opaque surfaces and mirrors that are no height fields, shaded in screen passes over the surface image.

#include "graph/FrameGraph.h"
#include "light/Occlusion.h"
#include "scene/Scene.h"
#include "views/Drawable.h"
#include "views/Surroundings.h"
#include "views/Textured.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace lucent::brdf {

/// The technique's parameters.
struct Settings {
    views::Around surroundings = views::Around::Surroundings; ///< of mirrors and glossy surfaces
    int lobeDirections = 16; ///< in which a glossy surface looks around, of each pixel sample
};
const ParamTable& params();

/// One slice of the light on matt and glossy surfaces.
struct Inputs {
    const scene::Scene& scene;
    const views::Eye& eye;
    ivec2 size;
    views::Drawables solids;     ///< visible matt and glossy objects
    graph::TextureId surface;    ///< views.surface
    graph::TextureId lightTable; ///< views::sampleTable()
    int first, end;              ///< samples of this slice
    int placed = 0;              ///< samples [placed, ...) are the environment's
    views::Occlusion occlusion;  ///< of these
    graph::TextureId flux;       ///< irradiance of caustics on each pixel; or none
    graph::TextureId sum;        ///< what earlier slices summed; not read when first == 0
    graph::TextureId target;     ///< the sum with this slice; RGBA32F
    scene::Aov show;             ///< Color or Irradiance
    bool clears = false;         ///< nobody has drawn into the target yet
    // of glossy objects, in the first slice
    graph::TextureHandle environment = graph::TextureHandle::None; ///< lat-long map of scene.environment
    const views::Surroundings* surroundings = nullptr;             ///< null: none were asked for
    int lobeDirections = Settings{}.lobeDirections;
    std::function<Result<graph::TextureHandle>(const std::shared_ptr<const Image>&)>
        table{}; ///< of measured ones
};

/// What mirrors show.
struct MirrorInputs {
    const scene::Scene& scene;
    const views::Eye& eye;
    ivec2 size;
    views::Drawables mirrors;         ///< visible ones
    graph::TextureId surface;         ///< views.surface
    graph::TextureHandle environment; ///< lat-long map of scene.environment; None without one
    const views::Surroundings* surroundings = nullptr; ///< null: none were asked for
    graph::TextureId solid{};  ///< views.geometry, where what the camera sees is mirrored; or none
    graph::TextureId target{}; ///< RGBA32F
};

/// Radiance of a matt surface: base + diffuse * E / pi, with E of all light samples past everything that
/// stands in their way, and the flux of caustics. Of a glossy one the same by its model (Reflector.h), and
/// what narrow lobes show of the surroundings, in some directions for each pixel. Radiance of a mirror:
/// reflectance times what lies in the mirrored direction. A surface is lit on the side that is seen.
class Brdf {
public:
    /// Whether it shows the surface of an object: matt, glossy, mirror, or painted where it is not
    /// translucent.
    static bool shades(const scene::Object& object);
    /// Why the scene needs this technique; nothing when it does not.
    static std::optional<std::string> need(const scene::Scene& scene);

    explicit Brdf(gl::Context& context) : context_(context) {}

    /// Adds the light of one slice to the pixels of matt and glossy objects in the target, and leaves the
    /// others as they are.
    Status record(graph::FrameGraph& graph, const Inputs& in);
    /// The next surface is another one.
    void surfaceChanged() { textured_.surfaceChanged(); }
    /// Draws the pixels of mirrors.
    Status recordMirrors(graph::FrameGraph& graph, const MirrorInputs& in) const;

private:
    graph::TextureId recordLobes(graph::FrameGraph& graph, const Inputs& in,
                                 const views::TexturedImages& textured) const;
    gl::Context& context_;
    views::TexturedView textured_;
};

} // namespace lucent::brdf
