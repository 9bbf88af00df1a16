#pragma once
/// The light of a scene as one list of samples, in physical units: who shades reads it by
/// shaders/light/sample.glsl.

#include "light/EnvironmentLights.h"
#include "light/ShadowMap.h"
#include "scene/Scene.h"
#include "shaders/light/Blocks.h"

#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace lucent::views {

/// How light of a direction passes the first sheet of water of a scene (shaders/light/flat_water.glsl): as if
/// there were none; straight on, where it does not meet the surface; or refracted by the surface.
enum class WaterPath : int { None, Beside, Through };

/// A lamp, or one of the points that stand for it. Its irradiance on a surface that faces it is
/// color * cone * (1, or 1 / distance²).
struct LampPoint {
    vec4 place;          ///< world: position, 1; or unit direction to the light, 0
    vec3 centre{0};      ///< of the lamp whose point it is, m
    bool fades = false;  ///< with the square of the distance
    vec3 color{0};       ///< W/sr, or W/m²; its part of the lamp's
    vec3 axis{0};        ///< unit: along which it shines most
    vec2 cone{0, 1};     ///< clamp(cosine to the axis * x + y, 0, 1) to the power of
    float exponent = 1;  ///< this
    bool isPart = false; ///< the lamp has a size and several points
    ShadowSource source; ///< the same point as what shadows are seen from
    float weight = 1;    ///< its share of the light that it is a part of
    bool isEnvironment = false;
    WaterPath water = WaterPath::None;
    float extent =
        0; ///< sine of the angle by which the directions spread that it stands for; of an environment
    float spread = 0; ///< of the light of an environment that it stands for: EnvironmentLight::spread
    float part = 0;   ///< radius of what it stands for of its lamp: m, or where that is distant a tangent
    std::shared_ptr<const Image> picture{}; ///< that it projects, around its axis; null: none
    vec3 pictureRight{0}, pictureUp{0};     ///< scene::PictureFrame
    bool operator==(const LampPoint&) const = default;
};

/// What a lamp projects, as a texture; asked only of lamps that do.
using PictureOf = std::function<Result<graph::TextureHandle>(const LampPoint&)>;

/// What shaders/light/picture.glsl has to know of its picture.
light::PictureFrameBlock pictureBlock(const LampPoint& lamp);

/// Lamps with a size (a point light's ball, a distant light's disc of directions, an area) are so many points
/// each. A lamp's disc faces whatever it lights, so its points lie in a ball, more of them near its surface,
/// such that the ball is an even disc from all sides: density 1 / sqrt(1 - r²), whose integral along a line
/// is pi wherever the line passes.
///
/// Spots fade between their angles by the square of (cos - cos outer) / max(0.001, cos inner - cos outer)
/// (KHR_lights_punctual). Areas shine from one side, radiance times area times the cosine there.
///
/// @param samples  > 0
/// @param offset   [0,1)²: points lie that much beside those of (0, 0), over the same lamp
std::vector<LampPoint> lampPoints(const scene::Scene& scene, int samples, vec2 offset = vec2(0));

/// The point beside the middle of its lamp, on the disc that faces a place, as which a point counts there
/// (shaders/light/sample.glsl); other points as they are.
LampPoint facing(LampPoint point, const vec3& place);

/// Where the directions are that stand for an environment: evenly all around, or more where the map is
/// bright.
enum class EnvironmentSampling : int { Equal, Importance };

/// How finely the light of a scene is sampled, for all who shade alike.
struct Sampling {
    int lamp = 16;        ///< of each lamp that has a size, > 0
    int directions = 256; ///< of the environment, about, in all samples of a pixel; 0: leaves it out
    EnvironmentSampling environment = EnvironmentSampling::Importance;
    int shadowSize = 1024; ///< texels a side of a shadow view; of lamps with a size half as many
    int pixelSamples = 5;  ///< places over whose colours a pixel is the mean, > 0; 1: its middle alone
};

/// Where a sample of a pixel lies, in pixels from the middle: the first one there, or beside it where the
/// count is even; all of them a rank-1 lattice whose rows and columns are even, so that a straight edge errs
/// by 1 / count at most. Each second one lies opposite to the one before, so that their mean is the middle.
///
/// @return  [-0.5, 0.5)²
vec2 pixelOffset(int sample, int count);

/// Offset of the light samples of one of so many samples of a pixel, a place of the same lattice: their mean
/// is lit from that many times as many points and directions evenly all around.
///
/// @return  [0,1)²; (0, 0) of the first
vec2 lightOffset(int sample, int count);

/// The table "sampling", which scenes carry beside those of the techniques.
const ParamTable& samplingParams();
/// The scene's own; as by default where it has no such table.
const Sampling& samplingOf(const scene::Scene& scene);
Sampling& samplingOf(scene::Scene& scene);
/// Whether a parameter of the table changes anything in a scene.
bool samplingActs(const scene::Scene& scene, std::string_view id);

bool hasEnvironment(const scene::Scene& scene);
/// Whether any lamp has a size, so that several samples stand for it.
bool hasLargeLamp(const scene::Scene& scene);

/// All light of a scene: lampPoints(), then directions of its environment, whose irradiance on a surface that
/// faces them is radiance times solid angle: together the integral over the sphere.
///
/// @param sampling  its directions: of this sample alone
/// @param sample    of a pixel, of so many, each of which has others
std::vector<LampPoint> lightSamples(const scene::Scene& scene, const Sampling& sampling, int sample = 0,
                                    int samples = 1);

/// The samples as shaders read them, and behind them the pictures that they project, RGBA32F.
///
/// @param water  that their paths go by
Image sampleTable(const std::vector<LampPoint>& samples,
                  const std::optional<light::FlatWaterBlock>& water = {});

} // namespace lucent::views
