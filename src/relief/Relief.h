#pragma once
/// Light on and in a height field by one integral: the length that light travels inside the solid
/// (height-field thesis 2017, ch. 3), with the corrections that the README lists.

#include "graph/FrameGraph.h"
#include "scene/Scene.h"
#include "views/Surface.h"

#include <optional>
#include <string>
#include <vector>

namespace lucent::relief {

enum class Method : int { Hierarchy, March, Counting };
enum class Attenuation : int { Ratio, Exponential };

struct Settings {
    Method method = Method::Hierarchy;
    int steps = 256; ///< of march and counting
    Attenuation attenuation = Attenuation::Ratio;
    int environmentLights = 256; ///< about as many directions stand for the environment
    bool normalise = false;      ///< divide the light by the number of lights
};

/// One light as the shader reads it.
struct LightSource {
    vec4 place;   ///< world: direction to the light, w 0; or position, w 1, or 2 with inverse-square falloff
    vec3 color;   ///< times intensity
    float weight; ///< share in the mean of d
};

struct Inputs {
    const views::Eye& eye;
    const std::vector<views::DrawnObject>& objects;
    const std::vector<LightSource>& lights;
    graph::TextureId surface; ///< views.surface
    graph::TextureId sum;     ///< what earlier slices summed; not read when first == 0
    graph::TextureId target;  ///< the sum with this slice
    graph::TextureId lightTable;
    int first, end;  ///< lights of this slice
    scene::Aov show; ///< Color, Illumination, Visibility or Iterations
};

class Relief {
public:
    static const ParamTable& params();
    /// Why the scene needs this technique; nothing when it does not.
    static std::optional<std::string> need(const scene::Scene& scene);

    explicit Relief(gl::Context& context) : context_(context) {}

    /// Lights of a scene: its point and distant lights, and the environment as about `environmentLights`
    /// directions (0: leaves it out). With `normalise` the colours are divided by their number, an
    /// environment counting as one.
    static std::vector<LightSource> lights(const scene::Scene& scene, const Settings& settings,
                                           int environmentLights);
    /// The lights as the shader reads them: RGBA32F rows of kLightsPerRow lights, two texels each.
    static Image lightTable(const std::vector<LightSource>& lights);
    static constexpr int kLightsPerRow = 512;

    /// Adds the light of one slice to the sum.
    Status record(graph::FrameGraph& graph, const Inputs& in, const Settings& settings) const;

private:
    gl::Context& context_;
};

} // namespace lucent::relief
