#pragma once
/// The picture beside another one: what a person chooses, what is compared, and when two scenes are the same.

#include "base/Image.h"
#include "base/Param.h"
#include "measure/Metrics.h"
#include "scene/Scene.h"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lucent::viewer {

enum class CompareMode : int { Off, Truth, Error, Methods, Materials };
/// Whether the right side is drawn as the left one is.
constexpr bool drawsRight(CompareMode mode) {
    return mode == CompareMode::Methods || mode == CompareMode::Materials;
}

/// What a person chooses. Part of the view, not of the scene: no undo step, not in a scene file.
struct CompareSettings {
    CompareMode mode = CompareMode::Off;
    float divider = 0.5f; ///< share of the picture that lies left of it
};

/// "compare" and "divider", which are also their paths and attributes.
std::span<const Param> compareParams();
std::vector<BoundParam> bindCompare(CompareSettings& settings);

/// In front of a parameter's path: that with which the right side of Methods or of Materials is drawn.
inline constexpr std::string_view kBeside = "beside.";
/// What differs in a mode where its path, without kBeside, is this: settings of techniques, or materials.
bool isOfRight(CompareMode mode, std::string_view path);
/// Whether a parameter of an object says how it is drawn, not what it is.
bool isPrecomputing(std::string_view path);
/// An object on the right side: "ball, right of the divider".
std::string besideOwner(std::string_view object);
/// All that may differ on the right side: "beside.technique.relief.method", as attribute
/// beside-relief-method, and "beside.objects.ball.material.roughness".
///
/// @param right  the scene whose parameters they are
std::vector<BoundParam> bindBeside(scene::Scene& right);
/// `scene` with the settings of another one, of the same objects: the same light by other methods.
scene::Scene withSettingsOf(scene::Scene scene, const scene::Scene& settings);
/// `scene` with the materials of another one, of the same objects.
scene::Scene withMaterialsOf(const scene::Scene& scene, const scene::Scene& materials);

/// An exact picture and the scene that it shows.
struct Truth {
    Image image;                 ///< linear, 4 channels; coverage below 0 where it is not known
    std::optional<double> noise; ///< RMSE that the truth itself has; nothing: not known
    scene::Scene scene;
};

/// A picture of 1, 3 or 4 channels as a truth's image.
Image asTruthImage(const Image& picture);

/// True when both scenes have the same exact picture: how it is computed, exposure and marks may differ.
bool samePicture(const scene::Scene& a, const scene::Scene& b);

/// Differences over the pixels that the picture or the truth covers; what is not covered counts as black.
Result<measure::Metrics> compareWithTruth(const Image& picture, const Image& truth);
/// How visible they are: mean FLIP of what a display shows at an exposure in stops, [0,1].
double visibleError(const Image& picture, const Image& truth, float exposure);
/// A truth's unknown coverage is the picture's, which has the same size.
void takeCoverage(Image& truth, const Image& picture);
/// Absolute differences where either of them is, 4 channels.
Image differenceOf(const Image& picture, const Image& truth);

/// A round number from a 99th percentile on, for the end of a scale: 1, 2 or 5 times a power of ten.
double fullScale(double p99);

/// A scene with its images and meshes as files that load() reads without any other.
///
/// Holes are in the heights already and depths of meshes are heights, so that the truth sees what the picture
/// is made of. @return "scene.json" first; float maps (PFM) and meshes (plain form) after it
std::vector<std::pair<std::string, Bytes>> packScene(scene::Scene scene);

} // namespace lucent::viewer
