#pragma once
/// Light through many interfaces of refractive objects (multiple-refractions thesis 2008), traced through the
/// layered images of the camera's view.

#include "views/Layers.h"
#include "views/Surroundings.h"
#include "views/Voxels.h"

#include <optional>
#include <string>
#include <string_view>

namespace lucent::refract {

enum class LayerMethod : int { Peel, Voxels, FrontBack };
enum class Peeling : int { Pass, OnTheFly };
enum class Slices : int { Few, Many }; ///< 256, 512
enum class Extent : int { Local, Global };
enum class Trace : int { Pyramid, Bisection };
enum class Normals : int { Stored, Neighbours, Delta1, Delta2 };
enum class PathLength : int { Geometric, Optical };

struct Settings {
    LayerMethod layers = LayerMethod::Peel;
    int maxLayers = views::kMostLayers; ///< surfaces behind each other that are drawn, at most
    Slices slices = Slices::Few;
    Extent bounds = Extent::Local;
    Peeling peeling = Peeling::Pass;
    Trace trace = Trace::Pyramid;
    Normals normals = Normals::Stored;
    PathLength pathLength = PathLength::Geometric;
    views::Around surroundings = views::Around::Surroundings;
};

/// Which choices go together: pyramids need the objects, sides and normals that only peeled layers hold, and
/// know no other normals.
Status check(const Settings& settings);
/// Whether a parameter changes anything beside these choices: of slices only voxels are made, other normals
/// than the stored ones only bisection asks for, and the first and the last surface are two.
bool acts(const Settings& settings, std::string_view id);
/// How the view is cut into slices.
views::VoxelSettings voxelSettings(const Settings& settings);

struct Inputs {
    const views::Eye& eye;
    views::Drawables glass;           ///< refractive objects, as the layers number them
    const views::Layers& layers;      ///< of other methods than Peel: only the first one
    graph::TextureId opaque;          ///< shaded opaque surfaces, premultiplied by coverage; or none
    graph::TextureId solid;           ///< their depths (views.geometry); with `opaque`
    graph::TextureHandle environment; ///< lat-long map; None without one
    const scene::Environment* light;  ///< the same, or null
    graph::TextureId target;          ///< RGBA32F
    scene::Aov show;                  ///< Color, Direction, Layers or Lost
    int count = 0;                    ///< of Trace::Bisection: surfaces behind each other
    const views::Surroundings* surroundings = nullptr; ///< null: none were asked for
};

class Refract {
public:
    static const ParamTable& params();
    /// Why the scene needs this technique; nothing when it does not.
    static std::optional<std::string> need(const scene::Scene& scene);

    explicit Refract(gl::Context& context) : context_(context) {}

    /// Adds the passes that draw the picture with everything seen through the layers; bisection's further
    /// layers first.
    ///
    /// @return  Error for settings that do not go together (see check()); Error (Fault::Machine) for more
    /// than
    ///          views::kMostGlass refractive objects
    Status record(graph::FrameGraph& graph, const Inputs& in, ivec2 size,
                  const Settings& settings = {}) const;

private:
    Result<views::DepthLayers> depthsOf(graph::FrameGraph& graph, const Inputs& in, ivec2 size,
                                        const Settings& settings) const;

    gl::Context& context_;
};

} // namespace lucent::refract
