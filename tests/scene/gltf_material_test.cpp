#include "scene/Keys.h"
#include "tests/scene/Gltf.h"

#include <gtest/gtest.h>

namespace lucent::scene {
namespace {

// A square whose material has these members; what is said on stderr in `said`.
Material materialOf(const std::string& members, std::string* said = nullptr) {
    std::string json = test::gltf(test::squareBuffer<std::uint16_t>(), 5123, "", R"(, "material": 0)", "");
    json.insert(json.rfind('}'), R"(, "materials": [ { "name": "m")" + members + " } ]");
    testing::internal::CaptureStderr();
    std::string error;
    // warnOnce() says the same text once: a name for each set of members.
    const Mesh mesh = test::read(test::glb(test::squareBuffer<std::uint16_t>(), json), error,
                                 "m/" + std::to_string(std::hash<std::string>()(members)) + ".gltf");
    const std::string text = testing::internal::GetCapturedStderr();
    if (said) *said = text.empty() ? "" : text.substr(text.find(".gltf: ") + 7);
    EXPECT_EQ(error, "");
    if (mesh.parts.size() != 1) {
        ADD_FAILURE() << mesh.parts.size() << " parts";
        return {};
    }
    EXPECT_EQ(mesh.parts[0].material, "m");
    return mesh.parts[0].values;
}

std::string matt(const std::string& more = "") {
    return R"(, "pbrMetallicRoughness": { "metallicFactor": 0 )" + more + " }";
}
std::string glass(const std::string& volume, const std::string& more = "") {
    return matt(R"(, "roughnessFactor": 0)") +
           R"(, "extensions": { "KHR_materials_transmission": { "transmissionFactor": 0.75 })" + volume +
           more + " }";
}
const std::string kVolume = R"(, "KHR_materials_volume": { "thicknessFactor": 1 })";

TEST(GltfMaterial, ColoursAreLinearAsTheyStand) {
    std::string said;
    const Material m = materialOf(matt(R"(, "baseColorFactor": [0.1, 0.2, 0.3, 1])") +
                                      R"(, "emissiveFactor": [0.5, 0.25, 1], "extensions":
                                         { "KHR_materials_emissive_strength": { "emissiveStrength": 4 } })",
                                  &said);
    EXPECT_EQ(m.diffuse, vec3(0.1f, 0.2f, 0.3f));
    EXPECT_EQ(m.base, vec3(2, 1, 4));
    EXPECT_FALSE(m.isRefractive() || m.isMirror());
    EXPECT_EQ(said, "");
}

TEST(GltfMaterial, DefaultsAreThoseOfTheFormat) {
    std::string said;
    const Material m = materialOf("", &said);
    EXPECT_EQ(m.diffuse, vec3(1));
    EXPECT_EQ(m.base, vec3(0));
    EXPECT_TRUE(std::holds_alternative<Matt>(m.kind));
    EXPECT_EQ(said, "");
}

TEST(GltfMaterial, GlassHasItsVolume) {
    std::string said;
    const Material m = materialOf(glass(R"(, "KHR_materials_volume": { "thicknessFactor": 0.1,
        "attenuationColor": [0.5, 0.25, 1], "attenuationDistance": 2 })",
                                        R"(, "KHR_materials_ior": { "ior": 1.33 },
                                           "KHR_materials_dispersion": { "dispersion": 0.36 })"),
                                  &said);
    EXPECT_EQ(m.clear().transmission, 0.75f);
    EXPECT_EQ(m.clear().ior, 1.33f);
    EXPECT_EQ(m.clear().dispersion, 0.36f);
    EXPECT_EQ(m.clear().absorption, absorptionOf({2, {0.5f, 0.25f, 1}}));
    EXPECT_EQ(m.clear().attenuationDistance, 2);
    EXPECT_EQ(said, "");
    EXPECT_EQ(materialOf(glass(kVolume)).clear().absorption, vec3(0)); // glTF's infinity: nothing is absorbed
}

TEST(GltfMaterial, ThinWallsBendNothingAndSayWhatIsMissing) {
    for (const std::string volume : {"", R"(, "KHR_materials_volume": { "attenuationDistance": 1 })"}) {
        std::string said;
        const Material m =
            materialOf(glass(volume, R"(, "KHR_materials_dispersion": { "dispersion": 1 })"), &said);
        EXPECT_EQ(m.clear().transmission, 0.75f);
        EXPECT_EQ(m.clear().ior, 1);
        EXPECT_EQ(m.clear().dispersion, 0);
        EXPECT_EQ(m.clear().absorption, vec3(0));
        EXPECT_EQ(said, "not read: the reflection of thin walls (KHR_materials_volume.thicknessFactor 0)\n");
    }
}

TEST(GltfMaterial, ScatteringVolumesAreReadInPhysicalTerms) {
    std::string said;
    const auto scattering = [&](const std::string& scatter, const std::string& volume) {
        return materialOf(matt(R"(, "roughnessFactor": 0.25)") +
                              R"(, "extensions": { "KHR_materials_diffuse_transmission":
                                 { "diffuseTransmissionFactor": 1 }, "KHR_materials_volume": { )" +
                              volume + R"( }, "KHR_materials_volume_scatter": { )" + scatter + " } }",
                          &said);
    };
    const std::string volume =
        R"("thicknessFactor": 1, "attenuationColor": [0.5, 0.25, 0.5], "attenuationDistance": 0.01)";
    const Material m = scattering(R"("multiscatterColor": [0, 0.5, 1])", volume);
    EXPECT_EQ(said, "");
    EXPECT_EQ(m.translucent().roughness, 0.25f);
    EXPECT_FALSE(m.isRefractive());
    // The fit at a half space's albedo of 0, 1/2 and 1: s = 1, sqrt(0.1598), 0.
    const double extinction = std::log(2) / 0.01;
    EXPECT_NEAR(double(m.translucent().scattering.x), 0, 1e-3 * extinction);
    EXPECT_NEAR(double(m.translucent().absorption.x), extinction, 1e-3 * extinction);
    const double s = 4.09712 + 4.20863 / 2 - std::sqrt(9.59217 + 41.6808 / 2 + 17.7126 / 4);
    EXPECT_NEAR(double(m.translucent().scattering.y), (1 - s * s) * 2 * extinction, 1e-4 * extinction);
    EXPECT_NEAR(double(m.translucent().absorption.y), s * s * 2 * extinction, 1e-4 * extinction);
    EXPECT_NEAR(double(m.translucent().scattering.z), extinction, 1e-3 * extinction);
    // As much light comes back whatever the anisotropy: s² = (1 - a) / (1 - g a).
    const Material forward =
        scattering(R"("multiscatterColor": [0, 0.5, 1], "scatterAnisotropy": 0.5)", volume);
    EXPECT_EQ(forward.translucent().anisotropy, 0.5f);
    const double albedo = double(forward.translucent().scattering.y) / (2 * extinction);
    EXPECT_NEAR((1 - albedo) / (1 - 0.5 * albedo), s * s, 1e-4);

    EXPECT_FALSE(scattering(R"("multiscatterColor": [1, 1, 1])", R"("thicknessFactor": 1)").isScattering());
    EXPECT_EQ(said, "not read: diffuseTransmissionFactor, multiscatterColor without a volume that attenuates "
                    "light\n");
}

TEST(GltfMaterial, InfiniteIorAndSmoothMetalAreMirrors) {
    const Material infinite = materialOf(glass(kVolume, R"(, "KHR_materials_ior": { "ior": 0 })"));
    EXPECT_EQ(infinite.mirror().reflectance, vec3(1));
    std::string said;
    const Material metal = materialOf(
        R"(, "pbrMetallicRoughness": { "roughnessFactor": 0, "baseColorFactor": [1, 0.5, 0.25, 1] })", &said);
    EXPECT_EQ(metal.mirror().reflectance, vec3(1, 0.5f, 0.25f));
    EXPECT_EQ(said, "");
}

TEST(GltfMaterial, MetalLetsNothingThrough) {
    std::string said;
    const Material m = materialOf(
        R"(, "pbrMetallicRoughness": { "metallicFactor": 0.5, "roughnessFactor": 0 },
           "extensions": { "KHR_materials_transmission": { "transmissionFactor": 1 } )" +
            kVolume + " }",
        &said);
    EXPECT_EQ(m.clear().transmission, 0.5f);
    EXPECT_EQ(said, "not read: metallicFactor of what light passes through\n");
}

TEST(GltfMaterial, WhatIsNotReadIsNamed) {
    std::string said;
    const Material m = materialOf(
        matt(R"(, "roughnessFactor": 0.5, "baseColorTexture": { "index": 0 })") +
            R"(, "emissiveFactor": [1, 1, 1], "emissiveTexture": { "index": 0 }, "occlusionTexture": { "index": 0 },
               "alphaMode": "BLEND" } ], "textures": [ {} ],
               "extensionsUsed": [ "KHR_materials_sheen", "KHR_materials_ior", "KHR_lights_punctual" ],
               "samplers": [ { )",
        &said);
    EXPECT_EQ(said, "not read: KHR_materials_sheen, occlusionTexture "
                    "(occlusion is computed), textures of what has no texture coordinates\n");
    EXPECT_EQ(std::get<Glossy>(m.kind).roughness, 0.5f);
    EXPECT_EQ(m.base, vec3(0)); // the texture would blacken most of it
}

TEST(GltfMaterial, VerticesMayHaveColours) {
    // Four of four bytes, normalised, with an alpha that counts nothing; behind 48 bytes of positions and 12
    // of indices.
    Bytes buffer = test::squareBuffer<std::uint16_t>();
    test::append<std::uint8_t>(buffer, {255, 0, 51, 0, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 7});
    std::string json = test::gltf(buffer, 5123, "", "", "");
    const auto put = [&](const std::string& before, const std::string& text) {
        json.insert(json.find(before) + before.size(), text);
    };
    put(R"("POSITION": 0)", R"(, "COLOR_0": 2)");
    put(R"("count": 6, "type": "SCALAR" })",
        R"(, { "bufferView": 2, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC4" })");
    put(R"("byteOffset": 48, "byteLength": 28 })",
        R"(, { "buffer": 0, "byteOffset": 60, "byteLength": 16 })");
    std::string error;
    const Mesh mesh = test::read(test::glb(buffer, json), error);
    ASSERT_EQ(error, "");
    ASSERT_EQ(mesh.colors.size(), mesh.positions.size());
    for (std::size_t i = 0; i < mesh.colors.size(); ++i)
        if (mesh.positions[i] == vec3(0)) {
            EXPECT_EQ(mesh.colors[i], vec3(1, 0, 0.2f)); // linear as they stand
        }
    ASSERT_EQ(mesh.parts.size(), 1u);
    EXPECT_TRUE(mesh.parts[0].textures.vertexColors);
    EXPECT_FALSE(mesh.parts[0].textures.hasImages());
}

TEST(GltfMaterial, TrianglesAreOrderedByMaterial) {
    // The two triangles of the square in three primitives: material 1, none, material 0. Both have one name.
    std::string json = test::gltf(test::squareBuffer<std::uint16_t>(), 5123, "", R"(, "material": 1)", "");
    const std::string primitive = R"({ "attributes": { "POSITION": 0 }, "indices": 1, "material": 1 } ])";
    json.replace(json.find(primitive), primitive.size(),
                 R"({ "attributes": { "POSITION": 0 }, "indices": 1, "material": 1 },
                    { "attributes": { "POSITION": 0 }, "indices": 1 },
                    { "attributes": { "POSITION": 0 }, "indices": 1, "material": 0 } ])");
    json.insert(json.rfind('}'), R"(, "materials": [ { "name": "a" }, { "name": "a" } ])");
    std::string error;
    const Mesh mesh = test::read(test::glb(test::squareBuffer<std::uint16_t>(), json), error);
    ASSERT_EQ(error, "");
    ASSERT_EQ(mesh.parts.size(), 3u);
    EXPECT_EQ(mesh.parts[0].material, "a");
    EXPECT_EQ(mesh.parts[1].material, "a'");
    EXPECT_EQ(mesh.parts[2].material, "default");
    EXPECT_EQ(mesh.indices[0], 8u); // the third primitive's vertices
    EXPECT_EQ(mesh.indices[6], 0u);
    EXPECT_EQ(mesh.indices[12], 4u);
    json.replace(json.find(R"("material": 0)"), 13, R"("material": 9)");
    test::read(test::glb(test::squareBuffer<std::uint16_t>(), json), error);
    EXPECT_EQ(error, "m/a.gltf: points to material 9, which does not exist");
}

} // namespace
} // namespace lucent::scene
