#include "base/Image.h"

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

bool isAlpha(int channel, int channels) { return channels % 2 == 0 && channel == channels - 1; }

// Integer code values as floats in [0,1].
Image toFloat(const Image& frame, const auto* samples, int levels, Encoding encoding) {
    std::vector<float> linear(static_cast<std::size_t>(levels)), colour;
    for (int i = 0; i < levels; ++i)
        linear[std::size_t(i)] = float(i) / float(levels - 1);
    colour = linear;
    if (encoding == Encoding::Srgb)
        std::transform(linear.begin(), linear.end(), colour.begin(), linearFromSrgb);
    Image image(frame.width, frame.height, frame.channels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] =
            (isAlpha(int(i % std::size_t(image.channels)), image.channels) ? linear : colour)[samples[i]];
    return image;
}

Error damaged(const std::string& name, std::string_view format, bool truncated) {
    const char* reason = truncated ? "the file ends too early" : stbi_failure_reason();
    return {name + ": " + (reason ? reason : "cannot be decoded") + "; must be a whole " +
            std::string(format) + " file"};
}

// Runs one of stb's decoders and hands its samples to `convert`.
template <class Sample, class Convert>
Result<Image> decodeWith(Decoder<Sample> decode, std::span<const std::byte> bytes, const std::string& name,
                         std::string_view format, Convert convert) {
    Source source{bytes};
    Image frame;
    const std::unique_ptr<Sample, FreePixels> samples(
        decode(&kCallbacks, &source, &frame.width, &frame.height, &frame.channels, 0));
    if (!samples || source.exhausted) return damaged(name, format, source.exhausted);
    return convert(frame, samples.get());
}

// PNG, JPEG or HDR.
Result<Image> decodeStb(std::span<const std::byte> bytes, const std::string& name, std::string_view format,
                        Encoding encoding) {
    if (bytes.size() > 0x7fffffff) return Error{name + ": is larger than 2 GiB; must be smaller"};
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int length = int(bytes.size());
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_memory(data, length, &width, &height, &channels)) return damaged(name, format, false);
    if (Status size = checkImageSize(width, height, name); !size) return size.error();

    if (format == "HDR")
        return decodeWith<float>(
            stbi_loadf_from_callbacks, bytes, name, format, [](Image& image, const float* samples) {
                const std::size_t count =
                    std::size_t(image.width) * std::size_t(image.height) * std::size_t(image.channels);
                image.pixels.assign(samples, samples + count);
                return std::move(image);
            });
    if (stbi_is_16_bit_from_memory(data, length))
        return decodeWith<stbi_us>(stbi_load_16_from_callbacks, bytes, name, format,
                                   [&](const Image& frame, const stbi_us* samples) {
                                       return toFloat(frame, samples, 65536, encoding);
                                   });
    return decodeWith<stbi_uc>(
        stbi_load_from_callbacks, bytes, name, format,
        [&](const Image& frame, const stbi_uc* samples) { return toFloat(frame, samples, 256, encoding); });
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
    if (startsWith(bytes, "\x89PNG\r\n\x1a\n")) return decodeStb(bytes, name, "PNG", encoding);
    if (startsWith(bytes, "\xff\xd8\xff")) return decodeStb(bytes, name, "JPEG", encoding);
    if (startsWith(bytes, "#?")) return decodeStb(bytes, name, "HDR", encoding);
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
