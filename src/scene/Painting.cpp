#include "scene/Painting.h"

#include "base/Text.h"
#include "scene/Canvas.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lucent::scene {
namespace {

struct Range {
    float least, most;
    const char* words; // "must be ..."
};
constexpr Range kColor{0, kMostPaint, "red, green and blue must be in [0, 1e+06]"};
constexpr Range kSharpness{kLeastSharpness, kMostSharpness, "the sharpness in alpha must be in [0.0625, 16]"};
constexpr Range kTranslucency{0, 1, "the translucency in alpha must be in [0, 1]"};

Result<std::shared_ptr<const Image>> decodeMap(std::span<const std::byte> bytes, const std::string& name,
                                               const Range& alpha) {
    const Result<Image> image = decodeImage(bytes, name, Encoding::Linear);
    if (!image) return image.error();
    if (image->channels < 3)
        return Error{name + ": has " + std::to_string(image->channels) +
                     " channels; painted maps must have 3 or 4"};
    const int side = image->width;
    if (image->height != side || side < kLeastPaintSide || side > kMostPaintSide)
        return Error{name + ": is " + std::to_string(side) + " x " + std::to_string(image->height) +
                     " texels; painted maps must be square, " + std::to_string(kLeastPaintSide) + " to " +
                     std::to_string(kMostPaintSide) + " a side"};
    auto map = std::make_shared<Image>(side, side, 4);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (int c = 0; c < 4; ++c) {
                const float value = c < image->channels ? image->at(x, y)[c] : 1;
                const Range& range = c < 3 ? kColor : alpha;
                if (!(value >= range.least && value <= range.most))
                    return Error{name + ": texel (" + std::to_string(x) + ", " + std::to_string(y) + ") is " +
                                 shortest(value) + "; " + range.words};
                map->at(x, y)[c] = value;
            }
    return std::shared_ptr<const Image>(std::move(map));
}

} // namespace

Result<std::shared_ptr<const Image>> decodeEntering(std::span<const std::byte> bytes,
                                                    const std::string& name) {
    return decodeMap(bytes, name, kSharpness);
}

Result<std::shared_ptr<const Image>> decodeLeaving(std::span<const std::byte> bytes,
                                                   const std::string& name) {
    return decodeMap(bytes, name, kTranslucency);
}

namespace {

// In [0,1), of the corner of a lattice.
float valueAt(glm::ivec3 corner) {
    std::uint32_t n = std::uint32_t(corner.x) * 0x8da6b343u ^ std::uint32_t(corner.y) * 0xd8163841u ^
                      std::uint32_t(corner.z) * 0xcb1ab31fu;
    n = (n ^ n >> 15) * 0x2c1b3c6du;
    n = (n ^ n >> 12) * 0x297a2d39u;
    return float((n ^ n >> 15) >> 8) / float(1 << 24);
}

// Smooth between corners, in [-1,1].
float noiseAt(vec3 place) {
    const vec3 corner = glm::floor(place), part = place - corner;
    const vec3 share = part * part * (3.0f - 2.0f * part);
    float sum = 0;
    for (int i = 0; i < 8; ++i) {
        const glm::ivec3 step(i & 1, i >> 1 & 1, i >> 2);
        const vec3 weight = glm::mix(1.0f - share, share, vec3(step));
        sum += weight.x * weight.y * weight.z * valueAt(glm::ivec3(corner) + step);
    }
    return 2 * sum - 1;
}

} // namespace

float veinAt(vec3 place) {
    constexpr int kOctaves = 5;
    constexpr float kBend = 0.8f; // of the first octave, in units
    float bent = place.x, size = kBend;
    for (int i = 0; i < kOctaves; ++i, size /= 2)
        bent += size * noiseAt(place * (kBend / size) + vec3(float(17 * i)));
    const float away = 2 * std::abs(bent - std::floor(bent + 0.5f)); // from the nearest sheet, [0,1]
    const float near = 1 - away, third = near * near * near;
    return third * third;
}

bool Painting::isOnTop() const {
    return enteringFile.empty() && leavingFile.empty() &&
           std::all_of(strokes.begin(), strokes.end(),
                       [](const Stroke& stroke) { return stroke.brush.map == PaintMap::Outgoing; });
}

float startOf(std::span<const Stroke> strokes) {
    if (strokes.empty() || !strokes.front().fill) return kUnpainted.a;
    const Brush& brush = strokes.front().brush;
    const Stroke::Fill& fill = *strokes.front().fill;
    const bool whole = glm::all(glm::isinf(fill.low)) && glm::all(glm::isinf(fill.high)) && fill.veins == 0;
    const bool starts = whole && !brush.erase && brush.map == PaintMap::Translucency && brush.strength == 1;
    return starts ? brush.value.x : kUnpainted.a;
}

Result<std::shared_ptr<const Painting>> paint(const Object& object, std::span<const Stroke> strokes, int side,
                                              std::shared_ptr<const Image> entering,
                                              std::shared_ptr<const Image> leaving) {
    const auto surface = paintSurfaceOf(object, side);
    if (!surface) return surface.error();
    Canvas canvas(*surface, object.transform.scale, std::move(entering), std::move(leaving), 0);
    for (const Stroke& stroke : strokes)
        canvas.add(stroke);
    Painting painting{canvas.entering(),     canvas.leaving(), "", "", "", {strokes.begin(), strokes.end()},
                      object.transform.scale};
    return std::make_shared<const Painting>(std::move(painting));
}

} // namespace lucent::scene
