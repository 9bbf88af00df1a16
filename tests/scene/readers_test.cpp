#include "scene/readers/Readers.h"
#include "tests/base/Png.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace lucent::scene {
namespace {

using test::bytesOf;

const ReadFile kNoFiles = [](const std::string& path) -> Result<Bytes> {
    return Error{path + ": cannot be read (none)"};
};

template <class T>
void append(Bytes& bytes, std::initializer_list<T> values) {
    for (const T value : values) {
        const auto* begin = reinterpret_cast<const std::byte*>(&value);
        bytes.insert(bytes.end(), begin, begin + sizeof value);
    }
}

// A unit square in the xy plane: four positions, then six indices of a given width.
template <class Index>
Bytes squareBuffer() {
    Bytes buffer;
    append<float>(buffer, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    append<Index>(buffer, {0, 1, 2, 0, 2, 3});
    return buffer;
}

// glTF around a buffer with positions at 0 and indices at 48; `node` and `primitive` are members of theirs.
std::string gltf(const Bytes& buffer, int indexType, const std::string& node = "",
                 const std::string& primitive = "", const std::string& uri = R"("uri": "square.bin", )") {
    const std::string size = std::to_string(buffer.size()), rest = std::to_string(buffer.size() - 48);
    return R"({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [ { "nodes": [0] } ],
        "nodes": [ { "mesh": 0)" +
           node + R"( } ],
        "meshes": [ { "primitives": [ { "attributes": { "POSITION": 0 }, "indices": 1)" +
           primitive + R"( } ] } ],
        "accessors": [ { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0,0,0], "max": [1,1,0] },
                       { "bufferView": 1, "componentType": )" +
           std::to_string(indexType) + R"(, "count": 6, "type": "SCALAR" } ],
        "bufferViews": [ { "buffer": 0, "byteOffset": 0, "byteLength": 48 },
                         { "buffer": 0, "byteOffset": 48, "byteLength": )" +
           rest + R"( } ],
        "buffers": [ { )" +
           uri + R"("byteLength": )" + size + " } ] }";
}

// The same as one binary file.
Bytes glb(const Bytes& buffer, std::string json) {
    while (json.size() % 4)
        json += ' ';
    Bytes bin = buffer;
    while (bin.size() % 4)
        bin.push_back(std::byte(0));
    Bytes file = bytesOf("glTF");
    append<std::uint32_t>(file, {2, std::uint32_t(12 + 8 + json.size() + 8 + bin.size()),
                                 std::uint32_t(json.size()), 0x4e4f534a});
    const Bytes text = bytesOf(json);
    file.insert(file.end(), text.begin(), text.end());
    append<std::uint32_t>(file, {std::uint32_t(bin.size()), 0x004e4942});
    file.insert(file.end(), bin.begin(), bin.end());
    return file;
}

Bytes squareGlb(const std::string& node = "", const std::string& primitive = "") {
    const Bytes buffer = squareBuffer<std::uint16_t>();
    return glb(buffer, gltf(buffer, 5123, node, primitive, ""));
}

// The mesh, or the message in `error`.
Mesh read(const Bytes& file, std::string& error, const std::string& name = "m/a.gltf",
          const ReadFile& files = kNoFiles) {
    const Result<Bytes> plain = toPlain(name, file, files);
    error = plain ? "" : plain.error().message;
    if (!plain) return {};
    const Result<Mesh> mesh = decodeMesh(*plain, name);
    EXPECT_TRUE(mesh) << mesh.error().message;
    return *mesh;
}

TEST(Readers, GltfWithAFileBesideItIsReadInAllIndexWidths) {
    const auto check = [](const Bytes& buffer, int indexType) {
        std::string asked, error;
        const ReadFile files = [&](const std::string& path) -> Result<Bytes> {
            asked = path;
            return buffer;
        };
        const Mesh mesh = read(bytesOf(gltf(buffer, indexType)), error, "m/a.gltf", files);
        EXPECT_EQ(error, "");
        EXPECT_EQ(asked, "m/square.bin");
        EXPECT_EQ(mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
        ASSERT_EQ(mesh.positions.size(), 4u);
        EXPECT_EQ(mesh.positions[2], vec3(1, 1, 0));
    };
    check(squareBuffer<std::uint8_t>(), 5121);
    check(squareBuffer<std::uint16_t>(), 5123);
    check(squareBuffer<std::uint32_t>(), 5125);
}

TEST(Readers, BinaryGltfWithAPictureInsideIsRead) {
    std::string json = gltf(squareBuffer<std::uint16_t>(), 5123, "", "", "");
    json.insert(json.rfind('}'), R"(, "images": [ { "bufferView": 1, "mimeType": "image/png" } ])");
    std::string error;
    EXPECT_EQ(read(glb(squareBuffer<std::uint16_t>(), json), error).indices.size(), 6u);
    EXPECT_EQ(error, "");
}

TEST(Readers, NodesAreScaledTurnedAndMoved) {
    std::string error;
    // (1, 0, 0) doubled, turned by 90 degrees about z (quaternion 0 0 s s), moved by (0, 0, 5): (0, 2, 5).
    const std::string half = "0.70710678";
    const Mesh placed = read(squareGlb(R"(, "translation": [0,0,5], "scale": [2,2,2], "rotation": [0,0,)" +
                                       half + "," + half + "]"),
                             error);
    ASSERT_EQ(error, "");
    EXPECT_LT(glm::distance(placed.positions[1], vec3(0, 2, 5)), 1e-6);
    const Mesh matrix = read(squareGlb(R"(, "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 7,8,9,1])"), error);
    EXPECT_EQ(matrix.positions[1], vec3(8, 8, 9));
    const Mesh mirrored = read(squareGlb(R"(, "scale": [-1,1,1])"), error);
    EXPECT_EQ(mirrored.indices, (std::vector<std::uint32_t>{0, 2, 1, 0, 3, 2}))
        << "a mirror turns triangles round";
}

TEST(Readers, StripsAndFansBecomeTriangles) {
    std::string error;
    // Corners 0 1 2 0 2 3. Strip: every second triangle is turned round; fan: all share the first corner.
    EXPECT_EQ(read(squareGlb("", R"(, "mode": 5)"), error).indices,
              (std::vector<std::uint32_t>{0, 1, 2, 1, 0, 2, 2, 0, 2, 0, 3, 2}));
    EXPECT_EQ(read(squareGlb("", R"(, "mode": 6)"), error).indices,
              (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 0, 0, 0, 2, 0, 2, 3}));
}

TEST(Readers, SparsePositionsReplaceTheStoredOnes) {
    Bytes buffer = squareBuffer<std::uint16_t>(); // 60 bytes
    append<std::uint16_t>(buffer, {3, 0});        // place 3, and padding
    append<float>(buffer, {5, 6, 7});
    std::string json = gltf(buffer, 5123, "", "", "");
    const std::string sparse =
        R"("sparse": { "count": 1, "indices": { "bufferView": 2, "componentType": 5123 },
                                              "values": { "bufferView": 3 } }, )";
    json.insert(json.find("\"bufferView\": 0"), sparse);
    const std::string views =
        R"(, { "buffer": 0, "byteOffset": 60, "byteLength": 2 }, { "buffer": 0, "byteOffset": 64, "byteLength": 12 })";
    json.insert(json.find(" ],\n        \"buffers\""), views);
    std::string error;
    const Mesh mesh = read(glb(buffer, json), error);
    ASSERT_EQ(error, "");
    EXPECT_EQ(mesh.positions[3], vec3(5, 6, 7));
    EXPECT_EQ(mesh.positions[2], vec3(1, 1, 0));
}

TEST(Readers, DamagedGltfIsRefused) {
    const Bytes whole = squareGlb();
    std::string error;
    for (std::size_t length = 0; length < whole.size(); ++length) {
        const Bytes cut(whole.begin(), whole.begin() + std::ptrdiff_t(length));
        if (length >= 4 || length == 0) {
            read(cut, error);
            EXPECT_NE(error, "") << length;
        }
    }
    const auto messageOf = [&](const std::string& from, const std::string& to) {
        std::string json = gltf(squareBuffer<std::uint16_t>(), 5123, "", "", "");
        json.replace(json.find(from), from.size(), to);
        read(glb(squareBuffer<std::uint16_t>(), json), error);
        return error;
    };
    EXPECT_EQ(messageOf("\"count\": 4", "\"count\": 3"),
              "m/a.gltf: has index 3 behind its 3 positions; must be smaller");
    EXPECT_EQ(messageOf("\"count\": 4", "\"count\": 400"),
              "m/a.gltf: has a buffer of 60 bytes that is too short for what points into it");
    EXPECT_EQ(messageOf("\"byteLength\": 60", "\"byteLength\": 0"),
              "m/a.gltf: buffers.0.byteLength is 0; must be at least 1");
    EXPECT_EQ(messageOf("\"asset\":", "\"asset\"="),
              "m/a.gltf:1:10: invalid literal; last read: '\"asset\"='; expected ':'");
    EXPECT_EQ(messageOf("\"mesh\": 0", "\"mesh\": 7"), "m/a.gltf: points to mesh 7, which does not exist");
    EXPECT_EQ(messageOf("\"mesh\": 0", "\"mesh\": 0, \"children\": [0]"),
              "m/a.gltf: has nodes that hold each other; must form a tree");
    EXPECT_EQ(messageOf("\"scene\": 0", "\"extensionsRequired\": [\"KHR_draco_mesh_compression\"]"),
              "m/a.gltf: needs the extension KHR_draco_mesh_compression, which is not read; must do without");
    EXPECT_EQ(messageOf("\"nodes\": [0]", "\"nodes\": []"),
              "m/a.gltf: holds no triangles; must hold at least one");
    read(bytesOf(gltf(squareBuffer<std::uint16_t>(), 5123)), error);
    EXPECT_EQ(error, "m/a.gltf: m/square.bin: cannot be read (none)");
}

Image gradient(int channels) {
    Image image(9, 5, channels);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = std::sin(float(i)) * 100;
    return image;
}

TEST(Readers, ExrKeepsEveryBitOfColoursAndGreys) {
    for (const int channels : {1, 3}) {
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

TEST(Readers, ExrWithAlphaGivesItsColours) {
    const Image image = gradient(4);
    const Result<Bytes> plain = toPlain("a.exr", *encodeExr(image), kNoFiles);
    ASSERT_TRUE(plain) << plain.error().message;
    const Result<Image> back = decodeImage(*plain, "a.exr", Encoding::Linear);
    for (int c = 0; c < 3; ++c)
        EXPECT_EQ(back->at(4, 3)[c], image.at(4, 3)[c]);
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
    ASSERT_TRUE(writeFile(folder + "lucent_square.glb", squareGlb()));
    const ReadFile files = plainFiles();
    const Result<Bytes> mesh = files(folder + "lucent_square.glb");
    ASSERT_TRUE(mesh) << mesh.error().message;
    EXPECT_TRUE(decodeMesh(*mesh, "a"));
    EXPECT_FALSE(files(folder + "lucent_none.glb"));
}

} // namespace
} // namespace lucent::scene
