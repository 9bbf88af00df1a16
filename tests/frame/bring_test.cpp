// What a person brings, drawn: neither clipped nor dark, whatever its size and colours.
#include "base/Pfm.h"
#include "frame/Renderer.h"
#include "light/Samples.h"
#include "scene/Bring.h"
#include "scene/Load.h"
#include "scene/Mesh.h"
#include "technique/Technique.h"
#include "tests/support/Gl.h"

#include <cmath>

namespace lucent::frame {
namespace {

/// Of the picture as it is shown, where something covers it.
struct Brightness {
    double clipped = 0; // share of its pixels
    double mean = 0;    // sRGB, [0,1]
    double border = 0;  // pixels of an object at the border
};

struct BroughtPicture : support::GlTest {
    static scene::Scene sceneOf(const Result<scene::Brought>& files) {
        EXPECT_TRUE(files.ok()) << files.error().message;
        const ReadFile read = [&](const std::string& path) -> Result<Bytes> {
            for (const Output& file : *files)
                if (file.path == path) return file.bytes;
            return Error{path};
        };
        Result<scene::Scene> scene = scene::load(files->front().path, read, technique::tables());
        EXPECT_TRUE(scene.ok()) << scene.error().message;
        views::samplingOf(*scene).pixelSamples = 1;
        return std::move(*scene);
    }
    Image shown(const scene::Scene& scene, ivec2 size) {
        Renderer renderer(*context);
        const Status finished = renderer.finish(scene, 1, size);
        EXPECT_TRUE(finished.ok()) << finished.error().message;
        return *renderer.readDisplay(scene);
    }
    static Brightness measured(const Image& image) {
        Brightness found;
        double covered = 0;
        for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
            const float* pixel = &image.pixels[i];
            if (!(pixel[3] > 0.5f)) continue;
            ++covered;
            found.clipped += std::max({pixel[0], pixel[1], pixel[2]}) >= 1;
            found.mean += (pixel[0] + pixel[1] + pixel[2]) / 3;
        }
        found.clipped /= covered;
        found.mean /= covered;
        return found;
    }
};

// sRGB values between which a picture is neither dark nor burnt out; middle grey (18 % of the light) is 0.46.
constexpr double kDark = 0.3, kLight = 0.8;

scene::MapFile heightsFile(double low, double high, ivec2 size = {96, 64}) {
    Image image(size.x, size.y, 1);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const double waves = std::sin(0.2 * x) * std::cos(0.17 * y) + 0.3 * std::sin(1.1 * x + 0.9 * y);
            *image.at(x, y) = float(low + (high - low) * (0.5 + 0.38 * waves));
        }
    return {scene::MapUse::Heights, "waves_height.pfm", encodePfm(image)};
}

TEST_F(BroughtPicture, AReliefIsNeitherClippedNorDarkFromAMillimetreToAHundredMetres) {
    for (const auto& [low, high] : {std::pair(0.0, 1.0), {0.0, 0.001}, {-0.5, 0.5}, {100.0, 200.0}}) {
        const scene::MapFile maps[] = {heightsFile(low, high)};
        const Brightness found = measured(shown(sceneOf(scene::sceneOfMaps(maps)), {96, 64}));
        EXPECT_EQ(found.clipped, 0) << low << " to " << high;
        EXPECT_GT(found.mean, kDark) << low << " to " << high;
        EXPECT_LT(found.mean, kLight) << low << " to " << high;
    }
}

TEST_F(BroughtPicture, AReliefOfDarkOrWhiteColoursIsNeitherClippedNorDark) {
    for (const float albedo : {0.03f, 0.3f, 1.0f}) {
        Image colors(96, 64, 3);
        std::fill(colors.pixels.begin(), colors.pixels.end(), albedo);
        const scene::MapFile maps[] = {heightsFile(0, 1),
                                       {scene::MapUse::Albedo, "waves_albedo.pfm", encodePfm(colors)}};
        const Brightness found = measured(shown(sceneOf(scene::sceneOfMaps(maps)), {96, 64}));
        EXPECT_EQ(found.clipped, 0) << albedo;
        EXPECT_GT(found.mean, kDark) << albedo;
        EXPECT_LT(found.mean, kLight) << albedo;
    }
}

scene::Mesh ball(float radius, float albedo) {
    scene::Mesh mesh = scene::meshOf(scene::Sphere{radius}, 64);
    scene::Material material;
    material.kind = scene::Matt{};
    material.diffuse = vec3(albedo);
    mesh.parts = {{"paint", 0, std::uint32_t(mesh.indices.size()), material}};
    return mesh;
}

TEST_F(BroughtPicture, AModelIsNeitherClippedNorDarkFromAMillimetreToAHundredMetres) {
    for (const float albedo : {0.05f, 1.0f}) {
        std::optional<Brightness> first;
        for (const float radius : {0.0005f, 0.5f, 50.0f}) {
            const auto files = scene::sceneOfMesh("ball.glb", scene::encodeMesh(ball(radius, albedo)));
            const Brightness found = measured(shown(sceneOf(files), {64, 64}));
            EXPECT_EQ(found.clipped, 0) << radius << " m, " << albedo;
            EXPECT_GT(found.mean, kDark) << radius << " m, " << albedo;
            EXPECT_LT(found.mean, kLight) << radius << " m, " << albedo;
            if (!first) first = found;
            EXPECT_NEAR(found.mean, first->mean, 0.01) << radius << " m, " << albedo;
        }
    }
}

TEST_F(BroughtPicture, AGlassModelThrowsACausticOnItsGround) {
    scene::Mesh mesh = ball(0.5f, 0.8f);
    mesh.parts[0].values.kind = scene::Clear{};
    const scene::Scene scene = sceneOf(scene::sceneOfMesh("ball.glb", scene::encodeMesh(mesh)));
    scene::Scene bare = scene;
    bare.objects.erase(bare.objects.begin());
    const Image image = shown(scene, {96, 96}), ground = shown(bare, {96, 96});
    // Without glass the ground is nowhere as bright as where the ball focuses the lamp on it.
    int brighter = 0;
    for (std::size_t i = 0; i < image.pixels.size(); i += 4)
        brighter += image.pixels[i] > ground.pixels[i] + 0.1f;
    EXPECT_GT(brighter, 40);
    EXPECT_LT(measured(image).clipped, 0.01);
}

} // namespace
} // namespace lucent::frame
