#pragma once
/// What an artist painted on a translucent object (image-space dissertation 2007, ch. 7): maps on its atlas,
/// and the strokes that made them.

#include "base/Image.h"
#include "base/Param.h"
#include "base/Result.h"
#include "scene/Atlas.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lucent::scene {

inline constexpr float kLeastSharpness = 1.0f / 16, kMostSharpness = 16;

/// What a brush changes.
enum class PaintMap : int {
    Translucency, ///< t
    Blur,         ///< 1 / M_d: 2 spreads light twice as far; blended by its logarithm
    Glow,         ///< M_i: brightness and colour of what is scattered
    Outgoing      ///< what leaves: paint on top
};

struct Brush {
    PaintMap map = PaintMap::Translucency;
    vec3 value{1};          ///< aimed at; Translucency and Blur take x
    float radius = 0.05f;   ///< m in the world, > 0
    float hardness = 0.5f;  ///< [0,1]: share of the radius in which a dab has its full strength
    float strength = 1;     ///< [0,1] of the value after one stroke, however its dabs overlap
    bool erase = false;     ///< aims at how the object began instead: see startOf()
    bool symmetric = false; ///< paints the other side of the object's plane x = 0 as well
};

/// The brush touches the surface.
struct Dab {
    vec3 place{0};        ///< in the object's space, as its mesh is at rest
    vec3 normal{0, 0, 1}; ///< outward there: what faces away more than it keeps its paint
    float pressure = 1;   ///< [0,1], of the radius
};

/// One step of work: dabs of a brush, or all that lies in a box (`fill`), whose edges may be infinite.
struct Stroke {
    Brush brush;
    std::vector<Dab> dabs;
    struct Fill {
        vec3 low, high;  ///< object's space
        float veins = 0; ///< m in the world from one to the next: where the brush is as strong as veinAt()
                         ///< says; 0: it is so everywhere
    };
    std::optional<Fill> fill;
};

/// Maps over an object's Atlas. Light that enters at x_i leaves around it by M_i M_d² R_d(M_d r): eq. 7.4
/// with the factor that keeps what leaves the same for every M_d. Both are taken where light enters,
/// translucency also where it leaves: the share 1 - t of the surface is matt, with the material's `diffuse`
/// as albedo.
struct Painting {
    std::shared_ptr<const Image> entering; ///< 4 channels, square: rgb M_i >= 0, a M_d in [kLeastSharpness,
                                           ///< kMostSharpness]
    std::shared_ptr<const Image> leaving;  ///< 4 channels, as large: rgb factor of the radiance that leaves,
                                           ///< >= 0; a translucency t [0,1]
    std::string enteringFile,
        leavingFile;             ///< as the scene file names them; both empty where strokes made them
    std::string strokesFile;     ///< as the scene file names it; empty: `strokes` stand in the scene
    std::vector<Stroke> strokes; ///< on top of the maps of the files
    float scale = 1;             ///< of the object when they were painted

    int side() const { return entering->width; }
    /// Whether all of it lies on top: it changes what leaves and nothing of what enters.
    bool isOnTop() const;
};

/// Veins of marble at a place, [0,1]: sheets across x, one unit apart and bent by noise (Perlin 1985), 1 in
/// their middle and thin.
float veinAt(vec3 place);

/// What nobody painted changes nothing: the material as it is.
inline constexpr vec4 kUnpainted{1};

/// The translucency that an object begins with, which erasing brings back: what its first stroke fills all of
/// it with, where that is one of translucency; else 1, the material as it is. By hand objects begin opaque:
/// their first stroke fills them with 0.
float startOf(std::span<const Stroke> strokes);

/// The brightest factor of a colour.
inline constexpr float kMostPaint = 1e6f;

/// Sides of maps, texels.
inline constexpr int kLeastPaintSide = 16, kMostPaintSide = 4096, kUsualPaintSide = 512;

/// What makes the maps that strokes paint.
struct PaintSource {
    int side = kUsualPaintSide; ///< texels
};

/// The brush's parameters but its value: "brush", "radius", "hardness", "strength", "erase", "symmetric".
const ParamTable& brushParams();

/// A map of a file with 3 or 4 channels becomes one with 4; alpha is 1 where it has none. Error "NAME: what;
/// expected" for one that is not square, has an illegal side or holds a value out of its range.
Result<std::shared_ptr<const Image>> decodeEntering(std::span<const std::byte> bytes,
                                                    const std::string& name);
Result<std::shared_ptr<const Image>> decodeLeaving(std::span<const std::byte> bytes, const std::string& name);

/// Reads a stroke script: { "lucentStrokes": 1, "strokes": [ ... ] }. Error "NAME:LINE: place is X; must be
/// Y".
Result<std::vector<Stroke>> parseStrokes(std::span<const std::byte> text, const std::string& name);
/// The script that reads back to the same strokes, to the bit.
std::string toJson(std::span<const Stroke> strokes);

/// Paints strokes on an object.
///
/// @param start  maps to begin with, may be null: unpainted ones of `side`
/// @return       Error where the shape does not fit into an atlas of that side
Result<std::shared_ptr<const Painting>> paint(const Object& object, std::span<const Stroke> strokes, int side,
                                              std::shared_ptr<const Image> entering = nullptr,
                                              std::shared_ptr<const Image> leaving = nullptr);

} // namespace lucent::scene
