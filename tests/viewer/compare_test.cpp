// What a comparison is made of, without a picture: scales, sameness of scenes, scenes as files.
#include "tests/viewer/Scenes.h"
#include "viewer/Compare.h"

#include "frame/Renderer.h"
#include "scene/Load.h"
#include "technique/Technique.h"

#include <gtest/gtest.h>

namespace lucent::viewer {
namespace {

scene::Scene loaded(const std::string& text) {
    Result<scene::Scene> scene = scene::load("scene.json", sceneFiles(text), technique::tables());
    EXPECT_TRUE(scene.ok()) << (scene ? "" : scene.error().message);
    return std::move(*scene);
}

scene::Scene unpacked(const std::vector<std::pair<std::string, Bytes>>& files) {
    const ReadFile read = [&](const std::string& path) -> Result<Bytes> {
        for (const auto& [name, bytes] : files)
            if (name == path) return bytes;
        return Error{path + ": was not packed"};
    };
    Result<scene::Scene> scene = scene::load("scene.json", read, technique::tables());
    EXPECT_TRUE(scene.ok()) << (scene ? "" : scene.error().message);
    return std::move(*scene);
}

TEST(FullScale, IsTheNextRoundNumber) {
    EXPECT_DOUBLE_EQ(fullScale(0.3), 0.5);
    EXPECT_DOUBLE_EQ(fullScale(0.5), 0.5);
    EXPECT_DOUBLE_EQ(fullScale(0.51), 1);
    EXPECT_DOUBLE_EQ(fullScale(0.0012), 0.002);
    EXPECT_DOUBLE_EQ(fullScale(0), 1e-7); // equal pictures have a scale too
}

TEST(SamePicture, ForgetsHowItIsComputedAndShown) {
    const scene::Scene a = loaded(kLampScene);
    scene::Scene b = a;
    for (const auto& [path, value] : {std::pair{"technique.relief.method", "march"},
                                      {"technique.relief.steps", "7"},
                                      {"view.exposure", "2"},
                                      {"view.lightDot", "false"}})
        ASSERT_TRUE(scene::setParam(b, path, value).ok()) << path;
    EXPECT_TRUE(samePicture(a, b));
}

TEST(SamePicture, SeesWhateverChangesTheLight) {
    const scene::Scene a = loaded(kLampScene);
    for (const auto& [path, value] : {std::pair{"lights.0.intensity", "2"},
                                      {"objects.field.material.depth", "0.07"},
                                      {"camera.height", "1.5"},
                                      {"environment.enabled", "true"},
                                      {"technique.relief.attenuation", "exponential"},
                                      {"view.show", "d"}}) {
        scene::Scene b = a;
        ASSERT_TRUE(scene::setParam(b, path, value).ok()) << path;
        EXPECT_FALSE(samePicture(a, b)) << path;
    }
    scene::Scene other = a; // a file of the same name with other heights
    other.objects[0].field().heights = std::make_shared<Image>(*a.objects[0].field().heights);
    EXPECT_FALSE(samePicture(a, other));
}

TEST(SamePicture, SeesMeshesAndTheMomentThatIsShown) {
    const scene::Scene a = loaded(kGlassScene);
    scene::Scene later = a;
    ASSERT_TRUE(scene::setParam(later, "view.time", "0.5").ok());
    EXPECT_FALSE(samePicture(a, later));
    scene::Scene other = a; // a file of the same name with other triangles
    auto& shape = std::get<scene::MeshShape>(other.objects[1].shape);
    shape.mesh = std::make_shared<scene::Mesh>(*shape.mesh);
    EXPECT_FALSE(samePicture(a, other));
    scene::Scene brighter = a;
    ASSERT_TRUE(scene::setParam(brighter, "view.exposure", "1").ok());
    EXPECT_TRUE(samePicture(a, brighter));
}

TEST(PackScene, LoadsMeshesAndOtherShapesAgain) {
    const scene::Scene scene = loaded(kGlassScene);
    const scene::Scene again = unpacked(packScene(scene));
    ASSERT_EQ(again.objects.size(), 3u);
    const auto& shape = std::get<scene::MeshShape>(again.objects[1].shape);
    EXPECT_EQ(shape.part, ""); // the part has become a file
    EXPECT_EQ(scene::encodeMesh(*shape.mesh),
              scene::encodeMesh(*std::get<scene::MeshShape>(scene.objects[1].shape).mesh));
    EXPECT_EQ(std::get<scene::Box>(again.objects[0].shape).size, vec3(0.3f, 0.4f, 0.5f));
    EXPECT_EQ(again.objects[1].wave.amplitude, vec3(0.05f, 0, 0));
    EXPECT_EQ(again.lights.size(), 3u);
}

TEST(PackScene, LoadsToTheSameScene) {
    std::string text = kLampScene;
    text.replace(text.find("\"wave.pfm\""), 10,
                 R"("wave.pfm", "width": 0.7, "alpha": "holes.pfm", "alphaIsSolid": false)");
    const scene::Scene scene = loaded(text);
    const scene::Scene again = unpacked(packScene(scene));
    const scene::HeightField &before = scene.objects[0].field(), &after = again.objects[0].field();
    EXPECT_EQ(before.heights->pixels, after.heights->pixels); // holes are dug once
    EXPECT_EQ(before.alpha->pixels, after.alpha->pixels);
    EXPECT_EQ(before.width, after.width);
    EXPECT_EQ(before.heightScale, after.heightScale);
    EXPECT_EQ(scene.environment->map->pixels, again.environment->map->pixels);
    EXPECT_EQ(scene::toJson(scene).find("wave.pfm") != std::string::npos, true); // the original is untouched
}

} // namespace
} // namespace lucent::viewer
