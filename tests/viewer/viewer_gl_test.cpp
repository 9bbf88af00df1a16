// A person's hands on the picture: what they move, what is drawn for it, and what can be taken back.
#include "scene/Bring.h"
#include "technique/Technique.h"
#include "tests/viewer/Page.h"

#include <chrono>

namespace lucent::viewer {
namespace {

using Picture = Page;
constexpr Modifiers kShift{.shift = true}, kControl{.control = true},
    kControlShift{.shift = true, .control = true};

TEST_F(Picture, AnIdleViewerDrawsNothing) {
    load(kLampScene);
    const int drawn = viewer->drawCount();
    EXPECT_GT(drawn, 0);
    for (int i = 0; i < 20; ++i)
        EXPECT_FALSE(viewer->draw(time += 1));
    move({100, 100});
    move({120, 90}); // over the picture nothing lights up
    settle();
    EXPECT_EQ(viewer->drawCount(), drawn);
}

TEST_F(Picture, WorkBetweenFramesIsShownByTheNext) {
    load(kGlassScene);
    ASSERT_TRUE(viewer->set("camera.height", "2.2").ok());
    viewer->draw(time += 0.02); // it begins
    const int drawn = viewer->drawCount();
    const Image seen = window->read();
    const Deadline deadline;
    Viewer::Between found;
    while ((found = viewer->work()) == Viewer::Between::More)
        ASSERT_FALSE(deadline.passed());
    EXPECT_EQ(found, Viewer::Between::Picture);
    EXPECT_EQ(viewer->drawCount(), drawn);
    EXPECT_EQ(differences(seen, window->read()), 0);
    EXPECT_EQ(viewer->work(), Viewer::Between::Picture) << "what is not shown yet would be drawn over";
    viewer->draw(time += 0.02);
    EXPECT_EQ(viewer->drawCount(), drawn + 1);
    EXPECT_GT(differences(seen, window->read()), 0);
}

TEST_F(Picture, SamplesOfThePixelsFollowTheCompletePictureWhileItIsStill) {
    load(kLampScene);
    ASSERT_TRUE(viewer->set("camera.height", "2.1").ok()); // the outline lies inside of pixels
    settle();
    const Image middles = window->read();
    ASSERT_TRUE(viewer->set("technique.sampling.pixelSamples", "5").ok());
    viewer->draw(time += 0.02); // begins anew
    while (!stats()["complete"])
        viewer->draw(time += 0.02);
    EXPECT_FALSE(stats()["finished"]);
    EXPECT_EQ(differences(middles, window->read()), 0);
    const int drawn = viewer->drawCount();
    settle();
    EXPECT_TRUE(stats()["finished"]);
    EXPECT_EQ(viewer->drawCount(), drawn + 4);
    const int smooth = differences(middles, window->read()); // along the outline of the field
    EXPECT_GT(smooth, 200);
    EXPECT_LT(smooth, 20000);
    // A hand on it: no more samples until it rests.
    drag({200, 200}, {260, 180});
    EXPECT_TRUE(stats()["finished"]);
}

// Where nothing but the processor draws.
TEST_F(Picture, AFirstLookHasFewerPixelsAndGivesWayToTheWholePicture) {
    open({512, 512});
    viewer->setPanelVisible(false);
    const Status loaded = viewer->load("scene.json", files(kLampScene));
    ASSERT_TRUE(loaded.ok());
    while (!stats()["shown"])
        ASSERT_TRUE(viewer->draw(time += 0.02));
    const int downscale = stats()["downscale"];
    if (!context->caps().software) GTEST_SKIP() << "this GPU draws looks whole";
    EXPECT_GT(downscale, 1);
    EXPECT_FALSE(stats()["complete"]);
    const Image look = window->read();
    settle();
    EXPECT_EQ(stats()["downscale"], 1);
    const Image whole = window->read();
    EXPECT_GT(differences(look, whole), 1000);
    // The same field all the same: blurred over a few pixels, whose brightness hardly differs.
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
        sum += std::abs(double(look.pixels[i]) - double(whole.pixels[i]));
        all += double(whole.pixels[i]);
    }
    EXPECT_LT(sum, 0.03 * all);
}

TEST_F(Picture, EachFrameOfAnOrbitShowsTheCameraWhereItIs) {
    load(kGlassScene);
    const vec2 start(300, 200);
    move(start);
    down(start);
    for (int i = 1; i <= 6; ++i) {
        const int before = stats()["pictures"];
        move(start + vec2(8 * i, 3 * i));
        viewer->draw(time += 0.02);
        EXPECT_EQ(stats()["pictures"], before + 1) << "drawn or reprojected";
    }
    // Another light falls on another picture.
    ASSERT_TRUE(viewer->set("environment.intensity", "2").ok());
    viewer->draw(time += 0.02);
    EXPECT_FALSE(stats()["reprojected"]);
    up(start);
    settle();
    EXPECT_FALSE(stats()["reprojected"]);
}

TEST_F(Picture, WorkThatTakesLongTellsTheTimeLeftAndCanBeStopped) {
    load(kLampScene);
    EXPECT_FALSE(viewer->stop()) << "there is none";
    ASSERT_TRUE(viewer->set("technique.sampling.pixelSamples", "256").ok());
    const auto start = std::chrono::steady_clock::now();
    while (!stats().contains("progress")) {
        ASSERT_TRUE(viewer->draw(time += 0.02)) << "finished before it was told";
        ASSERT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
    }
    EXPECT_GT(stats()["progress"]["share"], 0);
    EXPECT_LT(stats()["progress"]["share"], 1);
    EXPECT_GT(stats()["progress"]["secondsLeft"], 0);
    EXPECT_TRUE(viewer->stop());
    settle();
    EXPECT_FALSE(stats().contains("progress"));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(60));
    EXPECT_LT(viewer->drawCount(), 250) << "each sample is shown";
    ASSERT_TRUE(viewer->set("technique.sampling.pixelSamples", "1").ok()); // a change begins anew
    settle();
    EXPECT_TRUE(stats()["finished"]);
}

TEST_F(Picture, TheLightsDotFollowsThePointer) {
    load(kLampScene);
    const vec2 start = dot();
    drag(start, start + vec2(50, -30));
    EXPECT_LT(glm::distance(dot(), start + vec2(50, -30)), 0.5f);
    // 0.005 m a pixel, y up.
    EXPECT_LT(glm::distance(vector("lights.0.position"), vec3(0.2f + 0.25f, 0.1f + 0.15f, 0.5f)), 1e-3f);
}

TEST_F(Picture, ThePictureChangesWithTheLight) {
    load(kLampScene);
    const Image before = window->read();
    drag({200, 200}, {300, 100});
    EXPECT_GT(differences(before, window->read()), 5000); // of the 200 x 200 pixels of the field
}

TEST_F(Picture, ADragIsOneStepBackAndOneForth) {
    load(kLampScene);
    const std::string before = viewer->get("lights.0.position");
    drag({200, 200}, {260, 180});
    const std::string after = viewer->get("lights.0.position");
    EXPECT_NE(before, after);
    EXPECT_TRUE(stats()["canUndo"].get<bool>());
    EXPECT_TRUE(viewer->undo());
    EXPECT_EQ(viewer->get("lights.0.position"), before);
    EXPECT_FALSE(stats()["canUndo"].get<bool>());
    EXPECT_TRUE(stats()["canRedo"].get<bool>());
    EXPECT_FALSE(viewer->undo());
    EXPECT_TRUE(viewer->key("Z", kControlShift));
    EXPECT_EQ(viewer->get("lights.0.position"), after);
    EXPECT_TRUE(viewer->key("z", kControl));
    EXPECT_TRUE(viewer->key("y", kControl));
    EXPECT_EQ(viewer->get("lights.0.position"), after);
    EXPECT_FALSE(viewer->redo());
}

TEST_F(Picture, TheWheelLiftsTheLightAndWithControlZooms) {
    load(kLampScene);
    EXPECT_TRUE(viewer->wheel({200, 200}, -100, {}));
    EXPECT_NEAR(vector("lights.0.position").z, 0.5f * std::exp(0.15f), 1e-3f);
    EXPECT_TRUE(viewer->wheel({200, 200}, -100, kControl));
    EXPECT_NEAR(number("camera.height"), 2 / std::exp(0.15f), 2e-3f);
    viewer->pinch(2);
    EXPECT_NEAR(number("camera.height"), 1 / std::exp(0.15f), 2e-3f);
}

TEST_F(Picture, ShiftDragOrbitsTheCameraAndZeroBringsItBack) {
    load(kLampScene);
    const std::string eye = viewer->get("camera.eye"), lamp = viewer->get("lights.0.position");
    drag({200, 200}, {300, 150}, kShift);
    EXPECT_NE(viewer->get("camera.eye"), eye);
    EXPECT_EQ(viewer->get("lights.0.position"), lamp);
    EXPECT_NEAR(glm::length(vector("camera.eye")), 2, 1e-3f);
    drag({200, 200}, {230, 200});
    EXPECT_TRUE(viewer->key("0", {}));
    EXPECT_EQ(viewer->get("camera.eye"), eye);
    EXPECT_EQ(viewer->get("lights.0.position"), lamp);
    EXPECT_EQ(viewer->changes(), "{}\n");
    EXPECT_TRUE(viewer->undo()); // all of it is one step
    EXPECT_NE(viewer->get("camera.eye"), eye);
    EXPECT_NE(viewer->get("lights.0.position"), lamp);
}

TEST_F(Picture, WithoutALampADragTurnsTheEnvironment) {
    openCoarse();
    load(kMapScene);
    drag({100, 100}, {200, 100}); // 100 of the 400 pixels of the shorter side: a quarter of half a turn
    EXPECT_LT(glm::distance(vector("environment.rotation"), vec3(0, 45, 0)), 0.2f);
    drag({100, 100}, {100, 200});
    EXPECT_LT(glm::distance(vector("environment.rotation"), vec3(45, 45, 0)), 0.2f);
    drag({100, 100}, {200, 100}, {.alt = true});
    EXPECT_LT(glm::distance(vector("environment.rotation"), vec3(45, 45, -45)), 0.2f);
    const float height = number("camera.height");
    viewer->wheel({100, 100}, -100, {});
    EXPECT_LT(number("camera.height"), height); // no lamp to lift: zoom
}

TEST_F(Picture, WithAnEnvironmentOnTheLampIsGrippedAtItsDot) {
    load(kLampScene);
    ASSERT_TRUE(viewer->set("environment.enabled", "true").ok());
    drag({50, 350}, {90, 350});
    EXPECT_EQ(vector("lights.0.position"), vec3(0.2f, 0.1f, 0.5f));
    EXPECT_NEAR(vector("environment.rotation").y, 18, 0.2f); // 40 / 400 of 180 degrees
    const vec2 start = dot();
    drag(start, start + vec2(20, 0));
    EXPECT_NEAR(vector("lights.0.position").x, 0.3f, 1e-3f);
}

TEST_F(Picture, ArrowKeysMoveTheLightAndARunOfThemIsOneStep) {
    load(kLampScene);
    for (int i = 0; i < 3; ++i)
        EXPECT_TRUE(viewer->key("ArrowRight", {}));
    // 2 % of 2 m a key.
    EXPECT_NEAR(vector("lights.0.position").x, 0.2f + 3 * 0.04f, 1e-3f);
    EXPECT_TRUE(viewer->key("PageUp", {}));
    EXPECT_NEAR(vector("lights.0.position").z, 0.55f, 1e-3f);
    EXPECT_TRUE(viewer->undo());
    EXPECT_TRUE(viewer->undo());
    EXPECT_EQ(vector("lights.0.position"), vec3(0.2f, 0.1f, 0.5f));
    EXPECT_FALSE(viewer->key("q", {}));
}

TEST_F(Picture, ValuesComeByTextAndWrongOnesSayWhatIsExpected) {
    load(kLampScene);
    const std::uint64_t revision = viewer->revision();
    const Status wrong = viewer->set("objects.field.material.specularity", "2");
    ASSERT_FALSE(wrong.ok());
    EXPECT_EQ(wrong.error().message, "objects.field.material.specularity is 2; must be in [0, 1]");
    EXPECT_EQ(viewer->revision(), revision);
    EXPECT_TRUE(viewer->set("objects.0.material.specularity", "0.5").ok()); // by number
    EXPECT_GT(viewer->revision(), revision);
    EXPECT_EQ(nlohmann::json::parse(viewer->changes()),
              nlohmann::json({{"objects.field.material.specularity", "0.5"}}));
    EXPECT_NE(viewer->sceneJson().find("\"specularity\": 0.5"), std::string::npos);
    viewer->reset("objects.field.material.specularity");
    EXPECT_EQ(viewer->changes(), "{}\n");
}

TEST_F(Picture, ABadSceneKeepsTheOldOneAndSaysWhy) {
    load(kLampScene);
    const Image before = window->read();
    const Status bad = viewer->load("scene.json", files(R"({"lucent": 1, "lights": 3})"));
    ASSERT_FALSE(bad.ok());
    EXPECT_EQ(bad.error().message.substr(0, 13), "scene.json:1:");
    settle();
    EXPECT_EQ(viewer->title(), "Lamp");
    EXPECT_EQ(viewer->get("lights.0.position"), "0.2 0.1 0.5");
    EXPECT_GT(differences(before, window->read()), 1000); // a message stands over the picture
    EXPECT_TRUE(viewer->key("Escape", {}));
    settle();
    EXPECT_EQ(differences(before, window->read()), 0);
}

TEST_F(Picture, AMessageIsClosedByItsButton) {
    load(kLampScene);
    const Image before = window->read();
    viewer->showMessage("coin.png: is truncated; must be a whole PNG");
    settle();
    // The card ends 12 pixels before the picture's right end (800 - 312 - 24 = 464), the button 22 before
    // that.
    click({464 - 12 - 22, 12 + 22});
    move({100, 300});
    settle();
    EXPECT_EQ(differences(before, window->read()), 0);
}

TEST_F(Picture, APictureBecomesTheEnvironmentAndNothingElseChanges) {
    EXPECT_EQ(viewer->openEnvironment("sky.pfm", {}).error().message,
              "sky.pfm: there is no scene to light; open a height map or a model first");
    load(kLampScene);
    const Image before = window->read();
    EXPECT_FALSE(viewer->openEnvironment("broken.png", Bytes(20, std::byte(7))).ok());
    EXPECT_EQ(viewer->get("environment.enabled"), "false");
    Image sky(4, 2, 3);
    for (float& value : sky.pixels)
        value = 0.5f;
    ASSERT_TRUE(viewer->openEnvironment("sky.pfm", *encodeImage(sky, "sky.pfm")).ok());
    EXPECT_EQ(viewer->get("environment.enabled"), "true");
    EXPECT_EQ(viewer->get("lights.0.position"), "0.2 0.1 0.5");
    settle();
    const Image lit = window->read();
    EXPECT_GT(differences(before, lit), 1000);
    ASSERT_TRUE(viewer->undo());
    settle();
    EXPECT_LT(differences(before, window->read()), 20); // the panel keeps rows: its scroll bar is shorter
    EXPECT_EQ(viewer->get("environment.enabled"), "false");
    ASSERT_TRUE(viewer->redo());
    settle();
    EXPECT_EQ(differences(lit, window->read()), 0);
}

TEST_F(Picture, AnEnvironmentIsExposedHoweverBrightItIs) {
    load(kLampScene);
    const float exposure = std::stof(viewer->get("view.exposure"));
    const auto open = [&](float radiance) {
        Image sky(4, 2, 3);
        for (float& value : sky.pixels)
            value = radiance;
        return viewer->openEnvironment("sky.pfm", *encodeImage(sky, "sky.pfm")).ok();
    };
    ASSERT_TRUE(open(0.5f));
    EXPECT_FLOAT_EQ(std::stof(viewer->get("view.exposure")), exposure - 1); // it shines as the lamp does
    // White that faces even light L from all around sends L.
    EXPECT_NEAR(std::stof(viewer->get("environment.intensity")) * 0.5f * std::exp2(exposure),
                scene::kBrightest, 0.02f);
    settle();
    const Image dim = window->read();
    ASSERT_TRUE(open(200));
    EXPECT_FLOAT_EQ(std::stof(viewer->get("view.exposure")), exposure - 1);
    settle();
    EXPECT_LT(differences(dim, window->read()), 4000); // but for the intensity that the panel says
    ASSERT_TRUE(viewer->set("view.exposure", "3").ok());
    viewer->reset("view.exposure");
    EXPECT_FLOAT_EQ(std::stof(viewer->get("view.exposure")), exposure - 1);
}

TEST_F(Picture, TwoViewersShareAContextAndKeepTheirPictures) {
    load(kLampScene);
    const Image first = window->read();
    {
        Viewer other(*context, *host);
        other.resize({800, 400}, 1);
        other.setDark(true);
        ASSERT_TRUE(other.load("scene.json", files(kMapScene)).ok());
        for (int i = 0; other.draw(i * 0.02); ++i)
            ASSERT_LT(i, 3000);
        EXPECT_GT(differences(first, window->read()), 10000);
    }
    viewer->release(); // and it can make its picture again
    settle();
    EXPECT_EQ(differences(first, window->read()), 0);
}

TEST_F(Picture, AViewerGoesOnWithAnotherHost) {
    load(kLampScene);
    ASSERT_TRUE(viewer->set("lights.0.intensity", "0.5").ok());
    settle();
    const Image before = window->read();
    gl::ImGuiHost other(*context);
    viewer->attach(*context, other);
    settle();
    EXPECT_EQ(differences(before, window->read()), 0);
    EXPECT_TRUE(viewer->undo());
    viewer->attach(*context, *host);
}

TEST_F(Picture, ASlowEnvironmentIsLookedAtQuicklyFirst) {
    openCoarse();
    load(kMapScene);
    EXPECT_TRUE(stats()["complete"].get<bool>());
    move({100, 100});
    down({100, 100});
    move({150, 100});
    int frames = 0;
    while (viewer->draw(time += 0.02))
        ASSERT_LT(++frames, 3000); // while held, the preview is enough
    EXPECT_FALSE(stats()["complete"].get<bool>());
    up({150, 100});
    settle();
    EXPECT_TRUE(stats()["complete"].get<bool>());
    EXPECT_GT(stats()["lights"].get<int>(), 20); // the preview takes no more
}

// --- scenes without a relief

TEST_F(Picture, WithoutAReliefADragOrbitsAndTheWheelZooms) {
    openCoarse();
    load(kGlassScene);
    const std::string spot = viewer->get("lights.0.position"), map = viewer->get("environment.rotation");
    drag({200, 300}, {300, 300});
    // 100 of 400 pixels: a quarter of half a turn to the left of the eye, which stood at (0, 0, 2).
    EXPECT_LT(glm::distance(vector("camera.eye"), vec3(-std::sqrt(2.f), 0, std::sqrt(2.f))), 0.02f);
    EXPECT_TRUE(viewer->wheel({200, 300}, -100, {}));
    EXPECT_NEAR(number("camera.height"), 2 / std::exp(0.15f), 2e-3f);
    EXPECT_EQ(viewer->get("lights.0.position"), spot);
    EXPECT_EQ(viewer->get("environment.rotation"), map);
    EXPECT_TRUE(viewer->key("0", {}));
    EXPECT_TRUE(viewer->key("ArrowRight", {}));
    EXPECT_NE(vector("camera.eye"), vec3(0, 0, 2));
}

TEST_F(Picture, WithoutAReliefShiftAndDragTurnTheEnvironmentAndAltRollsIt) {
    openCoarse();
    load(kGlassScene);
    drag({200, 300}, {240, 300}, kShift);
    EXPECT_LT(glm::distance(vector("environment.rotation"), vec3(0, 18, 0)), 0.2f); // 40 / 400 of 180 degrees
    drag({200, 300}, {240, 300}, {.alt = true});
    EXPECT_LT(glm::distance(vector("environment.rotation"), vec3(0, 18, -18)), 0.2f);
    EXPECT_EQ(vector("camera.eye"), vec3(0, 0, 2));
}

TEST_F(Picture, StatsSayWhatIsNotDrawn) {
    ASSERT_TRUE(viewer->load("scene.json", files(kLampScene)).ok());
    EXPECT_TRUE(stats()["notDrawn"].empty());
    ASSERT_TRUE(viewer->load("scene.json", files(kGlassScene)).ok());
    const std::vector<std::string> lines = stats()["notDrawn"];
    EXPECT_FALSE(lines.empty());
    EXPECT_EQ(lines, technique::notDrawn(*viewer->scene()));
}

TEST_F(Picture, AProgramWithoutATechniqueSaysWhichObjectsItDoesNotDraw) {
    const technique::Technique* const reliefs[] = {technique::find("relief")};
    const auto linesOf = [&](const std::string& scene) {
        EXPECT_TRUE(viewer->load("scene.json", files(scene)).ok());
        return technique::notDrawn(*viewer->scene(), {}, reliefs);
    };
    EXPECT_TRUE(linesOf(kLampScene).empty());
    const std::vector<std::string> lines = linesOf(kGlassScene);
    ASSERT_EQ(lines.size(), viewer->scene()->objects.size());
    EXPECT_EQ(lines.front().find("object \"" + viewer->scene()->objects.front().name + "\""), 0u);
}

TEST_F(Picture, SpotsAndAreaLightsAreDraggedByTheirDots) {
    openCoarse();
    load(kGlassScene);
    // 0.005 m a pixel around the middle of the picture, which is 464 pixels wide.
    drag({232 + 100, 100}, {232 + 60, 120});
    EXPECT_LT(glm::distance(vector("lights.0.position"), vec3(0.3f, 0.4f, 0)), 1e-3f);
    drag({232 - 100, 100}, {232 - 80, 120});
    EXPECT_LT(glm::distance(vector("lights.1.corner"), vec3(-0.4f, 0.4f, 0)), 1e-3f);
    EXPECT_EQ(vector("camera.eye"), vec3(0, 0, 2));
}

// --- time

class Playing : public Page {
protected:
    void SetUp() override {
        Page::SetUp();
        if (context) open({120, 80}); // many pictures, each as small as can be
    }
    /// Draws for `seconds`, a frame every 20 ms.
    void watch(double seconds) {
        for (long left = std::lround(seconds / 0.02); left > 0; --left)
            viewer->draw(time += 0.02);
    }
    /// Draws while no time passes, until a picture of this time begins.
    void waitFor(float moment) {
        const Deadline deadline;
        while (number("view.time") < moment) {
            ASSERT_FALSE(deadline.passed());
            viewer->draw(time);
        }
    }
};

TEST_F(Playing, TimeRunsWhileItPlaysAndStandsStillElse) {
    load(kGlassScene);
    watch(0.2);
    EXPECT_EQ(number("view.time"), 0);
    EXPECT_TRUE(viewer->key(" ", {}));
    EXPECT_EQ(viewer->get("playing"), "true");
    watch(0.5);
    EXPECT_LE(number("view.time"), 0.5f + 1e-4f); // what passed since the last picture began is not in it yet
    waitFor(0.5f - 1e-4f);
    const float reached = number("view.time");
    EXPECT_NEAR(reached, 0.5f, 1e-4f);
    EXPECT_FALSE(viewer->undo()); // time is no step
    EXPECT_TRUE(viewer->set("playing", "false").ok());
    settle();
    const int drawn = viewer->drawCount();
    watch(0.5);
    EXPECT_EQ(number("view.time"), reached);
    EXPECT_EQ(viewer->drawCount(), drawn);
}

TEST_F(Playing, AfterAPauseTimeGoesOnWhereItWas) {
    load(kGlassScene);
    ASSERT_TRUE(viewer->set("playing", "true").ok());
    watch(0.1);
    const float before = number("view.time");
    time += 3600; // off the screen for an hour
    watch(0.1);
    EXPECT_LT(number("view.time") - before, 0.5f);
}

TEST_F(Playing, APictureThatTakesLongIsSlowMotion) {
    load(kGlassScene);
    ASSERT_TRUE(viewer->set("playing", "true").ok());
    float before = number("view.time"), longest = 0;
    for (int i = 0; i < 40; ++i) {
        viewer->draw(time += 0.2);
        const float now = number("view.time");
        longest = std::max(longest, now - std::exchange(before, now));
    }
    EXPECT_GT(longest, 0);
    EXPECT_LE(longest, 0.25f + 1e-4f);
}

TEST_F(Playing, AMovingPictureIsComplete) {
    load(kGlassScene);
    ASSERT_TRUE(viewer->set("playing", "true").ok());
    const Deadline deadline;
    bool complete = false;
    while (!complete && !deadline.passed()) {
        viewer->draw(time += 0.02);
        complete = stats()["complete"].get<bool>();
    }
    EXPECT_TRUE(complete);
}

TEST_F(Playing, WhetherItPlaysIsNotInALink) {
    load(kGlassScene);
    ASSERT_TRUE(viewer->set("playing", "true").ok());
    EXPECT_EQ(viewer->changes(), "{}\n");
}

TEST_F(Playing, AStillSceneHasNothingToPlay) {
    load(kLampScene);
    EXPECT_FALSE(viewer->key(" ", {}));
    EXPECT_FALSE(viewer->set("playing", "true").ok());
    EXPECT_EQ(viewer->get("playing"), "false");
}

} // namespace
} // namespace lucent::viewer
