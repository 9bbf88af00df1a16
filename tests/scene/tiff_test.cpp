// TIFF files as libtiff writes them, and what the loader then reads.
#include "scene/readers/Png16.h"
#include "scene/readers/Readers.h"
#include "scene/readers/Tiff.h"

#include <gtest/gtest.h>
#include <tiffio.h>

#include <cmath>

namespace lucent::scene {
namespace {

constexpr int kWidth = 37, kHeight = 21; // no multiple of a tile

struct Kind {
    int channels = 1, bits = 16;
    bool isFloat = false, isPlanar = false, isTiled = false;
    int compression = COMPRESSION_NONE;
    const char* mode = "wl"; ///< byte order: l or b
};

double valueAt(int x, int y, int channel) { return double((x * 31 + y * 57 + channel * 101) % 256) / 255; }

void store(std::uint8_t* to, const Kind& kind, double value) {
    const auto number = std::uint16_t(std::lround(value * (kind.bits == 8 ? 255 : 65535)));
    const auto real = float(4 * value - 1);
    if (kind.isFloat)
        std::memcpy(to, &real, sizeof real);
    else if (kind.bits == 8)
        *to = std::uint8_t(number);
    else
        std::memcpy(to, &number, sizeof number);
}

/// A row of all channels, or of one where each has its plane.
std::vector<std::uint8_t> rowOf(const Kind& kind, int y, int plane) {
    const int together = kind.isPlanar ? 1 : kind.channels, bytes = kind.bits / 8;
    std::vector<std::uint8_t> row(std::size_t(kWidth * together * bytes));
    for (int i = 0; i < kWidth * together; ++i)
        store(&row[std::size_t(i * bytes)], kind, valueAt(i / together, y, plane + i % together));
    return row;
}

void writeTiles(TIFF* tiff, const Kind& kind) {
    constexpr int kSide = 16;
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, kSide);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, kSide);
    const int bytes = kind.bits / 8;
    std::vector<std::uint8_t> tile(std::size_t(kSide * kSide * kind.channels * bytes));
    for (int top = 0; top < kHeight; top += kSide)
        for (int left = 0; left < kWidth; left += kSide) {
            for (int i = 0; i < kSide * kSide * kind.channels; ++i) {
                const int x = left + i / kind.channels % kSide, y = top + i / kind.channels / kSide;
                store(&tile[std::size_t(i * bytes)], kind, valueAt(x, y, i % kind.channels));
            }
            TIFFWriteTile(tiff, tile.data(), std::uint32_t(left), std::uint32_t(top), 0, 0);
        }
}

Bytes written(const Kind& kind) {
    const std::string path = testing::TempDir() + "lucent_tiff_test.tif";
    TIFF* tiff = TIFFOpen(path.c_str(), kind.mode);
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, kWidth);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kHeight);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, kind.channels);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, kind.bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, kind.isFloat ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, kind.isPlanar ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, kind.channels >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, kind.compression);
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 8);
    if (kind.isTiled) writeTiles(tiff, kind);
    for (int plane = 0; plane < (kind.isPlanar ? kind.channels : 1) && !kind.isTiled; ++plane)
        for (int y = 0; y < kHeight; ++y)
            TIFFWriteScanline(tiff, rowOf(kind, y, plane).data(), std::uint32_t(y), std::uint16_t(plane));
    TIFFClose(tiff);
    return *readFile(path);
}

TEST(Tiff, KeepsTheValuesOfIntegersAndFloatsHoweverTheyAreStored) {
    const Kind kinds[] = {{},
                          {.mode = "wb"},
                          {.channels = 3},
                          {.channels = 4, .compression = COMPRESSION_LZW},
                          {.channels = 3, .isPlanar = true},
                          {.channels = 3, .isTiled = true, .compression = COMPRESSION_ADOBE_DEFLATE},
                          {.channels = 3, .bits = 8},
                          {.bits = 32, .isFloat = true},
                          {.channels = 3, .bits = 32, .isFloat = true, .mode = "wb"}};
    for (const Kind& kind : kinds) {
        const Bytes file = written(kind);
        EXPECT_TRUE(isForeign("a", file));
        const Result<Bytes> plain = toPlain("a.tif", file, readFile);
        ASSERT_TRUE(plain) << plain.error().message;
        EXPECT_EQ(plainName("a.tif", *plain), kind.isFloat ? "a.pfm" : "a.png");
        const Result<Image> image = decodeImage(*plain, "a.tif", Encoding::Linear);
        ASSERT_TRUE(image) << image.error().message;
        ASSERT_EQ(image->size(), ivec2(kWidth, kHeight));
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                for (int c = 0; c < kind.channels; ++c) {
                    const double value = valueAt(x, y, c), wanted = kind.isFloat ? 4 * value - 1 : value;
                    ASSERT_NEAR(image->at(x, y)[c], wanted, 1e-5)
                        << x << " " << y << " " << c << " " << kind.bits;
                }
    }
}

TEST(Tiff, WhatIsCutShortOrOfAnotherKindIsRefused) {
    Bytes half = written({});
    half.resize(40);
    const Result<Bytes> cut = plainTiff(half, "half.tif");
    ASSERT_FALSE(cut);
    EXPECT_TRUE(cut.error().message.starts_with("half.tif: ")) << cut.error().message;
    EXPECT_TRUE(cut.error().message.ends_with("; must be a whole TIFF file")) << cut.error().message;
    EXPECT_EQ(plainTiff(written({.bits = 64, .isFloat = true}), "a.tif").error().message,
              "a.tif: has 1 channels of 64-bit floats; must have 1 to 4 of 32-bit ones");
}

TEST(Png16, HoldsEveryValueOfSixteenBits) {
    for (int channels = 1; channels <= 4; ++channels) {
        Image image(64, 256, channels);
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            image.pixels[i] = float(i * 7 % 65536) / 65535;
        const Result<Image> back = decodeImage(encodePng16(image), "a.png", Encoding::Linear);
        ASSERT_TRUE(back) << back.error().message;
        EXPECT_EQ(back->channels, channels);
        EXPECT_EQ(back->pixels, image.pixels);
    }
}

} // namespace
} // namespace lucent::scene
