// What techniques work out once for an object, left to others: drawn without at first, then with what they
// bring.
#include "scene/Load.h"
#include "technique/Technique.h"
#include "tests/viewer/Page.h"

#include <map>

namespace lucent::viewer {
namespace {

constexpr const char* kBakedBlock = R"({"lucent": 1, "title": "Block", "size": [64, 64],
 "camera": {"type": "orthographic", "eye": [0, 0, 1], "height": 0.03},
 "lights": [{"type": "distant", "direction": [-1, -0.3, -1], "irradiance": 2}],
 "technique": {"sampling": {"pixelSamples": 1}, "throughput": {"side": 128}},
 "objects": [{"name": "block", "shape": {"type": "box", "size": [0.012, 0.012, 0.012]}, "transform": {"rotate": [30, 40, 0]},
              "material": {"preset": "marble", "precomputed": true}}]})";

class BakedElsewhere : public Page {
protected:
    void SetUp() override {
        Page::SetUp();
        if (!context) return;
        open({80, 80});
        viewer->setPanelVisible(false);
        viewer->setBakesElsewhere(true);
        load(kBakedBlock);
    }
    std::string work() const {
        const nlohmann::json said = stats();
        return said.contains("bake") ? said["bake"]["work"].get<std::string>() : "";
    }
    /// What another module makes of what is asked.
    Bytes baked() const {
        std::map<std::string, Bytes> files;
        for (auto& [name, bytes] : viewer->askBake())
            files[name] = bytes;
        const Result<scene::Scene> scene = scene::load(
            "scene.json", [&](const std::string& name) -> Result<Bytes> { return files.at(name); },
            technique::tables());
        EXPECT_TRUE(scene.ok()) << scene.error().message;
        if (!scene) return {};
        EXPECT_EQ(scene->objects.size(), 1u);
        const auto baking = technique::find("throughput")
                                ->baker->bake(scene->technique.at("throughput"), scene->objects[0], 0);
        for (;;)
            if (const auto file = baking->advance(100)) {
                EXPECT_TRUE(file->ok());
                return *file ? **file : Bytes();
            }
    }
    void bring() {
        const Status taken = viewer->takeBake(work(), baked());
        ASSERT_TRUE(taken.ok()) << taken.error().message;
        settle();
    }
    void set(const std::string& path, const std::string& value) {
        ASSERT_TRUE(viewer->set(path, value).ok());
        settle();
    }
};

TEST_F(BakedElsewhere, IsDrawnAsIfNotPrecomputedUntilItIsThere) {
    ASSERT_NE(work(), "");
    EXPECT_EQ(stats()["bake"]["object"], "block");
    EXPECT_EQ(stats()["bake"]["technique"], "throughput");
    const Image without = window->read();
    bring();
    EXPECT_EQ(work(), "");
    EXPECT_TRUE(viewer->askBake().empty());
    const Image with = window->read();
    EXPECT_GT(differences(without, with), 100);
    set("objects.block.material.precomputed", "false");
    EXPECT_EQ(differences(window->read(), without), 0);
    set("objects.block.material.precomputed", "true");
    EXPECT_EQ(work(), "") << "it was kept";
    EXPECT_EQ(differences(window->read(), with), 0);
}

TEST_F(BakedElsewhere, IsTheSameAsWorkedOutAtOnce) {
    bring();
    const Image brought = window->read();
    open({80, 80});
    viewer->setPanelVisible(false);
    load(kBakedBlock);
    EXPECT_EQ(window->read().pixels, brought.pixels);
}

TEST_F(BakedElsewhere, ServesAllObjectsOfTheSameMeshAndMaterial) {
    nlohmann::json scene = nlohmann::json::parse(kBakedBlock);
    scene["objects"].push_back(scene["objects"][0]);
    scene["objects"][1]["name"] = "other";
    scene["objects"][1]["transform"]["translate"] = {0.01, 0, 0};
    load(scene.dump().c_str());
    ASSERT_NE(work(), "");
    bring();
    EXPECT_EQ(work(), "");
}

TEST_F(BakedElsewhere, IsRefusedWhereItIsOfSomethingElse) {
    const std::string first = work();
    const Bytes file = baked();
    set("objects.block.material.preset", "ketchup");
    EXPECT_NE(work(), first) << "other coefficients, other work";
    EXPECT_FALSE(viewer->takeBake(first, file).ok()) << "nobody awaits it any more";
    EXPECT_FALSE(viewer->takeBake(work(), file).ok()) << "it is marble's";
    EXPECT_FALSE(viewer->takeBake(work(), Bytes(file.begin(), file.begin() + 100)).ok()) << "cut";
    EXPECT_NE(work(), "");
    set("objects.block.material.preset", "marble");
    EXPECT_EQ(work(), first);
    EXPECT_TRUE(viewer->takeBake(first, file).ok());
}

TEST_F(BakedElsewhere, OtherMethodsBesideAreLeftOutToo) {
    bring();
    set("compare", "methods");
    set("beside.objects.block.material.precomputed", "false");
    EXPECT_EQ(work(), "") << "the other side splats";
    const auto right = nlohmann::json::parse(viewer->comparison())["right"]["name"];
    EXPECT_EQ(right, "Precomputed false");
    set("beside.objects.block.material.precomputed", "true");
    set("beside.technique.throughput.global", "sparse");
    ASSERT_NE(work(), "") << "other factors";
    bring();
    EXPECT_EQ(work(), "");
}

TEST_F(BakedElsewhere, AtlasAndIlluminationMapAreShown) {
    bring();
    EXPECT_EQ(viewer->get("mode"), "throughput");
    const Image picture = window->read();
    set("view.show", "atlas");
    const Image leaving = window->read();
    EXPECT_GT(differences(picture, leaving), 1000);
    set("technique.throughput.part", "illumination");
    EXPECT_GT(differences(leaving, window->read()), 100) << "what enters is not what leaves";
}

} // namespace
} // namespace lucent::viewer
