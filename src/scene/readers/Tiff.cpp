#include "scene/readers/Tiff.h"

#include "base/ImageSize.h"
#include "base/Pfm.h"
#include "scene/readers/Png16.h"

#include <tiffio.h>

#include <algorithm>
#include <cstring>
#include <memory>

namespace lucent::scene {
namespace {

// A file in memory as libtiff sees one, and what it complains about.
struct Source {
    std::span<const std::byte> bytes;
    std::size_t at = 0;
    std::string complaint;

    static Source& of(thandle_t handle) { return *static_cast<Source*>(handle); }
    static tmsize_t read(thandle_t handle, void* data, tmsize_t size) {
        Source& source = of(handle);
        const std::size_t left = source.bytes.size() - std::min(source.at, source.bytes.size());
        const std::size_t count = std::min(left, std::size_t(size));
        std::memcpy(data, source.bytes.data() + source.at, count);
        source.at += count;
        return tmsize_t(count);
    }
    static tmsize_t write(thandle_t, void*, tmsize_t) { return 0; }
    static toff_t seek(thandle_t handle, toff_t offset, int whence) {
        Source& source = of(handle);
        const std::size_t from = whence == SEEK_SET   ? 0
                                 : whence == SEEK_CUR ? source.at
                                                      : source.bytes.size();
        return source.at = from + std::size_t(offset);
    }
    static int close(thandle_t) { return 0; }
    static toff_t size(thandle_t handle) { return of(handle).bytes.size(); }
    static int complain(TIFF*, void* user, const char*, const char* format, va_list arguments) {
        char text[200];
        std::vsnprintf(text, sizeof text, format, arguments);
        static_cast<Source*>(user)->complaint = text;
        return 1; // nothing is printed
    }
    static int ignore(TIFF*, void*, const char*, const char*, va_list) { return 1; }
};

struct Close {
    void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using Tiff = std::unique_ptr<TIFF, Close>;

Tiff open(Source& source) {
    const std::unique_ptr<TIFFOpenOptions, decltype(&TIFFOpenOptionsFree)> options(TIFFOpenOptionsAlloc(),
                                                                                   TIFFOpenOptionsFree);
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), Source::complain, &source);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), Source::ignore, &source);
    return Tiff(TIFFClientOpenExt("", "rm", &source, Source::read, Source::write, Source::seek, Source::close,
                                  Source::size, nullptr, nullptr, options.get()));
}

template <class Value>
Value field(TIFF* tiff, std::uint32_t tag) {
    Value value{};
    TIFFGetFieldDefaulted(tiff, tag, &value);
    return value;
}

struct Layout {
    int width = 0, height = 0, channels = 0, bits = 0;
    bool isFloat = false, isPlanar = false, isTiled = false, isInverted = false;

    std::size_t sampleBytes() const { return std::size_t(bits) / 8; }
};

Layout layoutOf(TIFF* tiff) {
    Layout layout;
    layout.width = int(std::min(field<std::uint32_t>(tiff, TIFFTAG_IMAGEWIDTH), std::uint32_t(1) << 30));
    layout.height = int(std::min(field<std::uint32_t>(tiff, TIFFTAG_IMAGELENGTH), std::uint32_t(1) << 30));
    layout.channels = field<std::uint16_t>(tiff, TIFFTAG_SAMPLESPERPIXEL);
    layout.bits = field<std::uint16_t>(tiff, TIFFTAG_BITSPERSAMPLE);
    layout.isFloat = field<std::uint16_t>(tiff, TIFFTAG_SAMPLEFORMAT) == SAMPLEFORMAT_IEEEFP;
    layout.isPlanar = field<std::uint16_t>(tiff, TIFFTAG_PLANARCONFIG) == PLANARCONFIG_SEPARATE;
    layout.isInverted = field<std::uint16_t>(tiff, TIFFTAG_PHOTOMETRIC) == PHOTOMETRIC_MINISWHITE;
    layout.isTiled = TIFFIsTiled(tiff) != 0;
    return layout;
}

float sampleAt(const Layout& layout, const std::byte* bytes) {
    if (layout.isFloat) {
        float value;
        std::memcpy(&value, bytes, sizeof value);
        return value;
    }
    std::uint16_t value;
    std::memcpy(&value, bytes, sizeof value);
    const float share = float(value) / 65535;
    return layout.isInverted ? 1 - share : share;
}

// Strips and tiles alike: blocks of the picture, one after the other, of all channels or of one.
bool readBlocks(TIFF* tiff, const Layout& layout, Image& image) {
    const int blockWidth = layout.isTiled ? int(field<std::uint32_t>(tiff, TIFFTAG_TILEWIDTH)) : layout.width;
    const auto rows = field<std::uint32_t>(tiff, layout.isTiled ? TIFFTAG_TILELENGTH : TIFFTAG_ROWSPERSTRIP);
    const int blockHeight = int(std::min(rows, std::uint32_t(layout.height)));
    if (blockWidth < 1 || blockHeight < 1) return false;
    const int planes = layout.isPlanar ? layout.channels : 1, together = layout.channels / planes;
    const tmsize_t size = layout.isTiled ? TIFFTileSize(tiff) : TIFFStripSize(tiff);
    std::vector<std::byte> block(std::size_t(std::max<tmsize_t>(size, 0)));
    std::uint32_t number = 0;
    for (int plane = 0; plane < planes; ++plane)
        for (int top = 0; top < layout.height; top += blockHeight)
            for (int left = 0; left < layout.width; left += blockWidth, ++number) {
                const tmsize_t got = layout.isTiled ? TIFFReadEncodedTile(tiff, number, block.data(), size)
                                                    : TIFFReadEncodedStrip(tiff, number, block.data(), size);
                const int bottom = std::min(top + blockHeight, layout.height);
                const int right = std::min(left + blockWidth, layout.width);
                const std::size_t row = std::size_t(blockWidth * together) * layout.sampleBytes();
                if (got < tmsize_t(row * std::size_t(bottom - top))) return false;
                for (int y = top; y < bottom; ++y) {
                    const std::byte* sample = block.data() + std::size_t(y - top) * row;
                    for (int x = left; x < right; ++x)
                        for (int c = 0; c < together; ++c, sample += layout.sampleBytes())
                            image.at(x, y)[plane + c] = sampleAt(layout, sample);
                }
            }
    return true;
}

// What libtiff makes of any picture that it knows.
bool readColors(TIFF* tiff, Image& image) {
    std::vector<std::uint32_t> pixels(std::size_t(image.width) * std::size_t(image.height));
    if (!TIFFReadRGBAImageOriented(tiff, std::uint32_t(image.width), std::uint32_t(image.height),
                                   pixels.data(), ORIENTATION_TOPLEFT, 1))
        return false;
    for (std::size_t i = 0; i < pixels.size(); ++i)
        for (int c = 0; c < 4; ++c)
            image.pixels[4 * i + std::size_t(c)] = float(pixels[i] >> 8 * c & 255) / 255;
    return true;
}

// The first of two channels, where a form has none for the second.
Image firstOf(const Image& image) {
    Image out(image.width, image.height, 1);
    for (std::size_t i = 0; i < out.pixels.size(); ++i)
        out.pixels[i] = image.pixels[i * std::size_t(image.channels)];
    return out;
}

} // namespace

bool isTiff(std::span<const std::byte> bytes) {
    constexpr std::string_view kStarts[] = {{"II*\0", 4}, {"MM\0*", 4}, {"II+\0", 4}, {"MM\0+", 4}};
    return std::any_of(std::begin(kStarts), std::end(kStarts), [&](std::string_view start) {
        return bytes.size() >= 4 && std::memcmp(bytes.data(), start.data(), 4) == 0;
    });
}

Result<Bytes> plainTiff(std::span<const std::byte> bytes, const std::string& name) {
    Source source{bytes, 0, {}};
    const Tiff tiff = open(source);
    const auto damaged = [&] {
        return Error{name + ": " + source.complaint + "; must be a whole TIFF file"};
    };
    if (!tiff) return damaged();
    const Layout layout = layoutOf(tiff.get());
    const bool isExact = layout.channels <= 4 && (layout.isFloat ? layout.bits == 32 : layout.bits == 16);
    if (layout.isFloat && !isExact)
        return Error{name + ": has " + std::to_string(layout.channels) + " channels of " +
                     std::to_string(layout.bits) + "-bit floats; must have 1 to 4 of 32-bit ones"};
    const int channels = isExact ? layout.channels : 4;
    if (Status size = checkImageSize(layout.width, layout.height, channels, name); !size) return size.error();
    Image image(layout.width, layout.height, channels);
    if (!(isExact ? readBlocks(tiff.get(), layout, image) : readColors(tiff.get(), image))) return damaged();
    if (!layout.isFloat) return encodePng16(image);
    return encodePfm(image.channels == 2 ? firstOf(image) : image);
}

} // namespace lucent::scene
