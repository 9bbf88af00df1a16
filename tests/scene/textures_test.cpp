// Textures of glTF and OBJ files, down to their texels.
#include "scene/Textures.h"
#include "tests/scene/Gltf.h"

namespace lucent::scene {
namespace {

// Four by two texels: red grows to the right, green downwards; as 8 bits.
Bytes picture() {
    Image image(4, 2, 3);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 4; ++x) {
            image.at(x, y)[0] = float(60 * x) / 255;
            image.at(x, y)[1] = float(100 * y + 50) / 255;
            image.at(x, y)[2] = 1;
        }
    return *encodeImage(image, "a.png");
}

ReadFile having(const std::string& file, const Bytes& bytes) {
    return [=](const std::string& path) -> Result<Bytes> {
        if (path == file) return bytes;
        return Error{path + ": cannot be read (none)"};
    };
}

// The square with coordinates u = x, v = 1 - y, and one material.
Mesh squareWith(const std::string& material, std::string* said = nullptr,
                const ReadFile& files = having("m/my picture.png", picture()), const std::string& more = "") {
    Bytes buffer = test::squareBuffer<std::uint16_t>();
    const std::size_t indices = buffer.size() - 48;
    test::append<float>(buffer, {0, 1, 1, 1, 1, 0, 0, 0});
    std::string json = test::gltf(buffer, 5123, "", R"(, "material": 0)", "");
    const auto replace = [&](const std::string& from, const std::string& to) {
        json.replace(json.find(from), from.size(), to);
    };
    replace(R"("POSITION": 0)", R"("POSITION": 0, "TEXCOORD_0": 2)");
    replace(R"("count": 6, "type": "SCALAR" })",
            R"("count": 6, "type": "SCALAR" }, { "bufferView": 2, "componentType": 5126, "count": 4,
                 "type": "VEC2" })");
    replace(R"("byteLength": )" + std::to_string(buffer.size() - 48) + " }",
            R"("byteLength": )" + std::to_string(indices) + R"( }, { "buffer": 0, "byteOffset": )" +
                std::to_string(48 + indices) + R"(, "byteLength": 32 })");
    json.insert(json.rfind('}'),
                R"(, "materials": [ { )" + material +
                    R"( } ], "images": [ { "uri": "my%20picture.png" }, { "uri": "gone.png" } ],
        "samplers": [ { "wrapS": 33071, "wrapT": 33648 } ],
        "textures": [ { "source": 0 }, { "source": 0, "sampler": 0 }, { "source": 1 } ])" +
                    more);
    std::string error;
    testing::internal::CaptureStderr();
    const Mesh mesh = test::read(test::glb(buffer, json), error, "m/a.glb", files);
    const std::string warnings = testing::internal::GetCapturedStderr();
    if (said) *said = warnings;
    EXPECT_EQ(error, "");
    return mesh;
}

TEST(Textures, AMaterialHasThoseOfItsFile) {
    std::string said;
    const Mesh mesh = squareWith(
        R"("pbrMetallicRoughness": { "baseColorTexture": { "index": 0 }, "metallicFactor": 0.5,
             "metallicRoughnessTexture": { "index": 1 } },
           "normalTexture": { "index": 0, "scale": 0.5 }, "emissiveTexture": { "index": 1 },
           "emissiveFactor": [1, 2, 3])",
        &said);
    EXPECT_EQ(said, "");
    ASSERT_EQ(mesh.parts.size(), 1u);
    const Textures& t = mesh.parts[0].textures;
    // One picture as colours and once as numbers, whoever uses it.
    ASSERT_EQ(mesh.images.size(), 2u);
    EXPECT_EQ(t.color.image, t.emission.image);
    EXPECT_EQ(t.roughness.image, t.normal.image);
    EXPECT_EQ(mesh.images[std::size_t(t.color.image)]->encoding, Encoding::Srgb);
    EXPECT_EQ(mesh.images[std::size_t(t.normal.image)]->encoding, Encoding::Linear);
    EXPECT_EQ(t.color.u, Wrap::Repeat);
    EXPECT_EQ(t.roughness.u, Wrap::Clamp);
    EXPECT_EQ(t.roughness.v, Wrap::Mirror);
    EXPECT_EQ(t.normalScale, 0.5f);
    EXPECT_EQ(mesh.parts[0].values.base, vec3(1, 2, 3));
    EXPECT_EQ(std::get<Glossy>(mesh.parts[0].values.kind).metallic, 0.5f);
    ASSERT_EQ(mesh.coordinates.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        EXPECT_EQ(mesh.coordinates[i], vec2(mesh.positions[i].x, 1 - mesh.positions[i].y));
}

TEST(Textures, TexelsAreTheFilesOwn) {
    const Mesh mesh = squareWith(R"("pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } },
                                    "normalTexture": { "index": 0 })");
    const TextureImage& colors = *mesh.images[std::size_t(mesh.parts[0].textures.color.image)];
    const TextureImage& numbers = *mesh.images[std::size_t(mesh.parts[0].textures.normal.image)];
    ASSERT_EQ(colors.size, ivec2(4, 2));
    EXPECT_EQ(numbers.texel({3, 0}), vec4(180 / 255.0f, 50 / 255.0f, 1, 1));
    EXPECT_EQ(colors.texel({1, 1}), vec4(linearFromSrgb(60 / 255.0f), linearFromSrgb(150 / 255.0f), 1, 1));
    EXPECT_EQ(numbers.leastGreen, 50 / 255.0f);
}

TEST(Textures, ATransformMovesTheCoordinates) {
    const auto transformed = [](const std::string& transform) {
        return squareWith(R"("pbrMetallicRoughness": { "baseColorTexture": { "index": 0, "extensions":
                             { "KHR_texture_transform": { )" +
                              transform + " } } } }",
                          nullptr, having("m/my picture.png", picture()),
                          R"(, "extensionsUsed": [ "KHR_texture_transform" ])")
            .coordinates;
    };
    // Of the corner at u = 1, v = 1.
    const auto corner = [&](const std::string& transform) { return transformed(transform)[1]; };
    EXPECT_EQ(corner(R"("offset": [0.5, 2], "scale": [3, 4])"), vec2(3.5f, 6));
    // A quarter turn: u goes where v was, against it (the extension's own rotation matrix).
    const vec2 turned = corner(R"("rotation": 1.5707963267948966, "scale": [2, 3])");
    EXPECT_NEAR(turned.x, 3, 1e-6);
    EXPECT_NEAR(turned.y, -2, 1e-6);
}

TEST(Textures, OneThatLiesElsewhereHasCoordinatesOfItsOwn) {
    std::string said;
    const auto moved = [](const std::string& offset) {
        return R"({ "index": 0, "extensions": { "KHR_texture_transform": { "offset": [)" + offset + "] } } }";
    };
    const Mesh mesh = squareWith(
        R"("pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } }, "normalTexture": )" +
            moved("0.5, 2") + R"(, "emissiveTexture": )" + moved("0, 1") + R"(, "emissiveFactor": [1, 1, 1])",
        &said, having("m/my picture.png", picture()), R"(, "extensionsUsed": [ "KHR_texture_transform" ])");
    EXPECT_EQ(said, "warning: m/a.glb: not read: emissiveTexture, which has a third set of coordinates\n");
    ASSERT_EQ(mesh.secondCoordinates.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        EXPECT_EQ(mesh.secondCoordinates[i], mesh.coordinates[i] + vec2(0.5f, 2));
    EXPECT_FALSE(mesh.parts[0].textures.color.second);
    EXPECT_TRUE(mesh.parts[0].textures.normal.second);
    EXPECT_EQ(mesh.parts[0].textures.emission.image, -1);
}

TEST(Textures, AlphaCutsHolesOrIsAShare) {
    std::string said;
    const auto cutoffOf = [&](const std::string& alpha) {
        return squareWith(R"("pbrMetallicRoughness": { "baseColorTexture": { "index": 0 },
                             "baseColorFactor": [1, 1, 1, 0.5] }, )" +
                              alpha,
                          &said)
            .parts[0]
            .textures.cutoff;
    };
    EXPECT_EQ(cutoffOf(R"("alphaMode": "OPAQUE")"), 0);
    EXPECT_EQ(cutoffOf(R"("alphaMode": "MASK")"), 1); // the factor's half of the usual half
    EXPECT_EQ(cutoffOf(R"("alphaMode": "MASK", "alphaCutoff": 0.25)"), 0.5f);
    EXPECT_EQ(said, "");
    EXPECT_EQ(cutoffOf(R"("alphaMode": "BLEND")"), -0.5f);
    EXPECT_EQ(said, "");
    const auto plain = [&](const std::string& factor) {
        return squareWith(R"("pbrMetallicRoughness": { "baseColorFactor": )" + factor +
                              R"( }, "alphaMode": "BLEND")",
                          &said)
            .parts[0]
            .textures;
    };
    EXPECT_EQ(plain("[1, 1, 1, 0.25]").cutoff, -0.25f);
    EXPECT_FALSE(plain("[1, 1, 1, 1]").any()); // all of it is there
    EXPECT_EQ(said, "");
    squareWith(R"("alphaMode": "MASK")", &said);
    EXPECT_EQ(said, "warning: m/a.glb: not read: alphaMode MASK\n");
}

TEST(Textures, WhatCannotBeReadIsNamedAndLeftOut) {
    std::string said;
    const Mesh gone = squareWith(
        R"("pbrMetallicRoughness": { "baseColorTexture": { "index": 2 } }, "emissiveTexture": { "index": 2 },
           "emissiveFactor": [1, 1, 1])",
        &said);
    EXPECT_EQ(said, "warning: m/a.glb: not read: a texture (m/gone.png: cannot be read (none))\n");
    EXPECT_FALSE(gone.parts[0].textures.any());
    EXPECT_EQ(gone.parts[0].values.base, vec3(0)); // the texture would blacken most of it
    squareWith(R"("pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } },
                  "normalTexture": { "index": 0, "texCoord": 1 })",
               &said);
    EXPECT_EQ(said, "warning: m/a.glb: not read: textures of what has no second texture coordinates\n");
    const Mesh glass = squareWith(
        R"("pbrMetallicRoughness": { "baseColorTexture": { "index": 0 }, "roughnessFactor": 0,
             "metallicFactor": 0 }, "extensions": { "KHR_materials_transmission": { "transmissionFactor": 1 },
             "KHR_materials_volume": { "thicknessFactor": 1 } })",
        &said);
    EXPECT_EQ(said, "warning: m/a.glb: not read: textures of what is clear, translucent or a mirror\n");
    EXPECT_TRUE(glass.images.empty());
}

TEST(Textures, LargeOnesAreAveraged) {
    // Columns of black and white, one texel wide: their mean in light is one half.
    Image stripes(2 * kMostTextureSide, 2, 1);
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < stripes.width; ++x)
            *stripes.at(x, y) = float(x % 2);
    testing::internal::CaptureStderr();
    const Result<TextureImage> image = decodeTexture(*encodeImage(stripes, "a.png"), "a.png", Encoding::Srgb);
    EXPECT_EQ(
        testing::internal::GetCapturedStderr(),
        "warning: a.png: has 4096 x 2 texels; is shown with 2048 x 1, as textures have at most 2048 on a "
        "side\n");
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_EQ(image->size, ivec2(kMostTextureSide, 1));
    EXPECT_NEAR(image->texel({7, 0}).r, 0.5f, 0.005f); // a step of 8 bits
}

TEST(Textures, ObjFilesNameThemInTheirMaterials) {
    const std::string obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0.25 1\n"
                            "usemtl tiles\nf 1/1 2/2 3/3\n";
    const ReadFile files = [](const std::string& path) -> Result<Bytes> {
        if (path == "m/a.mtl")
            return test::bytesOf(
                "newmtl tiles\nKd 1 1 1\nmap_Kd -s 1 1 1 .\\my.png\nnorm other picture.png\n");
        if (path == "m/my.png" || path == "m/other picture.png") return picture();
        return Error{path + ": cannot be read (none)"};
    };
    std::string error;
    testing::internal::CaptureStderr();
    const Mesh mesh = test::read(test::bytesOf(obj), error, "m/a.obj", files);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "warning: m/a.obj: not read: options of textures\n");
    ASSERT_EQ(error, "");
    ASSERT_EQ(mesh.images.size(), 2u);
    EXPECT_EQ(mesh.images[std::size_t(mesh.parts[0].textures.color.image)]->encoding, Encoding::Srgb);
    EXPECT_EQ(mesh.images[std::size_t(mesh.parts[0].textures.normal.image)]->encoding, Encoding::Linear);
    // v points up in such files.
    EXPECT_EQ(mesh.coordinates, (std::vector<vec2>{{0, 1}, {1, 1}, {0.25f, 0}}));
}

TEST(Textures, APlainFileKeepsThem) {
    const Mesh mesh = squareWith(R"("pbrMetallicRoughness": { "baseColorTexture": { "index": 1 } })");
    const Result<Mesh> back = decodeMesh(encodeMesh(mesh), "a");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->coordinates, mesh.coordinates);
    EXPECT_EQ(back->parts[0].textures, mesh.parts[0].textures);
    ASSERT_EQ(back->images.size(), 1u);
    EXPECT_EQ(back->images[0]->texels, mesh.images[0]->texels);
    EXPECT_EQ(back->images[0]->leastGreen, mesh.images[0]->leastGreen);

    const auto messageAfter = [&](auto change) {
        Mesh broken = mesh;
        change(broken);
        const Result<Mesh> read = decodeMesh(encodeMesh(broken), "a");
        return read ? "" : read.error().message;
    };
    EXPECT_EQ(messageAfter([](Mesh& m) { m.parts[0].textures.color.image = 1; }),
              "a: part \"material 0\": texture 1 points outside the 1 textures; must be smaller");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.coordinates.pop_back(); }),
              "a: has 3 texture coordinates; must have 4");
    EXPECT_EQ(messageAfter([](Mesh& m) { m.coordinates.clear(); }),
              "a: part \"material 0\" has textures without coordinates; must have them");
    EXPECT_EQ(
        messageAfter([](Mesh& m) {
            TextureImage image = *m.images[0];
            image.size.x = 5;
            m.images[0] = std::make_shared<const TextureImage>(image);
        }),
        "a: texture 0 has 5 x 2 texels in 32 bytes; must have 4 bytes a texel and at most 2048 on a side");
}

TEST(Textures, TexelsThatLieElsewhereComeFromTheirFile) {
    Mesh mesh = squareWith(R"("pbrMetallicRoughness": { "baseColorTexture": { "index": 1 } })");
    const TextureImage whole = *mesh.images[0];
    const Result<TextureImage> elsewhere =
        decodeTexture(standInFor(whole.size, std::uint8_t(200)), "a.png", whole.encoding);
    ASSERT_TRUE(elsewhere) << elsewhere.error().message;
    EXPECT_TRUE(elsewhere->isElsewhere());
    mesh.images[0] = std::make_shared<const TextureImage>(*elsewhere);
    const Bytes file = encodeMesh(mesh);
    const auto madeWith = [&](const std::string& name, const Bytes& texels) {
        MeshMaking making("m/a.mesh", [&](const std::string& path) {
            return path == "m/a.mesh" ? Result<Bytes>(file) : having(name, texels)(path);
        });
        for (;;)
            if (auto made = making.advance()) return *made;
    };
    Bytes texels;
    for (const std::uint8_t value : whole.texels)
        texels.push_back(std::byte(value));
    const auto made = madeWith("m/a.mesh#200", texels);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_EQ((*made)->images[0]->size, whole.size);
    EXPECT_EQ((*made)->images[0]->encoding, whole.encoding);
    EXPECT_EQ((*made)->images[0]->texels, whole.texels);
    EXPECT_EQ((*made)->images[0]->leastGreen, whole.leastGreen);

    EXPECT_EQ(madeWith("m/b", texels).error().message, "m/a.mesh#200: cannot be read (none)");
    texels.pop_back();
    EXPECT_EQ(
        madeWith("m/a.mesh#200", texels).error().message,
        "m/a.mesh: texture 0 has 4 x 2 texels in 31 bytes; must have 4 bytes a texel and at most 2048 on a "
        "side");
    EXPECT_EQ(
        madeWith("m/a.mesh#200", Bytes(1)).error().message,
        "m/a.mesh: texture 0 has 4 x 2 texels in 1 bytes; must have 4 bytes a texel and at most 2048 on a "
        "side");
    EXPECT_EQ(
        decodeMesh(file, "a").error().message,
        "a: texture 0 has 4 x 2 texels in 1 bytes; must have 4 bytes a texel and at most 2048 on a side");
    const Result<Mesh> shape = decodeShape(file, "a"); // heights come of meshes too
    ASSERT_TRUE(shape) << shape.error().message;
    EXPECT_EQ(shape->positions, mesh.positions);
    EXPECT_TRUE(shape->images[0]->texels.empty());
}

TEST(Textures, MattAndGlossyObjectsShowThem) {
    const auto mesh = std::make_shared<const Mesh>(
        squareWith(R"("pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } })"));
    Object object;
    object.shape = MeshShape{.source = "a.glb", .part = "", .mesh = mesh};
    object.material.kind = Matt{};
    EXPECT_EQ(texturesOf(object), &mesh->parts[0].textures);
    object.material.kind = Glossy{};
    EXPECT_EQ(texturesOf(object), &mesh->parts[0].textures);
    object.material.kind = Mirror{};
    EXPECT_EQ(texturesOf(object), nullptr);
    object.material.kind = Matt{};
    std::get<MeshShape>(object.shape).textured = false;
    EXPECT_EQ(texturesOf(object), nullptr);
}

} // namespace
} // namespace lucent::scene
