// Drops that a person lets fall, what the caustic map says about light, and what a mode offers.
#include "tests/viewer/Page.h"

namespace lucent::viewer {
namespace {

class Water : public Page {
protected:
    /// Draws until time stands at this moment or later, and stops it there.
    void playUntil(float moment) {
        const Deadline deadline;
        while (number("view.time") < moment && !deadline.passed())
            viewer->draw(time += 0.02);
        EXPECT_TRUE(viewer->set("playing", "false").ok());
    }
};

TEST_F(Water, AClickLetsADropFallAndTimeRuns) {
    load(kWaterScene);
    const Image before = window->read();
    const std::string eye = viewer->get("camera.eye");
    move({200, 200}); // 800 x 400 pixels with the panel on the right: the picture is 464 wide
    EXPECT_TRUE(down({200, 200}));
    up({200, 200});
    EXPECT_EQ(viewer->get("playing"), "true");
    playUntil(0.2f);
    settle();
    EXPECT_GT(differences(before, window->read()), 500);
    EXPECT_EQ(viewer->get("camera.eye"), eye);
    EXPECT_FALSE(viewer->undo()); // water forgets nothing
}

TEST_F(Water, BesideItAndWithControlADragLeadsTheCamera) {
    load(kWaterScene);
    EXPECT_FALSE(viewer->drop({20, 20}));
    drag({20, 20}, {40, 20});
    const std::string eye = viewer->get("camera.eye");
    EXPECT_EQ(viewer->get("playing"), "false");
    drag({230, 200}, {240, 200}, {.control = true});
    EXPECT_NE(viewer->get("camera.eye"), eye);
    EXPECT_EQ(viewer->get("playing"), "false");
}

TEST_F(Water, KeyAndCallLetDropsFallWhereTheyMust) {
    load(kWaterScene);
    EXPECT_TRUE(viewer->key("d", {}));
    playUntil(0.1f);
    settle();
    const Image byKey = window->read();
    EXPECT_TRUE(viewer->set("view.time", "0").ok());
    settle(); // before the drop: it is forgotten
    EXPECT_TRUE(viewer->set("view.time", "0.1").ok());
    settle();
    EXPECT_GT(differences(byKey, window->read()), 500);
    EXPECT_TRUE(viewer->drop({232, 200})); // the middle of the picture, which is 464 x 400
    EXPECT_EQ(viewer->get("playing"), "true");
}

TEST_F(Water, TheCausticMapCountsItsLight) {
    load(kWaterScene);
    EXPECT_FALSE(stats().contains("energy"));
    ASSERT_TRUE(viewer->set("view.show", "caustic-map").ok());
    settle();
    const nlohmann::json energy = stats()["energy"];
    const double met = energy["incident"][0], received = energy["received"][0];
    EXPECT_GT(met, 0);
    EXPECT_LE(received, met * 1.001); // what half floats round
    double sum = 0;
    for (const char* part : {"received", "absorbed", "reflected", "missed", "lost"})
        sum += energy[part][0].get<double>();
    EXPECT_NEAR(sum / met, 1, 1e-2); // of 32 x 32 rays; finer ones are counted in tests/caustics
    ASSERT_TRUE(viewer->set("view.show", "color").ok());
    settle();
    EXPECT_FALSE(stats().contains("energy"));
}

// Paths of the controls that the panel shows, in its order.
std::vector<std::string> pathsOf(Viewer& viewer) {
    std::vector<std::string> paths;
    for (const nlohmann::json& control : nlohmann::json::parse(viewer.controls()))
        if (control["group"] != "") paths.push_back(control["path"]);
    return paths;
}

TEST_F(Water, TheModeFollowsTheSceneAndPutsItsSlidersFirst) {
    load(kWaterScene);
    EXPECT_EQ(viewer->get("mode"), "caustics");
    EXPECT_EQ(stats()["modes"], nlohmann::json({"refraction", "caustics"}));
    EXPECT_EQ(pathsOf(*viewer)[0], "mode");
    EXPECT_EQ(pathsOf(*viewer)[1], "technique.caustics.intersect");
    ASSERT_TRUE(viewer->set("mode", "refraction").ok());
    EXPECT_EQ(pathsOf(*viewer)[1], "objects.water.material.transmission");
    EXPECT_EQ(nlohmann::json::parse(viewer->changes())["mode"], "refraction");
    viewer->reset("mode");
    EXPECT_EQ(viewer->changes(), "{}\n");
    load(kLampScene);
    EXPECT_EQ(viewer->get("mode"), "relief");
    EXPECT_EQ(pathsOf(*viewer)[0], "lights.0.position"); // nothing to choose
}

TEST_F(Water, AModeOffersItsViewsAndWhatIsShown) {
    load(kWaterScene);
    const auto offered = [&] {
        for (const nlohmann::json& control : nlohmann::json::parse(viewer->controls()))
            if (control["path"] == "view.show") return control["choices"].get<std::vector<std::string>>();
        return std::vector<std::string>();
    };
    const auto has = [&](const char* view) {
        const auto all = offered();
        return std::find(all.begin(), all.end(), view) != all.end();
    };
    EXPECT_TRUE(has("color") && has("caustic-map"));
    EXPECT_FALSE(has("d") || has("layer-depth"));
    ASSERT_TRUE(viewer->set("mode", "refraction").ok());
    EXPECT_TRUE(has("layer-depth") && has("direction"));
    EXPECT_FALSE(has("caustic-map"));
    ASSERT_TRUE(viewer->set("view.show", "caustic-map").ok());
    EXPECT_TRUE(has("caustic-map"));
}

} // namespace
} // namespace lucent::viewer
