#include "scene/ImageUse.h"

#include "base/Log.h"
#include "base/Text.h"
#include "scene/Scene.h"

#include <algorithm>
#include <cmath>

namespace lucent::scene {
namespace {

using SharedImage = std::shared_ptr<const Image>;

// One value a pixel, computed by `value(const float* pixel, int channels)`.
template <class Value>
Image toOneChannel(const Image& image, Value value) {
    Image out(image.width, image.height, 1);
    for (std::size_t i = 0; i < out.pixels.size(); ++i)
        out.pixels[i] = value(&image.pixels[i * std::size_t(image.channels)], image.channels);
    return out;
}

float greyOf(const float* pixel, int channels) {
    return channels <= 2 ? pixel[0] : (pixel[0] + pixel[1] + pixel[2]) / 3;
}

float coverageOf(const float* pixel, int channels) {
    return channels % 2 == 0 ? pixel[channels - 1] : greyOf(pixel, channels);
}

// First value of a picture outside [min, max], NaN included.
Status checkValues(const Image& image, float min, float max, const std::string& name,
                   const std::string& rule) {
    const auto bad = std::find_if(image.pixels.begin(), image.pixels.end(),
                                  [&](float v) { return !(v >= min && v <= max); });
    if (bad == image.pixels.end()) return Done{};
    const int texel = int((bad - image.pixels.begin()) / image.channels);
    return Error{name + ": texel (" + std::to_string(texel % image.width) + ", " +
                 std::to_string(texel / image.width) + ") is " + shortest(*bad) + "; " + rule};
}

Result<SharedImage> share(Image image, float min, float max, const std::string& name,
                          const std::string& rule) {
    if (Status legal = checkValues(image, min, max, name, rule); !legal) return legal.error();
    return SharedImage(std::make_shared<Image>(std::move(image)));
}

Image withThreeChannels(Image image) {
    if (image.channels == 3) return image;
    Image colors(image.width, image.height, 3);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < 3; ++c)
                colors.at(x, y)[c] = image.at(x, y)[image.channels >= 3 ? c : 0];
    return colors;
}

Result<SharedImage> sharedColors(Image image, const std::string& name) {
    constexpr float kMost = std::numeric_limits<float>::max();
    return share(withThreeChannels(std::move(image)), -kMost, kMost, name, "colours must be finite");
}

} // namespace

Result<SharedImage> decodeColors(std::span<const std::byte> bytes, const std::string& name) {
    Result<Image> image = decodeImage(bytes, name, Encoding::Srgb);
    if (!image) return image.error();
    return sharedColors(std::move(*image), name);
}

struct ColorsMaking::State {
    std::string name;
    ReadFile read;
    std::unique_ptr<ImageReading> reading{};
    std::optional<Image> image{}; // as the file has it

    std::optional<Result<SharedImage>> advance() {
        if (image) return sharedColors(std::move(*image), name);
        if (!reading) return begin();
        std::optional<Result<Image>> read = reading->advance();
        if (!read) return std::nullopt;
        if (!*read) return Result<SharedImage>(read->error());
        image = std::move(**read);
        return std::nullopt;
    }
    std::optional<Result<SharedImage>> begin() {
        Result<Bytes> bytes = read(name);
        if (!bytes) return Result<SharedImage>(bytes.error());
        reading = std::make_unique<ImageReading>(std::move(*bytes), name, Encoding::Srgb);
        return std::nullopt;
    }
};

ColorsMaking::ColorsMaking(std::string name, ReadFile read)
    : state_(std::make_unique<State>(State{.name = std::move(name), .read = std::move(read)})) {}
ColorsMaking::~ColorsMaking() = default;

std::optional<Result<SharedImage>> ColorsMaking::advance() { return state_->advance(); }
std::size_t ColorsMaking::bytes() const { return state_->reading ? state_->reading->bytes() : 0; }

namespace {

// Each texel the mean of four; of odd sides the last is left out.
Image halved(const Image& image) {
    Image half(std::max(1, image.width / 2), std::max(1, image.height / 2), image.channels);
    const ivec2 step = glm::min(image.size() - 1, ivec2(1));
    for (int y = 0; y < half.height; ++y)
        for (int x = 0; x < half.width; ++x)
            for (int c = 0; c < half.channels; ++c) {
                const auto at = [&](int dx, int dy) {
                    return image.at(2 * x * step.x + dx, 2 * y * step.y + dy)[c];
                };
                half.at(x, y)[c] = (at(0, 0) + at(step.x, 0) + at(0, step.y) + at(step.x, step.y)) / 4;
            }
    return half;
}

} // namespace

Result<SharedImage> decodePicture(std::span<const std::byte> bytes, const std::string& name) {
    Result<SharedImage> colors = decodeColors(bytes, name);
    if (!colors) return colors;
    constexpr float kMost = std::numeric_limits<float>::max();
    if (Status legal = checkValues(**colors, 0, kMost, name, "what a lamp projects must be at least 0");
        !legal)
        return legal.error();
    const ivec2 whole = (*colors)->size();
    while (std::max((*colors)->width, (*colors)->height) > kMostPictureSide)
        *colors = std::make_shared<const Image>(halved(**colors));
    if ((*colors)->size() != whole)
        warnOnce(name + ": is projected with " + std::to_string((*colors)->width) + " x " +
                 std::to_string((*colors)->height) + " pixels, of " + std::to_string(whole.x) + " x " +
                 std::to_string(whole.y));
    return colors;
}

Result<SharedImage> decodeHeights(std::span<const std::byte> bytes, const std::string& name) {
    const Result<Image> image = decodeImage(bytes, name, Encoding::Linear);
    return image ? heightsOf(*image, name) : image.error();
}
Result<SharedImage> heightsOf(const Image& image, const std::string& name) {
    return share(toOneChannel(image, greyOf), -1e9f, 1e9f, name,
                 "heights must be finite, at most 1e9 in size");
}

Result<SharedImage> decodeAlpha(std::span<const std::byte> bytes, const std::string& name) {
    const Result<Image> image = decodeImage(bytes, name, Encoding::Linear);
    if (!image) return image.error();
    return share(toOneChannel(*image, coverageOf), 0, 1, name, "alpha must be in [0, 1]");
}

} // namespace lucent::scene
