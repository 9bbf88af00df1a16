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

enum class Method : int { Hierarchy, March, Counting, Transfer };
enum class Attenuation : int { Ratio, Exponential };
enum class EnvironmentSampling : int { Equal, Importance };

inline constexpr int kMostTerms = 128; ///< of a transfer

struct Settings {
    Method method = Method::Hierarchy;
    int steps = 256; ///< of march and counting
    Attenuation attenuation = Attenuation::Ratio;
    int environmentLights = 256; ///< about as many directions stand for the environment
    EnvironmentSampling environmentSampling = EnvironmentSampling::Equal;
    int terms = 64;         ///< of transfer, a texel
    int lightSamples = 32;  ///< points that stand for a lamp with a size
    bool normalise = false; ///< divide the light by the number of lights
};

/// One light as the shader reads it.
struct LightSource {
    vec4 place;   ///< world: direction to the light, w 0; or position, w 1, or 2 with inverse-square falloff
    vec3 color;   ///< times intensity
    float weight; ///< share in the mean of d
    vec2 disc{0}; ///< offset on the lamp's disc, which faces what it lights: m, or tangent of the angle
};

/// What a transfer leaves to the light pass: for one object.
struct Transferred {
    graph::TextureId irradiance; ///< relief/gather.frag; nothing in slices after the first
    graph::TextureHandle gloss;  ///< the environment's specular part by direction
};

struct Inputs {
    const views::Eye& eye;
    const std::vector<views::DrawnObject>& objects;
    const std::vector<LightSource>& lights;
    graph::TextureId surface; ///< views.surface
    graph::TextureId sum;     ///< what earlier slices summed; not read when first == 0
    graph::TextureId target;  ///< the sum with this slice
    graph::TextureId lightTable;
    int first, end;                       ///< lights of this slice
    int placed;                           ///< lights [placed, ...) are the environment's
    std::vector<Transferred> transferred; ///< one for each object, or none
    scene::Aov show;                      ///< Color, Illumination, Visibility or Iterations
};

class Relief {
public:
    static const ParamTable& params();
    /// Why the scene needs this technique; nothing when it does not.
    static std::optional<std::string> need(const scene::Scene& scene);

    explicit Relief(gl::Context& context) : context_(context) {}

    /// Lights of a scene: its point and distant lights, those with a size as `lightSamples` each, then the
    /// environment as about `environmentLights` directions (0: leaves it out). With `normalise` the colours
    /// are divided by the number of lights, an environment counting as one.
    static std::vector<LightSource> lights(const scene::Scene& scene, const Settings& settings,
                                           int environmentLights);
    /// What each light, or the environment, counts in means over the lights: one over their number.
    static float shareOfLight(const scene::Scene& scene);
    /// The lights as the shader reads them: RGBA32F rows of kLightsPerRow lights, three texels each.
    static Image lightTable(const std::vector<LightSource>& lights);
    static constexpr int kLightsPerRow = 256;
    /// More lights than these go into several slices: llvmpipe ends a shader's loops, without a word, after
    /// 65535 rounds in all, and no draw should hold a desktop up.
    static constexpr int kMostLightsAtOnce = 64;

    /// Adds the light of one slice to the sum.
    Status record(graph::FrameGraph& graph, const Inputs& in, const Settings& settings) const;

private:
    gl::Context& context_;
};

} // namespace lucent::relief
