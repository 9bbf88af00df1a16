#pragma once
/// Light on and in a height field by one integral: the length that light travels inside the solid
/// (height-field thesis 2017, ch. 3), with the corrections of
/// web/docs/papers.html.

#include "graph/FrameGraph.h"
#include "light/Occlusion.h"
#include "scene/Scene.h"
#include "shaders/relief/Blocks.h"
#include "views/Fields.h"

#include <optional>
#include <string>
#include <vector>

namespace lucent::relief {

enum class Method : int { Hierarchy, March, Counting, Transfer };
enum class Attenuation : int { Ratio, Exponential };

struct Settings {
    Method method = Method::Hierarchy;
    int steps = 256; ///< of march and counting
    Attenuation attenuation = Attenuation::Ratio;
    int terms = 64;         ///< of transfer, a texel
    bool normalise = false; ///< divide the light by the number of lights
};

/// What a transfer leaves to the light pass: for one object.
struct Transferred {
    graph::TextureId irradiance; ///< relief/gather.frag; nothing in slices after the first
    graph::TextureHandle gloss;  ///< the environment's specular part by direction
};

struct Inputs {
    const views::Eye& eye;
    const std::vector<views::DrawnField>& objects;
    const scene::Scene& scene;
    const std::vector<views::LampPoint>& lights;
    graph::TextureId surface;             ///< views.surface
    graph::TextureId sum;                 ///< what earlier slices summed; not read when first == 0
    graph::TextureId target;              ///< the sum with this slice
    graph::TextureId lightTable;          ///< views::sampleTable(lights)
    int first, end;                       ///< lights of this slice
    int placed;                           ///< lights [placed, ...) are the environment's
    std::vector<Transferred> transferred; ///< one for each object, or none
    scene::Aov show;                      ///< Color, Illumination, Visibility, Iterations or Irradiance
    views::Occlusion occlusion{};         ///< of this slice
    graph::TextureId flux{};              ///< irradiance of caustics on each pixel; or none
    ivec2 size{0};                        ///< of the view
    bool clears = true;                   ///< nobody has drawn into the target yet
};

class Relief {
public:
    static const ParamTable& params();
    /// Why the scene needs this technique; nothing when it does not.
    static std::optional<std::string> need(const scene::Scene& scene);

    explicit Relief(gl::Context& context) : context_(context) {}

    /// What each light, or the environment, counts in means over the lights: one over their number.
    static float shareOfLight(const scene::Scene& scene);
    /// Adds the light of one slice to the sum.
    Status record(graph::FrameGraph& graph, const Inputs& in, const Settings& settings) const;

private:
    gl::Context& context_;
};

/// The block for one object with everything that is the object's own. World space is the object's own unless
/// the caller says otherwise.
ReliefBlock makeBlock(const views::DrawnField& drawn, const Settings& settings);

} // namespace lucent::relief
