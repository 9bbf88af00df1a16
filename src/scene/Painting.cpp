#include "scene/Painting.h"

#include "base/Text.h"
#include "scene/Canvas.h"

#include <cmath>

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

float startOf(std::span<const Stroke> strokes) {
    if (strokes.empty() || !strokes.front().fill) return kUnpainted.a;
    const Brush& brush = strokes.front().brush;
    const Stroke::Fill& fill = *strokes.front().fill;
    const bool whole = glm::all(glm::isinf(fill.low)) && glm::all(glm::isinf(fill.high));
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
