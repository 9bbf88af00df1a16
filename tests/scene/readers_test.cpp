#include "scene/readers/Readers.h"
#include "tests/base/Png.h"
#include "tests/scene/Gltf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace lucent::scene {
namespace {

using test::kNoFiles;

Image gradient(int channels) {
    Image image(9, 5, channels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = std::sin(float(i)) * 100;
    return image;
}

TEST(Readers, ExrKeepsEveryBitOfColoursAndGreys) {
    for (const int channels : {1, 3, 4}) {
        const Image image = gradient(channels);
        const Result<Bytes> file = encodeExr(image);
        ASSERT_TRUE(file) << file.error().message;
        EXPECT_TRUE(isForeign("a", *file));
        const Result<Bytes> plain = toPlain("a.exr", *file, kNoFiles);
        ASSERT_TRUE(plain) << plain.error().message;
        const Result<Image> back = decodeImage(*plain, "a.exr", Encoding::Srgb);
        ASSERT_TRUE(back);
        EXPECT_EQ(back->channels, channels);
        EXPECT_EQ(back->pixels, image.pixels);
    }
}

TEST(Readers, ExrOfTwoChannelsIsNotWritten) {
    EXPECT_EQ(encodeExr(Image(2, 2, 2)).error().message,
              "EXR: the image has 2 channels; must have 1, 3 or 4");
}

TEST(Readers, ExrWithOtherChannelsIsRefused) {
    Bytes file = *encodeExr(gradient(3));
    for (std::size_t i = 0; i + 1 < 120; ++i) // the channel list begins with "B"
        if (file[i] == std::byte('B') && file[i + 1] == std::byte(0)) file[i] = std::byte('A');
    EXPECT_EQ(toPlain("a.exr", file, kNoFiles).error().message,
              "a.exr: has the channels A, G, R; must have R, G, B or only one");
}

TEST(Readers, DamagedExrIsRefused) {
    const Bytes whole = *encodeExr(gradient(3));
    for (std::size_t length = 4; length < whole.size(); ++length) {
        const Bytes cut(whole.begin(), whole.begin() + std::ptrdiff_t(length));
        EXPECT_FALSE(toPlain("a.exr", cut, kNoFiles)) << length << " of " << whole.size();
    }
    // The data window's far corner (8, 4) becomes (100000, 100000).
    Bytes huge = whole;
    const std::string_view key = "dataWindow";
    const auto at = std::search(huge.begin(), huge.end(), reinterpret_cast<const std::byte*>(key.data()),
                                reinterpret_cast<const std::byte*>(key.data() + key.size()));
    const std::int32_t far[] = {100000, 100000};
    std::memcpy(&*at + key.size() + 1 + sizeof "box2i" + 4 + 8, far, sizeof far);
    EXPECT_EQ(toPlain("a.exr", huge, kNoFiles).error().message,
              "a.exr: is 100001 x 100001 pixels; must be 1 to 16384 a side and at most 67 million in all");
}

TEST(Readers, OtherFilesPassUnchanged) {
    const Bytes png = test::makePng(1, 1, 8, 0, {std::byte(9)});
    EXPECT_FALSE(isForeign("a.png", png));
    EXPECT_EQ(*toPlain("a.png", png, kNoFiles), png);
}

TEST(Readers, PlainFilesReadFromDiskAndTranslate) {
    const std::string folder = testing::TempDir();
    ASSERT_TRUE(writeFile(folder + "lucent_square.glb", test::squareGlb()));
    const ReadFile files = plainFiles(folder + "lucent_scene.json");
    const Result<Bytes> mesh = files(folder + "lucent_square.glb");
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_TRUE(decodeMesh(*mesh, "a"));
    EXPECT_FALSE(files(folder + "lucent_none.glb"));
}

} // namespace
} // namespace lucent::scene
