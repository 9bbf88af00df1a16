#include "base/Hdr.h"
#include "base/Image.h"
#include "base/Stb.h"
#include "tests/base/Png.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace lucent {
namespace {

using test::bytesOf;
using test::makePng;

// A picture with different values everywhere, in [0, 1].
Image pattern(int width, int height, int channels) {
    Image image(width, height, channels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = float(i * 37 % 251) / 250;
    return image;
}

void appendTo(void* bytes, void* data, int size) {
    const auto* begin = static_cast<const std::byte*>(data);
    static_cast<Bytes*>(bytes)->insert(static_cast<Bytes*>(bytes)->end(), begin, begin + size);
}

// Number of beginnings of a file that the decoder takes for a whole one.
int acceptedBeginnings(const Bytes& file) {
    int accepted = 0;
    for (std::size_t length = 0; length < file.size(); ++length)
        accepted += decodeImage(std::span(file).first(length), "cut", Encoding::Linear).ok();
    return accepted;
}

Bytes flipped(Bytes file, std::size_t at) {
    file[at] ^= std::byte(1);
    return file;
}

std::string messageOf(const Bytes& file, const std::string& name) {
    const Result<Image> image = decodeImage(file, name, Encoding::Linear);
    return image ? "no error" : image.error().message;
}

TEST(Image, SixteenBitPngKeepsSixteenBits) {
    // 258 = 0x0102, 65535 = white: 258/65535 differs from 1/255 and 2/255, which 8 bits would give.
    const Bytes samples = {std::byte(1), std::byte(2), std::byte(255), std::byte(255)};
    const Result<Image> image = decodeImage(makePng(2, 1, 16, 0, samples), "a.png", Encoding::Linear);
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_EQ(image->channels, 1);
    EXPECT_EQ(image->pixels[0], 258.0f / 65535);
    EXPECT_EQ(image->pixels[1], 1.0f);
}

TEST(Image, EightBitPngIsScaledByTwoHundredFiftyFive) {
    const Result<Image> image =
        decodeImage(makePng(2, 1, 8, 0, {std::byte(51), std::byte(255)}), "a.png", Encoding::Linear);
    ASSERT_TRUE(image);
    EXPECT_EQ(image->pixels[0], 0.2f); // 51 / 255
    EXPECT_EQ(image->pixels[1], 1.0f);
}

TEST(Image, SrgbCurveIsUndoneForColoursButNotForAlpha) {
    const Bytes samples = {std::byte(188), std::byte(10), std::byte(0), std::byte(188)};
    const Result<Image> image = decodeImage(makePng(1, 1, 8, 6, samples), "a.png", Encoding::Srgb);
    ASSERT_TRUE(image);
    // ((188/255 + 0.055) / 1.055)^2.4 = 0.502886; 10/255 lies on the straight part: / 12.92
    EXPECT_NEAR(image->pixels[0], 0.502886, 1e-6);
    EXPECT_NEAR(image->pixels[1], 10 / 255.0 / 12.92, 1e-8);
    EXPECT_EQ(image->pixels[2], 0.0f);
    EXPECT_EQ(image->pixels[3], 188 / 255.0f);
}

TEST(Image, SrgbCurveAndItsInverseMeet) {
    for (int i = 0; i <= 255; ++i)
        EXPECT_NEAR(srgbFromLinear(linearFromSrgb(float(i) / 255)), i / 255.0, 2e-7);
}

TEST(Image, PngFileHoldsEightBitsOfEachChannelCount) {
    for (int channels = 1; channels <= 4; ++channels) {
        const Image image = pattern(5, 3, channels);
        const Result<Bytes> file = encodeImage(image, "a.PNG");
        ASSERT_TRUE(file);
        const Result<Image> back = decodeImage(*file, "a.png", Encoding::Linear);
        ASSERT_TRUE(back);
        ASSERT_EQ(back->pixels.size(), image.pixels.size());
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            EXPECT_NEAR(back->pixels[i], image.pixels[i], 0.5 / 255 + 1e-6);
    }
}

TEST(Image, PngClampsWhatIsOutsideZeroAndOne) {
    Image image(2, 1, 1);
    image.pixels = {-3, 7};
    const Result<Image> back = decodeImage(*encodeImage(image, "a.png"), "a.png", Encoding::Linear);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->pixels, (std::vector<float>{0, 1}));
}

TEST(Image, PfmKeepsEveryBitAndPutsRowZeroOnTop) {
    for (const int channels : {1, 3}) {
        Image image = pattern(3, 2, channels);
        image.pixels[0] = -1e-38f;
        image.pixels[1] = std::numeric_limits<float>::infinity();
        const Result<Bytes> file = encodeImage(image, "a.pfm");
        ASSERT_TRUE(file);
        const Result<Image> back =
            decodeImage(*file, "a.pfm", Encoding::Srgb); // floats are linear whatever is asked
        ASSERT_TRUE(back);
        EXPECT_EQ(back->channels, channels);
        EXPECT_EQ(back->pixels, image.pixels);
    }
}

TEST(Image, BigEndianPfmIsRead) {
    // 1.5 = 0x3fc00000; a positive scale means big-endian. The file's first row is the bottom one.
    const Bytes file = bytesOf(std::string_view("Pf 1 2 1.0\n\x3f\xc0\0\0\0\0\0\0", 19));
    const Result<Image> image = decodeImage(file, "a.pfm", Encoding::Linear);
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_EQ(image->pixels, (std::vector<float>{0, 1.5f}));
}

TEST(Image, HdrKeepsEightBitsOfMantissa) {
    for (const int width : {3, 40}) { // stored flat below 8 pixels, run-length coded above
        Image image = pattern(width, 2, 3);
        for (float& value : image.pixels)
            value = 1 + value * 40;
        const Result<Bytes> file = encodeImage(image, "a.hdr");
        ASSERT_TRUE(file);
        const Result<Image> back = decodeImage(*file, "a.hdr", Encoding::Linear);
        ASSERT_TRUE(back) << back.error().message;
        for (std::size_t i = 0; i < image.pixels.size();
             ++i) // the exponent is shared: error of the largest channel
            EXPECT_NEAR(back->pixels[i], image.pixels[i], 64 / 256.0);
    }
}

TEST(Image, OldRunLengthCodingOfHdrIsRead) {
    // A pixel of mantissas 128, 64, 32 with exponent 129 is 1, 0.5, 0.25; (1, 1, 1, 3) repeats it three
    // times.
    const Bytes file = bytesOf(std::string_view("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 4\n"
                                                "\x80\x40\x20\x81\x01\x01\x01\x03"));
    const Result<Image> image = decodeImage(file, "a.hdr", Encoding::Linear);
    ASSERT_TRUE(image) << image.error().message;
    for (int x = 0; x < 4; ++x)
        EXPECT_EQ(vec3(image->at(x, 0)[0], image->at(x, 0)[1], image->at(x, 0)[2]), vec3(1, 0.5f, 0.25f));
}

TEST(Image, AlphaIsLeftOutOfFloatFiles) {
    const Result<Image> back =
        decodeImage(*encodeImage(pattern(2, 2, 4), "a.pfm"), "a.pfm", Encoding::Linear);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->channels, 3);
    EXPECT_EQ(back->at(1, 0)[0], pattern(2, 2, 4).at(1, 0)[0]);
}

TEST(Image, NoBeginningOfAFileIsTakenForTheWhole) {
    EXPECT_EQ(acceptedBeginnings(makePng(5, 4, 8, 2, Bytes(60, std::byte(77)))), 0);
    EXPECT_EQ(acceptedBeginnings(makePng(30, 10, 16, 0, Bytes(600, std::byte(77)))), 0);
    EXPECT_EQ(acceptedBeginnings(*encodeImage(pattern(20, 20, 4), "a.png")), 0);
    EXPECT_EQ(acceptedBeginnings(*encodeImage(pattern(5, 4, 3), "a.hdr")), 0);
    EXPECT_EQ(acceptedBeginnings(*encodeImage(pattern(40, 4, 3), "a.hdr")), 0);
    EXPECT_EQ(acceptedBeginnings(*encodeImage(pattern(5, 4, 3), "a.pfm")), 0);
    Bytes jpeg;
    const std::vector<stbi_uc> samples(40 * 30 * 3, 99);
    stbi_write_jpg_to_func(appendTo, &jpeg, 40, 30, 3, samples.data(), 90);
    ASSERT_TRUE(decodeImage(jpeg, "a.jpg", Encoding::Linear));
    EXPECT_EQ(acceptedBeginnings(jpeg), 0);
}

TEST(Image, MessagesNameTheFileWhatWasFoundAndWhatWasExpected) {
    const Bytes png = makePng(2, 2, 8, 0, Bytes(4));
    EXPECT_EQ(messageOf(Bytes(png.begin(), png.end() - 20), "a.png"),
              "a.png: the file ends too early; must be a whole PNG file");
    EXPECT_EQ(messageOf(makePng(0, 4, 8, 0, {}), "a.png"),
              "a.png: is 0 x 4 pixels; must be 1 to 16384 a side and at most 67 million in all");
    EXPECT_EQ(messageOf(makePng(100000, 100000, 8, 0, {}), "a.png"),
              "a.png: is 100000 x 100000 pixels; must be 1 to 16384 a side and at most 67 million in all");
    EXPECT_EQ(messageOf(makePng(16384, 16384, 8, 0, {}), "a.png"),
              "a.png: is 16384 x 16384 pixels; must be 1 to 16384 a side and at most 67 million in all");
    EXPECT_EQ(messageOf(bytesOf("#?RGBE\nFORMAT=32-bit_rle_xyze\n\n"), "a.hdr"),
              "a.hdr: is stored as 32-bit_rle_xyze; must be 32-bit_rle_rgbe");
    EXPECT_EQ(messageOf(bytesOf("#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n+X 2 -Y 2\n"), "a.hdr"),
              "a.hdr: has the layout \"+X 2 -Y 2\"; must be -Y height +X width");
    EXPECT_EQ(messageOf(bytesOf("#?RGBE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\nabc"), "a.hdr"),
              "a.hdr: the HDR file is cut or damaged; must be a whole Radiance RGBE file");
    EXPECT_EQ(messageOf({}, "a"), "a: is empty; must be a PNG, JPEG, HDR or PFM image");
    EXPECT_EQ(messageOf(bytesOf("hello"), "a"),
              "a: is of an unknown kind; must be a PNG, JPEG, HDR or PFM image");
    EXPECT_EQ(messageOf(bytesOf("\x76\x2f\x31\x01"), "a.exr"),
              "a.exr: is an EXR file, whose reader is not here; must be a PNG, JPEG, HDR or PFM image");
    EXPECT_EQ(messageOf(bytesOf("Pf 0 2 -1\n"), "a.pfm"),
              "a.pfm: is 0 x 2 pixels; must be 1 to 16384 a side and at most 67 million in all");
    EXPECT_EQ(messageOf(bytesOf("Pf 2 2 -1\n1234"), "a.pfm"),
              "a.pfm: the PFM file ends after 14 bytes; must have 26");
    EXPECT_EQ(messageOf(bytesOf("PF 2 x"), "a.pfm"),
              "a.pfm: the PFM header is damaged; must be PF or Pf, width, height, scale");
}

TEST(Image, EncodersRefuseWhatTheirFormatCannotHold) {
    Image image(2, 2, 3);
    EXPECT_EQ(encodeImage(image, "a.tif").error().message,
              "a.tif: ends in no known image type; must be .png, .hdr or .pfm");
    image.at(1, 1)[2] = -0.5f;
    EXPECT_EQ(encodeImage(image, "a.hdr").error().message,
              "a.hdr: pixel (1, 1) is -0.5; HDR holds finite values of at least 0");
    image.at(0, 1)[0] = std::nanf("");
    EXPECT_EQ(encodeImage(image, "a.png").error().message,
              "a.png: pixel (0, 1) is nan; PNG holds finite values");
}

TEST(Image, FourThousandByFourThousandIsRead) {
    Image image(4096, 4096, 1);
    image.pixels.back() = 1;
    const Result<Image> back = decodeImage(*encodeImage(image, "a.png"), "a.png", Encoding::Linear);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->size(), ivec2(4096));
    EXPECT_EQ(*back->at(4095, 4095), 1.0f);
}

TEST(Image, FirstNonFinitePixelIsFound) {
    Image image(3, 2, 2);
    EXPECT_EQ(findNonFinite(image), ivec2(-1));
    image.at(1, 1)[1] = std::numeric_limits<float>::infinity();
    image.at(2, 1)[0] = std::nanf("");
    EXPECT_EQ(findNonFinite(image), ivec2(1, 1));
}

TEST(Image, APngWithAFlippedBitIsRefused) {
    const Bytes png = makePng(2, 2, 8, 0, {std::byte(1), std::byte(2), std::byte(3), std::byte(4)});
    const std::string must = " has another checksum; must be a whole PNG file";
    EXPECT_EQ(messageOf(png, "a.png"), "no error");
    EXPECT_EQ(messageOf(flipped(png, 30), "a.png"), "a.png: the chunk at byte 8" + must); // IHDR's own
    EXPECT_EQ(messageOf(flipped(png, 33 + 8 + 8), "a.png"), "a.png: the chunk at byte 33" + must); // in IDAT
}

TEST(Image, AJpegWithTooManyHuffmanCodesIsRefused) {
    const Image image = pattern(8, 8, 3);
    std::vector<std::uint8_t> samples(image.pixels.size(), 128);
    Bytes jpeg;
    stbi_write_jpg_to_func(appendTo, &jpeg, 8, 8, 3, samples.data(), 90);
    ASSERT_EQ(messageOf(jpeg, "a.jpg"), "no error");
    const auto mark = [](const Bytes& bytes, unsigned code) {
        std::size_t at = 0;
        while (bytes[at] != std::byte(0xff) || bytes[at + 1] != std::byte(code))
            ++at;
        return at;
    };
    Bytes many = jpeg;
    many[mark(jpeg, 0xc4) + 5 + 15] = std::byte(255); // codes of 16 bits
    EXPECT_EQ(messageOf(many, "a.jpg"),
              "a.jpg: has a Huffman table of more than 256 codes; must be a whole JPEG file");
    // The same behind the picture's coded data, where a second scan could stand.
    Bytes late(jpeg.begin(), jpeg.end() - 2);
    for (const int value : {0xff, 0xc4, 0, 19, 0})
        late.push_back(std::byte(value));
    late.insert(late.end(), 16, std::byte(255));
    EXPECT_EQ(messageOf(late, "a.jpg"),
              "a.jpg: has a Huffman table of more than 256 codes; must be a whole JPEG file");
}

TEST(Image, HdrComesPieceByPiece) {
    Image image(700, 400, 3);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = float(i % 251) / 32;
    const Bytes file = *encodeImage(image, "a.hdr");
    HdrReading reading(file, "a.hdr");
    std::optional<Result<Image>> read;
    int pieces = 1;
    for (; !(read = reading.advance()); ++pieces) {
    }
    EXPECT_EQ(pieces, 4); // the header and 280,000 pixels
    ASSERT_TRUE(*read) << read->error().message;
    EXPECT_EQ((*read)->pixels, decodeHdr(file, "a.hdr")->pixels);
    EXPECT_NEAR((*read)->at(699, 399)[2], image.at(699, 399)[2], 8 / 256.0); // of the largest channel
}

TEST(Image, ALargePngComesPieceByPieceAndIsTheSame) {
    Image image(400, 300, 4);
    std::uint32_t state = 1;
    for (float& sample : image.pixels)
        sample = float((state = state * 1664525 + 1013904223) >> 24) / 255; // noise, which is not packed well
    const Bytes file = *encodeImage(image, "a.png");
    ASSERT_GT(file.size(), 400'000u);
    const auto readIn = [](const Bytes& bytes, int& pieces) {
        ImageReading reading(bytes, "a.png", Encoding::Linear);
        std::optional<Result<Image>> read;
        for (pieces = 1; !(read = reading.advance()); ++pieces) {
        }
        return std::move(*read);
    };
    int pieces = 0;
    const Result<Image> read = readIn(file, pieces);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->pixels, decodeImage(file, "a.png", Encoding::Linear)->pixels);
    EXPECT_GE(pieces, 5); // its checksums, what unpacks it, its rows, and their samples twice
    const Result<Image> bad = readIn(flipped(file, 1000), pieces);
    ASSERT_FALSE(bad);
    EXPECT_EQ(bad.error().message, messageOf(flipped(file, 1000), "a.png"));
}

} // namespace
} // namespace lucent
