// Scenes made of what a person brings.
#include "base/Pfm.h"
#include "scene/Bring.h"
#include "scene/Load.h"
#include "scene/Mesh.h"
#include "scene/ReflectanceTable.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

namespace lucent::scene {
namespace {

Result<Scene> loaded(const Brought& files) {
    const ReadFile read = [&](const std::string& path) -> Result<Bytes> {
        for (const Output& file : files)
            if (file.path == path) return file.bytes;
        return Error{path + ": is not among the files"};
    };
    return load(files.front().path, read, {});
}

Result<Scene> opened(std::vector<MapFile> maps) {
    const Result<Brought> files = sceneOfMaps(maps);
    return files ? loaded(*files) : files.error();
}

Image grey(ivec2 size, std::function<float(int, int)> value) {
    Image image(size.x, size.y, 1);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            *image.at(x, y) = value(x, y);
    return image;
}

MapFile map(MapUse use, const std::string& name, const Image& image) {
    return {use, name, name.ends_with(".png") ? *encodeImage(image, name) : encodePfm(image)};
}

/// A hill as normals, n = 2 c - 1: h = a (1 - cos(2 pi x / N)) (1 - cos(2 pi y / N)) texels high.
Image hillNormals(int side, bool greenDown = false) {
    Image image(side, side, 3);
    const double turn = 2 * std::acos(-1.0) / side, a = 0.1 * side / 4;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double u = turn * (x + 0.5), v = turn * (y + 0.5);
            const dvec3 n = glm::normalize(dvec3(-a * turn * std::sin(u) * (1 - std::cos(v)),
                                                 a * turn * std::sin(v) * (1 - std::cos(u)), 1));
            const double stored[] = {n.x, greenDown ? -n.y : n.y, n.z};
            for (int c = 0; c < 3; ++c)
                image.at(x, y)[c] = float(stored[c] / 2 + 0.5);
        }
    return image;
}

// --- names and contents

TEST(MapUse, ComesFromTheLastPartOfAName) {
    const std::pair<const char*, std::optional<MapUse>> cases[] = {
        {"coin_height.png", MapUse::Heights},    {"a/coin-Normal.TIF", MapUse::Normals},
        {"coin.albedo.jpg", MapUse::Albedo},     {"coin_color.png", MapUse::Albedo},
        {"coin_diffuse.png", MapUse::Albedo},    {"coin_alpha.png", MapUse::Alpha},
        {"coin specular.png", MapUse::Specular}, {"height.png", MapUse::Heights},
        {"height_of_land.png", std::nullopt},    {"coin.png", std::nullopt},
        {"normal_01.png", std::nullopt},         {"", std::nullopt}};
    for (const auto& [name, use] : cases)
        EXPECT_EQ(mapUseOf(name), use) << name;
}

TEST(MapUse, ATitleIsTheNameWithoutFolderEndingAndUse) {
    const std::pair<const char*, const char*> cases[] = {
        {"a/b.c/coin_height.png", "coin"}, {"coin.png", "coin"},       {"old.coin.png", "old-coin"},
        {"height.png", "height"},          {"_height.png", "_height"}, {".png", "scene"}};
    for (const auto& [name, title] : cases)
        EXPECT_EQ(titleOf(name), title) << name;
}

TEST(MapUse, NormalsAreKnownByTheirLengthAndWhereTheyLie) {
    const Image normals = hillNormals(32);
    EXPECT_TRUE(holdsNormals(*decodeImage(*encodeImage(normals, "n.png"), "n.png", Encoding::Linear)));
    Image photo(32, 32, 3), lightGrey(32, 32, 3);
    for (std::size_t i = 0; i < photo.pixels.size(); ++i) {
        photo.pixels[i] = float(i * 7919 % 101) / 100;
        lightGrey.pixels[i] =
            0.5f + 0.5f / std::sqrt(3.0f); // of unit length, but none of a surface that is seen
    }
    EXPECT_FALSE(holdsNormals(photo));
    EXPECT_FALSE(holdsNormals(lightGrey));
    EXPECT_FALSE(holdsNormals(Image(32, 32, 1)));
}

TEST(MapUse, WhatNamesDoNotSayIsAskedOnlyWhereSomethingIsLeftOpen) {
    const auto uses = [](std::vector<std::pair<std::string, Image>> pictures) {
        std::vector<Output> files;
        for (const auto& [name, image] : pictures)
            files.push_back({name, *encodeImage(image, name)});
        return usesOf(files);
    };
    const Image plain = grey({8, 8}, [](int x, int) { return float(x) / 8; });
    using Uses = std::vector<std::optional<MapUse>>;
    Image photo(8, 8, 3), storedGrey(8, 8, 3);
    photo.at(5, 3)[0] = storedGrey.at(5, 3)[0] = 6.0f / 255; // as JPEG parts the channels of a grey pixel
    photo.at(7, 7)[2] = 1;
    EXPECT_EQ(uses({{"coin.png", plain}}), Uses{MapUse::Heights});
    EXPECT_EQ(uses({{"coin.png", storedGrey}}), Uses{MapUse::Heights});
    EXPECT_EQ(uses({{"photo.png", photo}}), Uses{std::nullopt});
    EXPECT_EQ(uses({{"photo_height.png", photo}}), Uses{MapUse::Heights});
    EXPECT_EQ(uses({{"photo.png", photo}, {"photo_normal.png", photo}}),
              (Uses{std::nullopt, MapUse::Normals}));
    EXPECT_EQ(uses({{"bricks.png", hillNormals(32)}}), Uses{MapUse::Normals});
    EXPECT_EQ(uses({{"coin.png", plain}, {"coin_albedo.png", plain}}),
              (Uses{MapUse::Heights, MapUse::Albedo}));
    EXPECT_EQ(uses({{"coin_height.png", plain}, {"b.png", plain}}), (Uses{MapUse::Heights, std::nullopt}));
    EXPECT_EQ(uses({{"a.png", plain}, {"b.png", plain}}), (Uses{std::nullopt, std::nullopt}));
}

// --- reliefs

TEST(BroughtRelief, HasItsOwnNameAndAllOfItIsInTheFrame) {
    for (const ivec2 size : {ivec2(30, 60), ivec2(60, 30), ivec2(40, 40)}) {
        const auto scene = opened({map(MapUse::Heights, "x/my.relief_height.png", Image(size.x, size.y, 1))});
        ASSERT_TRUE(scene) << scene.error().message;
        EXPECT_EQ(scene->title, "my-relief");
        EXPECT_EQ(scene->caption, "");
        ASSERT_EQ(scene->objects.size(), 1u);
        const vec2 footprint = scene->objects[0].field().footprint();
        EXPECT_FLOAT_EQ(std::max(footprint.x, footprint.y), 1);
        const float height = scene->camera.height,
                    width = height * float(scene->size.x) / float(scene->size.y);
        for (const float air : {width - footprint.x, height - footprint.y}) {
            EXPECT_GT(air, 0.05f);
            EXPECT_LT(air, 0.07f);
        }
    }
}

TEST(BroughtRelief, IsLitFromTheUpperLeftAboveItsHighestPlace) {
    const auto scene =
        opened({map(MapUse::Heights, "dem.pfm", grey({2, 1}, [](int x, int) { return x ? 700 : 300; }))});
    ASSERT_TRUE(scene) << scene.error().message;
    const vec3 lamp = std::get<PointLight>(scene->lights.at(0)).position;
    EXPECT_LT(lamp.x, 0);
    EXPECT_GT(lamp.y, 0);
    EXPECT_GT(lamp.z, 0.1f);
    // Metres become a tenth of the width, and the lowest place lies at z = 0.
    EXPECT_FLOAT_EQ(scene->objects[0].field().heightScale, 0.1f / 400);
    EXPECT_FLOAT_EQ(scene->objects[0].transform.translate.z, -300 * 0.1f / 400);
}

TEST(BroughtRelief, ItsBrightestColourEndsBelowWhite) {
    // Facing the lamp: exposure times ((1 - ks) albedo + ks specular), for E = pi.
    const auto ends = [](const Scene& scene, float albedo) {
        const float ks = scene.objects[0].material.relief().specularity;
        return std::exp2(scene.view.exposure) *
               ((1 - ks) * scene.objects[0].material.diffuse.x * albedo + ks);
    };
    const Image heights(4, 4, 1);
    const auto plain = opened({map(MapUse::Heights, "a.png", heights)});
    ASSERT_TRUE(plain);
    EXPECT_NEAR(ends(*plain, 1), kBrightest, 1e-5);
    Image dark(4, 4, 3);
    dark.pixels[5] = 0.02f; // the only light in it, linear
    const auto painted =
        opened({map(MapUse::Heights, "a_height.png", heights), map(MapUse::Albedo, "a_color.pfm", dark)});
    ASSERT_TRUE(painted);
    EXPECT_EQ(painted->objects[0].material.relief().specularity, 0);
    EXPECT_NEAR(ends(*painted, 0.02f), kBrightest, 1e-4);
}

TEST(BroughtRelief, ASetGivesEachPictureItsPlace) {
    const Image one(4, 4, 1), three(4, 4, 3);
    const auto scene =
        opened({map(MapUse::Heights, "c_height.png", one), map(MapUse::Albedo, "c_albedo.png", three),
                map(MapUse::Alpha, "c_alpha.png", one), map(MapUse::Specular, "c_specular.png", three)});
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->objects[0].material.diffuseMapFile, "c_albedo.png");
    EXPECT_EQ(scene->objects[0].material.specularMapFile, "c_specular.png");
    EXPECT_EQ(scene->objects[0].field().alphaFile, "c_alpha.png");
    EXPECT_EQ(scene->objects[0].field().source.file, "c_height.png");
}

TEST(BroughtRelief, NormalsBecomeTheHeightsTheyWereMadeOfWhicheverWayTheirGreenPoints) {
    for (const bool greenDown : {false, true}) {
        const auto scene = opened({map(MapUse::Normals, "hill_normal.png", hillNormals(64, greenDown))});
        ASSERT_TRUE(scene) << scene.error().message;
        EXPECT_EQ(scene->title, "hill");
        const HeightField& hill = scene->objects[0].field();
        // 0.1 of the width high; what 8 bits and differences of neighbours leave is below 2 %.
        EXPECT_NEAR(hill.heightScale, 0.1f, 0.002f);
        EXPECT_NEAR(*hill.heights->at(32, 32), 1, 0.01f);
        EXPECT_NEAR(*hill.heights->at(0, 63), 0, 0.02f);
    }
}

TEST(BroughtRelief, WhatIsNoSetIsRefusedByName) {
    const Image one(2, 2, 1);
    EXPECT_EQ(opened({map(MapUse::Albedo, "c_albedo.png", Image(2, 2, 3))}).error().message,
              "c_albedo.png: comes without heights; a set must have a height map or a normal map");
    EXPECT_EQ(
        opened({map(MapUse::Heights, "a.png", one), map(MapUse::Heights, "b.png", one)}).error().message,
        "b.png: is a second height map beside a.png; a set must have one of each");
    EXPECT_EQ(opened({MapFile{MapUse::Heights, "a.png", {}}}).error().message,
              "a.png: is empty; must be a PNG, JPEG, HDR or PFM image");
}

// --- models

/// Two triangles of two materials in a box from (1, 2, 3) to (3, 6, 7), times `scale`.
Mesh twoParts(float scale = 1) {
    Mesh mesh{.positions = {{1, 2, 3}, {3, 2, 3}, {1, 6, 7}, {3, 6, 7}}, .indices = {0, 1, 2, 1, 3, 2}};
    for (vec3& position : mesh.positions)
        position *= scale;
    Material glass;
    glass.kind = Clear{.ior = 1.7f};
    mesh.parts = {{"paper", 0, 3, {}}, {"window.pane", 3, 3, glass}};
    return mesh;
}

Result<Scene> opened(const Mesh& mesh) {
    const Result<Brought> files = sceneOfMesh("model.glb", encodeMesh(mesh));
    return files ? loaded(*files) : files.error();
}

TEST(BroughtModel, KeepsTheMaterialsOfItsFileAndStandsOnAGround) {
    const Result<Scene> scene = opened(twoParts());
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->objects.size(), 3u);
    EXPECT_EQ(scene->title, "model");
    EXPECT_EQ(scene->objects[0].name, "model/paper");
    EXPECT_FALSE(scene->objects[0].material.isRefractive());
    EXPECT_EQ(scene->objects[1].material.clear().ior, 1.7f);
    EXPECT_EQ(scene->objects[2].name, "ground");
    EXPECT_NEAR(scene->objects[2].transform.translate.y, 2, 0.01f);
    EXPECT_EQ(scene->lights.size(), 1u);
    EXPECT_EQ(scene->environment->source, "sky");
}

TEST(BroughtModel, WithoutMaterialsItIsOneOpaqueObject) {
    Mesh mesh = twoParts();
    mesh.parts.clear();
    const Result<Scene> scene = opened(mesh);
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->objects.size(), 2u);
    EXPECT_EQ(scene->objects[0].material.diffuse, Material().diffuse);
}

TEST(BroughtModel, TheBoxAroundItJustFitsTheFrameAtAnySize) {
    for (const float scale : {0.001f, 1.0f, 100.0f}) {
        const Result<Scene> scene = opened(twoParts(scale));
        ASSERT_TRUE(scene) << scene.error().message;
        const Camera& camera = scene->camera;
        const vec3 back = glm::normalize(camera.eye - camera.target);
        const vec3 right = glm::normalize(glm::cross(camera.up, back)), up = glm::cross(back, right);
        const float slope = std::tan(glm::radians(camera.fov / 2));
        const vec2 frame = slope * vec2(float(scene->size.x) / float(scene->size.y), 1);
        float nearest = 0; // of all corners, 1: on the border
        for (int i = 0; i < 8; ++i) {
            const vec3 corner = scale * vec3(i & 1 ? 1 : 3, i & 2 ? 2 : 6, i & 4 ? 3 : 7) - camera.eye;
            const vec2 seen = vec2(glm::dot(corner, right), glm::dot(corner, up)) / -glm::dot(corner, back);
            nearest = std::max({nearest, std::abs(seen.x) / frame.x, std::abs(seen.y) / frame.y});
        }
        EXPECT_LT(nearest, 0.95f) << scale;
        EXPECT_GT(nearest, 0.9f) << scale;
    }
}

TEST(BroughtModel, LampsAndCameraOfItsFileTakeThePlacesOfOurs) {
    Mesh mesh = twoParts();
    mesh.lights = {{.position = {2, 9, 5}, .color = {1, 0.5f, 0.25f}, .intensity = 100},
                   {.kind = FileLight::Kind::Spot, .position = {2, 4, 9}, .innerAngle = 20, .outerAngle = 90},
                   {.kind = FileLight::Kind::Distant, .direction = {0, -1, 0}, .intensity = 10}};
    mesh.cameras = {{.eye = {2, 4, 20}, .fov = 25, .aspect = 2}};
    const Result<Scene> scene = opened(mesh);
    ASSERT_TRUE(scene) << scene.error().message;
    ASSERT_EQ(scene->lights.size(), 3u);
    const auto& point = std::get<PointLight>(scene->lights[0]);
    EXPECT_EQ(point.position, vec3(2, 9, 5));
    EXPECT_EQ(point.color, vec3(1, 0.5f, 0.25f));
    EXPECT_EQ(point.intensity, 100);
    EXPECT_EQ(point.falloff, LightFalloff::InverseSquare);
    EXPECT_EQ(std::get<SpotLight>(scene->lights[1]).outerAngle, 89.9f);
    EXPECT_EQ(std::get<DistantLight>(scene->lights[2]).irradiance, 10);
    EXPECT_EQ(scene->camera.eye, vec3(2, 4, 20));
    EXPECT_EQ(scene->camera.target, vec3(2, 4, 5)); // as far as the middle
    EXPECT_EQ(scene->camera.fov, 25);
    EXPECT_EQ(scene->size, ivec2(768, 384));
    // What is white and faces them: 100 / 25 + 1 / 16 + 10 of lamps, three sevenths of it from the sky; it
    // ends where the brightest may, and the glass throws a caustic as bright as white.
    const float white = (100.0f / 25 + 1.0f / 16 + 10) / std::numbers::pi_v<float> / 0.7f;
    EXPECT_NEAR(std::exp2(scene->view.exposure) * white, kBrightest, 1e-3f);
    EXPECT_NEAR(scene->environment->intensity, 0.3f * white, 1e-4f);
}

TEST(BroughtModel, AMeasuredMaterialIsShownOnABall) {
    const auto brdf = [](const dvec3& toLight, const dvec3& toEye) {
        return vec3(0.2f, 0.1f, float(0.05 * toLight.z * toEye.z));
    };
    const Result<Brought> files =
        sceneOfTable("gold paint.binary", encodeMerl(tabulate(brdf, TableForm::Merl, 0, 0)));
    ASSERT_TRUE(files) << files.error().message;
    const Result<Scene> scene = loaded(*files);
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(scene->title, "gold paint");
    const auto* measured = std::get_if<MeasuredBrdf>(&scene->objects[0].material.kind);
    ASSERT_TRUE(measured);
    EXPECT_NEAR(lookUp(*measured->table, measured->form, 0, {0, 0.6, 0.8}, {0.6, 0, 0.8}).y, 0.1, 1e-6);
    EXPECT_EQ(scene->objects[1].name, "ground");
    EXPECT_EQ(sceneOfTable("a.binary", Bytes(9)).error().message.substr(0, 10), "a.binary: ");
}

TEST(BroughtModel, WhatIsNoMeshOrHasNoExtentIsRefused) {
    EXPECT_EQ(sceneOfMesh("model.glb", Bytes(9)).error().message,
              "model.glb: is no mesh file; must be glTF 2.0, OBJ or start with LUCENTM7");
    EXPECT_EQ(opened(Mesh{.positions = {vec3(1)}, .indices = {0, 0, 0}}).error().message,
              "model.glb: is a single point; must have some extent");
}

} // namespace
} // namespace lucent::scene
