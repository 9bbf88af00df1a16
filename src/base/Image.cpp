#include "base/Image.h"

#include "base/Hdr.h"
#include "base/ImageSize.h"
#include "base/Pfm.h"
#include "base/Stb.h"
#include "base/Text.h"

#include <algorithm>
#include <array>
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

// What an integer file holds, of 8 bits a sample or of 16.
struct Codes {
    int width = 0, height = 0, channels = 0;
    std::unique_ptr<stbi_uc, FreePixels> bytes{};
    std::unique_ptr<stbi_us, FreePixels> words{};
};

// Code values as floats in [0,1], some rows at a time.
class Floats {
public:
    Floats(Codes codes, Encoding encoding)
        : codes_(std::move(codes)), image_(codes_.width, codes_.height, codes_.channels),
          linear_(codes_.words ? 65536 : 256), color_(encoding == Encoding::Srgb ? linear_.size() : 0) {
        for (std::size_t i = 0; i < linear_.size(); ++i)
            linear_[i] = float(i) / float(linear_.size() - 1);
        if (!color_.empty()) std::transform(linear_.begin(), linear_.end(), color_.begin(), linearFromSrgb);
    }
    // @return the picture once it is whole
    std::optional<Image> advance() {
        const int rows = std::max(1, kSamples / (image_.width * image_.channels));
        for (const int end = std::min(y_ + rows, image_.height); y_ < end; ++y_)
            codes_.words ? row(codes_.words.get()) : row(codes_.bytes.get());
        if (y_ < image_.height) return std::nullopt;
        return std::move(image_);
    }

private:
    // Apart: WebAssembly runs a function in its fast form only from a later call on.
    template <class Sample>
    [[gnu::noinline]] void row(const Sample* samples) {
        const std::vector<float>& color = color_.empty() ? linear_ : color_;
        const int length = image_.width * image_.channels, channels = image_.channels;
        const std::size_t begin = std::size_t(y_) * std::size_t(length);
        samples += begin;
        float* const to = image_.pixels.data() + begin;
        for (int i = 0; i < length; ++i)
            to[i] = color[samples[i]];
        for (int i = channels - 1; channels % 2 == 0 && i < length; i += channels) // alpha
            to[i] = linear_[samples[i]];
    }

    static constexpr int kSamples = 200'000; // some milliseconds
    Codes codes_;
    Image image_;
    std::vector<float> linear_, color_; // by code value; color_: empty where they are alike
    int y_ = 0;
};

Error damaged(const std::string& name, std::string_view format, bool truncated) {
    const char* reason = truncated ? "the file ends too early" : stbi_failure_reason();
    return {name + ": " + (reason ? reason : "cannot be decoded") + "; must be a whole " +
            std::string(format) + " file"};
}

// Runs one of stb's decoders.
//
// @param wanted  channels; 0: as many as there are
template <class Sample>
Result<Codes> decodeWith(Decoder<Sample> decode, std::unique_ptr<Sample, FreePixels> Codes::*samples,
                         std::span<const std::byte> bytes, const std::string& name, std::string_view format,
                         int wanted) {
    Source source{bytes};
    Codes codes;
    (codes.*samples)
        .reset(decode(&kCallbacks, &source, &codes.width, &codes.height, &codes.channels, wanted));
    if (!(codes.*samples) || source.exhausted) return damaged(name, format, source.exhausted);
    if (wanted > 0) codes.channels = wanted;
    return codes;
}
Result<Codes> decodeBytesWith(std::span<const std::byte> bytes, const std::string& name,
                              std::string_view format, int wanted) {
    return decodeWith<stbi_uc>(stbi_load_from_callbacks, &Codes::bytes, bytes, name, format, wanted);
}

std::uint32_t bigEndian(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i)
        value = value << 8 | std::uint32_t(bytes[i]);
    return value;
}

// Width and height, which stand at fixed places of a PNG file.
dvec2 pngSize(std::span<const std::byte> bytes) { return {bigEndian(bytes, 16), bigEndian(bytes, 20)}; }

// At most: what is transparent may be told by a colour or a palette.
int pngChannels(std::span<const std::byte> bytes) {
    const bool isGrey = bytes[25] == std::byte(0), isGreyAlpha = bytes[25] == std::byte(4);
    return isGrey || isGreyAlpha ? 2 : 4;
}

// CRC-32 as PNG has it (RFC 1950's polynomial, reflected). zlib's is faster, but its tables would add 8 KB to
// a page.
std::uint32_t checksum(std::span<const std::byte> bytes) {
    static const auto table = [] {
        std::array<std::uint32_t, 256> table{};
        for (std::uint32_t i = 0; i < table.size(); ++i) {
            std::uint32_t crc = i;
            for (int bit = 0; bit < 8; ++bit)
                crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
            table[i] = crc;
        }
        return table;
    }();
    std::uint32_t crc = ~0u;
    for (const std::byte byte : bytes)
        crc = crc >> 8 ^ table[(crc ^ std::uint32_t(byte)) & 0xff];
    return ~crc;
}

// stb looks at none of the checksums that follow the chunks. What is cut short it notices itself.
Status checkChunks(std::span<const std::byte> bytes, const std::string& name) {
    constexpr std::size_t kSignature = 8, kFrame = 12; // length, type and checksum
    for (std::size_t at = kSignature; bytes.size() - at >= kFrame;) {
        const std::size_t length = bigEndian(bytes, at);
        if (length > bytes.size() - at - kFrame) break;
        const auto covered = bytes.subspan(at + 4, length + 4);
        if (bigEndian(bytes, at + 8 + length) != checksum(covered))
            return Error{name + ": the chunk at byte " + std::to_string(at) +
                         " has another checksum; must be a whole PNG file"};
        at += kFrame + length;
    }
    return Done{};
}

Status checkPng(std::span<const std::byte> bytes, const std::string& name) {
    if (bytes.size() < 26) return damaged(name, "PNG", true);
    const dvec2 side = pngSize(bytes);
    if (Status size = checkImageSize(side.x, side.y, pngChannels(bytes), name); !size) return size.error();
    return checkChunks(bytes, name);
}

Result<Codes> decodeChecked(std::span<const std::byte> bytes, const std::string& name, int wanted) {
    if (bytes[24] == std::byte(16)) // bits a sample
        return decodeWith<stbi_us>(stbi_load_16_from_callbacks, &Codes::words, bytes, name, "PNG", wanted);
    return decodeBytesWith(bytes, name, "PNG", wanted);
}

Result<Codes> decodePng(std::span<const std::byte> bytes, const std::string& name, int wanted) {
    if (Status sound = checkPng(bytes, name); !sound) return sound.error();
    return decodeChecked(bytes, name, wanted);
}

// A PNG file whose pixels are stored as they are in place of packed (RFC 1951, 3.2.4), without checksums:
// what stb has still to do then takes half as long. Nothing where it cannot be unpacked.
std::optional<Bytes> unpackedPng(std::span<const std::byte> bytes) {
    constexpr std::size_t kSignature = 8, kFrame = 12, kMostStored = 65535;
    constexpr std::uint32_t kIdat = 0x49444154, kIend = 0x49454e44;
    Bytes out(bytes.begin(), bytes.begin() + kSignature), packed;
    for (std::size_t at = kSignature; bytes.size() - at >= kFrame;) {
        const std::size_t length = bigEndian(bytes, at);
        if (length > bytes.size() - at - kFrame) return std::nullopt;
        const auto chunk = bytes.subspan(at, kFrame + length);
        const std::uint32_t type = bigEndian(bytes, at + 4);
        if (type == kIdat)
            packed.insert(packed.end(), chunk.begin() + 8, chunk.end() - 4);
        else if (type != kIend)
            out.insert(out.end(), chunk.begin(), chunk.end());
        at += chunk.size();
    }
    const dvec2 side = pngSize(bytes);
    const double guess = side.x * side.y * pngChannels(bytes) + side.y;
    int size = 0;
    const std::unique_ptr<char, FreePixels> raw(stbi_zlib_decode_malloc_guesssize_headerflag(
        reinterpret_cast<const char*>(packed.data()), int(packed.size()), int(std::min(guess, 1e8)), &size,
        1));
    if (!raw) return std::nullopt;
    const auto put = [&](std::uint32_t value, int count) { // the highest byte first
        while (count-- > 0)
            out.push_back(std::byte(value >> 8 * count & 0xff));
    };
    const std::size_t all = std::size_t(size), blocks = (all + kMostStored - 1) / kMostStored;
    out.reserve(out.size() + all + 5 * blocks + 2 * kFrame + 6);
    put(std::uint32_t(2 + 5 * blocks + all + 4), 4);
    put(kIdat, 4);
    put(0x7801, 2);
    for (std::size_t at = 0; at < all; at += kMostStored) {
        const std::size_t stored = std::min(kMostStored, all - at);
        const auto swapped = std::uint32_t((stored << 8 & 0xff00) | stored >> 8);
        put(at + stored == all, 1);
        put(swapped, 2);
        put(~swapped & 0xffff, 2);
        const auto* from = reinterpret_cast<const std::byte*>(raw.get() + at);
        out.insert(out.end(), from, from + stored);
    }
    put(0, 4); // checksums that nobody looks at
    put(0, 4);
    put(0, 4);
    put(kIend, 4);
    put(0, 4);
    return out;
}

// Where stb would find the marker behind `at`: fill bytes, what is stuffed into the coded picture and its
// restarts are passed. The end of the file when there is none.
std::size_t nextMarker(std::span<const std::byte> bytes, std::size_t at) {
    for (; at + 1 < bytes.size(); ++at) {
        const unsigned code = unsigned(bytes[at + 1]);
        const bool isRestart = code >= 0xd0 && code <= 0xd7;
        if (bytes[at] == std::byte(0xff) && code != 0xff && code != 0 && !isRestart) return at + 1;
    }
    return bytes.size();
}

// Whether every Huffman table has at most the 256 codes that stb has room for: it does not look.
bool hasSoundTables(std::span<const std::byte> bytes) {
    constexpr unsigned kEnd = 0xd9, kTables = 0xc4;
    const auto byteAt = [&](std::size_t at) { return at < bytes.size() ? std::size_t(bytes[at]) : 0; };
    for (std::size_t at = nextMarker(bytes, 2); at < bytes.size() && byteAt(at) != kEnd;) {
        const std::size_t length = byteAt(at + 1) << 8 | byteAt(at + 2), end = at + 1 + length;
        for (std::size_t table = at + 3; byteAt(at) == kTables && table < end;) {
            std::size_t codes = 0;
            for (std::size_t i = 1; i <= 16; ++i) // numbers of codes by length, behind the table's name
                codes += byteAt(table + i);
            if (codes > 256) return false;
            table += 17 + codes;
        }
        at = nextMarker(bytes, std::max(end, at + 1));
    }
    return true;
}

Result<Codes> decodeJpeg(std::span<const std::byte> bytes, const std::string& name, int wanted) {
    if (!hasSoundTables(bytes))
        return Error{name + ": has a Huffman table of more than 256 codes; must be a whole JPEG file"};
    Source source{bytes};
    int width = 0, height = 0, channels = 0;
    if (!stbi_info_from_callbacks(&kCallbacks, &source, &width, &height, &channels))
        return damaged(name, "JPEG", source.exhausted);
    if (Status size = checkImageSize(width, height, channels, name); !size) return size.error();
    return decodeBytesWith(bytes, name, "JPEG", wanted);
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

std::uint8_t byteOf(float value) { return std::uint8_t(std::lround(255 * std::clamp(value, 0.0f, 1.0f))); }

Bytes encodePng(const Image& image) {
    std::vector<std::uint8_t> samples(image.pixels.size());
    std::transform(image.pixels.begin(), image.pixels.end(), samples.begin(), byteOf);
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

bool isPng(std::span<const std::byte> bytes) { return startsWith(bytes, "\x89PNG\r\n\x1a\n"); }
bool isCoded(std::span<const std::byte> bytes) { return isPng(bytes) || startsWith(bytes, "\xff\xd8\xff"); }
Result<Codes> decodeCodes(std::span<const std::byte> bytes, const std::string& name, int wanted) {
    return isPng(bytes) ? decodePng(bytes, name, wanted) : decodeJpeg(bytes, name, wanted);
}

Image withFourChannels(const Image& image) {
    Image whole(image.width, image.height, 4);
    const int colors = image.channels < 3 ? 1 : 3;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float* from = image.at(x, y);
            for (int c = 0; c < 3; ++c)
                whole.at(x, y)[c] = from[c % colors];
            whole.at(x, y)[3] = image.channels > colors ? from[colors] : 1;
        }
    return whole;
}

std::string pixelName(const Image& image, std::size_t sample) {
    const std::size_t pixel = sample / std::size_t(image.channels), width = std::size_t(image.width);
    return "pixel (" + std::to_string(pixel % width) + ", " + std::to_string(pixel / width) + ")";
}

} // namespace

Status checkImageSize(double width, double height, int channels, const std::string& name) {
    const auto legal = [](double side) {
        return side >= 1 && side <= kMaxImageSide && side == std::floor(side);
    };
    const double pixels = width * height, bytes = pixels * channels * double(sizeof(float));
    if (legal(width) && legal(height) && pixels <= kMaxImagePixels && bytes > kMaxImageBytes)
        return Error{name + ": is " + shortest(width) + " x " + shortest(height) + " pixels of " +
                     std::to_string(channels) + " channels; must be at most " +
                     shortest(kMaxImageBytes / channels / sizeof(float)) + " pixels of so many"};
    if (legal(width) && legal(height) && pixels <= kMaxImagePixels) return Done{};
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
    if (isCoded(bytes)) {
        Result<Codes> codes = decodeCodes(bytes, name, 0);
        if (!codes) return codes.error();
        Floats floats(std::move(*codes), encoding);
        for (;;)
            if (std::optional<Image> image = floats.advance()) return std::move(*image);
    }
    if (isHdr(bytes)) return decodeHdr(bytes, name);
    if (isPfm(bytes)) return decodePfm(bytes, name);
    if (startsWith(bytes, "\x76\x2f\x31\x01"))
        return Error{name + ": is an EXR file, whose reader is not here" + kKinds};
    return Error{name + ": is of an unknown kind" + kKinds};
}

struct ImageReading::State {
    Bytes bytes;
    std::string name;
    Encoding encoding;
    std::unique_ptr<HdrReading> rows{};
    std::optional<Floats> floats{};
    bool isChecked = false, isUnpacked = false; // of a large PNG

    std::optional<Result<Image>> advance() {
        if (rows) return rows->advance();
        if (floats) {
            std::optional<Image> image = floats->advance();
            return image ? std::optional<Result<Image>>(std::move(*image)) : std::nullopt;
        }
        if (isHdr(bytes)) {
            rows = std::make_unique<HdrReading>(std::move(bytes), name);
            return std::nullopt;
        }
        if (!isCoded(bytes)) return decodeImage(bytes, name, encoding);
        constexpr std::size_t kLarge = 100'000; // bytes: less takes some milliseconds
        if (isPng(bytes) && bytes.size() > kLarge && !isUnpacked) {
            const Status sound = isChecked ? Status(Done{}) : checkPng(bytes, name);
            if (!sound) return Result<Image>(sound.error());
            if (isChecked)
                if (std::optional<Bytes> unpacked = unpackedPng(bytes)) bytes = std::move(*unpacked);
            isUnpacked = isChecked;
            isChecked = true;
            return std::nullopt;
        }
        Result<Codes> codes = isUnpacked ? decodeChecked(bytes, name, 0) : decodeCodes(bytes, name, 0);
        if (!codes) return Result<Image>(codes.error());
        floats.emplace(std::move(*codes), encoding);
        return std::nullopt;
    }
};

ImageReading::ImageReading(Bytes bytes, std::string name, Encoding encoding)
    : state_(std::make_unique<State>(State{std::move(bytes), std::move(name), encoding})) {}
ImageReading::~ImageReading() = default;

std::optional<Result<Image>> ImageReading::advance() { return state_->advance(); }
std::size_t ImageReading::bytes() const {
    const bool isBegun = state_->rows || state_->floats;
    return isBegun || isHdr(state_->bytes) ? 0 : state_->bytes.size();
}

Result<ByteImage> decodeBytes(std::span<const std::byte> bytes, const std::string& name) {
    ByteImage image;
    const auto take = [&](ivec2 size, const auto* samples, auto byteOf) {
        image.size = size;
        image.values.resize(4 * std::size_t(size.x) * std::size_t(size.y));
        std::transform(samples, samples + image.values.size(), image.values.begin(), byteOf);
    };
    if (isCoded(bytes)) {
        const Result<Codes> codes = decodeCodes(bytes, name, 4);
        if (!codes) return codes.error();
        const ivec2 size(codes->width, codes->height);
        if (codes->bytes) {
            const stbi_uc* from = codes->bytes.get();
            image = {size, {from, from + 4 * std::size_t(size.x) * std::size_t(size.y)}};
        } else {
            take(size, codes->words.get(), [](stbi_us value) { return std::uint8_t((value + 128) / 257); });
        }
        return image;
    }
    const Result<Image> floats = decodeImage(bytes, name, Encoding::Linear);
    if (!floats) return floats.error();
    take(floats->size(), withFourChannels(*floats).pixels.data(), byteOf);
    return image;
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
