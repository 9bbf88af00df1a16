#include "base/Image.h"

#include "base/Hdr.h"
#include "base/ImageSize.h"
#include "base/Pfm.h"
#include "base/Stb.h"
#include "base/Text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>

namespace lucent {
namespace {

// Feeds stb and notices when it wants more than there is: stb itself fills up what is missing with zeros.
struct Source {
    static constexpr int kRefill = 128; // stb refills its buffer by this much, wanted or not
    std::span<const std::byte> bytes;
    std::size_t at = 0;
    bool exhausted = false;

    static int read(void* user, char* data, int size) {
        auto& source = *static_cast<Source*>(user);
        const std::size_t left = source.bytes.size() - source.at;
        const std::size_t count = std::min(left, std::size_t(size));
        if (left == 0 || (count < std::size_t(size) && size != kRefill)) source.exhausted = true;
        std::memcpy(data, source.bytes.data() + source.at, count);
        source.at += count;
        return int(count);
    }
    static void skip(void* user, int size) {
        auto& source = *static_cast<Source*>(user);
        const std::size_t left = source.bytes.size() - source.at;
        if (std::size_t(size) > left) source.exhausted = true;
        source.at += std::min(left, std::size_t(size));
    }
    static int eof(void* user) {
        auto& source = *static_cast<Source*>(user);
        return source.at == source.bytes.size();
    }
};
constexpr stbi_io_callbacks kCallbacks{Source::read, Source::skip, Source::eof};

struct FreePixels {
    void operator()(void* pixels) const { stbi_image_free(pixels); }
};

template <class Sample>
using Decoder = Sample* (*)(const stbi_io_callbacks*, void*, int*, int*, int*, int);

// Integer code values as floats in [0,1].
template <class Sample>
Image toFloat(Image frame, const Sample* samples, Encoding encoding) {
    constexpr std::size_t kLevels = std::size_t(std::numeric_limits<Sample>::max()) + 1;
    std::vector<float> linear(kLevels);
    for (std::size_t i = 0; i < kLevels; ++i)
        linear[i] = float(i) / float(kLevels - 1);
    std::vector<float> color = linear;
    if (encoding == Encoding::Srgb)
        std::transform(linear.begin(), linear.end(), color.begin(), linearFromSrgb);
    const auto channels = std::size_t(frame.channels);
    frame.pixels.resize(std::size_t(frame.width) * std::size_t(frame.height) * channels);
    for (std::size_t i = 0; i < frame.pixels.size(); ++i) {
        const bool alpha = channels % 2 == 0 && i % channels == channels - 1;
        frame.pixels[i] = (alpha ? linear : color)[samples[i]];
    }
    return frame;
}

Error damaged(const std::string& name, std::string_view format, bool truncated) {
    const char* reason = truncated ? "the file ends too early" : stbi_failure_reason();
    return {name + ": " + (reason ? reason : "cannot be decoded") + "; must be a whole " +
            std::string(format) + " file"};
}

// Runs one of stb's decoders.
template <class Sample>
Result<Image> decodeWith(Decoder<Sample> decode, std::span<const std::byte> bytes, const std::string& name,
                         std::string_view format, Encoding encoding) {
    Source source{bytes};
    Image frame;
    const std::unique_ptr<Sample, FreePixels> samples(
        decode(&kCallbacks, &source, &frame.width, &frame.height, &frame.channels, 0));
    if (!samples || source.exhausted) return damaged(name, format, source.exhausted);
    return toFloat(std::move(frame), samples.get(), encoding);
}

// Width and height, which stand at fixed places of a PNG file.
dvec2 pngSize(std::span<const std::byte> bytes) {
    const auto bigEndian = [&](std::size_t at) {
        double value = 0;
        for (std::size_t i = at; i < at + 4; ++i)
            value = value * 256 + double(bytes[i]);
        return value;
    };
    return {bigEndian(16), bigEndian(20)};
}

Result<Image> decodePng(std::span<const std::byte> bytes, const std::string& name, Encoding encoding) {
    if (bytes.size() < 25) return damaged(name, "PNG", true);
    const dvec2 side = pngSize(bytes);
    if (Status size = checkImageSize(side.x, side.y, name); !size) return size.error();
    if (bytes[24] == std::byte(16)) // bits a sample
        return decodeWith<stbi_us>(stbi_load_16_from_callbacks, bytes, name, "PNG", encoding);
    return decodeWith<stbi_uc>(stbi_load_from_callbacks, bytes, name, "PNG", encoding);
}

Result<Image> decodeJpeg(std::span<const std::byte> bytes, const std::string& name, Encoding encoding) {
    Source source{bytes};
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_callbacks(&kCallbacks, &source, &width, &height, &channels))
        return damaged(name, "JPEG", source.exhausted);
    if (Status size = checkImageSize(width, height, name); !size) return size.error();
    return decodeWith<stbi_uc>(stbi_load_from_callbacks, bytes, name, "JPEG", encoding);
}

bool startsWith(std::span<const std::byte> bytes, std::string_view signature) {
    return bytes.size() >= signature.size() &&
           std::memcmp(bytes.data(), signature.data(), signature.size()) == 0;
}

bool endsWith(std::string_view path, std::string_view ending) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; };
    return path.size() >= ending.size() &&
           std::equal(ending.begin(), ending.end(), path.end() - std::ptrdiff_t(ending.size()),
                      [&](char a, char b) { return a == lower(b); });
}

void append(void* bytes, void* data, int size) {
    const auto* begin = static_cast<const std::byte*>(data);
    auto& out = *static_cast<Bytes*>(bytes);
    out.insert(out.end(), begin, begin + size);
}

Bytes encodePng(const Image& image) {
    std::vector<std::uint8_t> samples(image.pixels.size());
    std::transform(image.pixels.begin(), image.pixels.end(), samples.begin(),
                   [](float v) { return std::uint8_t(std::lround(255 * std::clamp(v, 0.0f, 1.0f))); });
    Bytes bytes;
    stbi_write_png_to_func(append, &bytes, image.width, image.height, image.channels, samples.data(), 0);
    return bytes;
}

Bytes encodeHdr(const Image& image) {
    Bytes bytes;
    stbi_write_hdr_to_func(append, &bytes, image.width, image.height, image.channels, image.pixels.data());
    return bytes;
}

Image withoutAlpha(const Image& image) {
    if (image.channels % 2) return image;
    Image out(image.width, image.height, image.channels - 1);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            std::copy_n(image.at(x, y), out.channels, out.at(x, y));
    return out;
}

std::string pixelName(const Image& image, std::size_t sample) {
    const std::size_t pixel = sample / std::size_t(image.channels), width = std::size_t(image.width);
    return "pixel (" + std::to_string(pixel % width) + ", " + std::to_string(pixel / width) + ")";
}

} // namespace

Status checkImageSize(double width, double height, const std::string& name) {
    const auto legal = [](double side) {
        return side >= 1 && side <= kMaxImageSide && side == std::floor(side);
    };
    if (legal(width) && legal(height) && width * height <= kMaxImagePixels) return Done{};
    return Error{name + ": is " + shortest(width) + " x " + shortest(height) + " pixels; must be 1 to " +
                 std::to_string(kMaxImageSide) + " a side and at most 67 million in all"};
}

float linearFromSrgb(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

float srgbFromLinear(float linear) {
    return linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

Result<Image> decodeImage(std::span<const std::byte> bytes, const std::string& name, Encoding encoding) {
    constexpr const char* kKinds = "; must be a PNG, JPEG, HDR or PFM image";
    if (bytes.empty()) return Error{name + ": is empty" + kKinds};
    if (startsWith(bytes, "\x89PNG\r\n\x1a\n")) return decodePng(bytes, name, encoding);
    if (startsWith(bytes, "\xff\xd8\xff")) return decodeJpeg(bytes, name, encoding);
    if (startsWith(bytes, "#?")) return decodeHdr(bytes, name);
    if (isPfm(bytes)) return decodePfm(bytes, name);
    if (startsWith(bytes, "\x76\x2f\x31\x01"))
        return Error{name + ": is an EXR file, whose reader is not here" + kKinds};
    return Error{name + ": is of an unknown kind" + kKinds};
}

Result<Bytes> encodeImage(const Image& image, const std::string& path) {
    const bool png = endsWith(path, ".png"), hdr = endsWith(path, ".hdr"), pfm = endsWith(path, ".pfm");
    if (!png && !hdr && !pfm)
        return Error{path + ": ends in no known image type; must be .png, .hdr or .pfm"};
    if (pfm) return encodePfm(withoutAlpha(image));
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const float value = image.pixels[i];
        if (!std::isfinite(value) || (hdr && value < 0))
            return Error{path + ": " + pixelName(image, i) + " is " + shortest(value) + "; " +
                         (hdr ? "HDR holds finite values of at least 0" : "PNG holds finite values")};
    }
    return png ? encodePng(image) : encodeHdr(withoutAlpha(image));
}

ivec2 findNonFinite(const Image& image) {
    const auto bad =
        std::find_if(image.pixels.begin(), image.pixels.end(), [](float v) { return !std::isfinite(v); });
    if (bad == image.pixels.end()) return {-1, -1};
    const int pixel = int((bad - image.pixels.begin()) / image.channels);
    return {pixel % image.width, pixel / image.width};
}

} // namespace lucent
