// The picture beside its truth: what is seen where, what the numbers are, and when there are none.
#include "tests/viewer/Page.h"

#include "frame/Renderer.h"
#include "measure/Metrics.h"
#include "scene/Load.h"
#include "technique/Technique.h"

namespace lucent::viewer {
namespace {

constexpr int kSide = 40; // of the truth, pixels

// On a canvas of 800 x 400 the panel leaves 800 - 312 - 24 = 464 pixels: a square truth lies from x = 32 to
// 432.
constexpr float kLeft = 32, kExtent = 400, kTexel = kExtent / kSide;

class CompareView : public Page {
protected:
    /// Linear values of the lamp scene as a renderer of its own draws them.
    Image picture() {
        Result<scene::Scene> scene = scene::load("scene.json", files(kLampScene), technique::tables());
        EXPECT_TRUE(scene.ok());
        frame::Renderer renderer(*context);
        EXPECT_TRUE(renderer.finish(*scene, 1, ivec2(kSide)).ok());
        return *renderer.read(*scene, scene::Aov::Color);
    }
    /// The picture with every covered value changed.
    template <class Change>
    Image changed(Change change) {
        Image image = picture();
        for (std::size_t i = 0; i < image.pixels.size(); ++i)
            if (i % 4 != 3 && image.pixels[i - i % 4 + 3] > 0)
                image.pixels[i] = change(int(i / 4), image.pixels[i]);
        return image;
    }
    void compare(const Image& truth, const std::string& mode) {
        ASSERT_FALSE(viewer->askTruth().empty());
        ASSERT_TRUE(viewer->takeComputedTruth(truth, 0.001).ok());
        set("compare", mode);
    }
    void set(const std::string& path, const std::string& value) {
        const Status done = viewer->set(path, value);
        ASSERT_TRUE(done.ok()) << done.error().message;
        settle();
    }
    nlohmann::json comparison() { return nlohmann::json::parse(viewer->comparison()); }
    /// Colour that is shown at the middle of a pixel of the picture.
    vec3 shownAt(const Image& screen, ivec2 pixel) {
        const vec2 at = vec2(kLeft, 0) + (vec2(pixel) + 0.5f) * kTexel;
        const float* values = screen.at(int(at.x), int(at.y));
        return {values[0], values[1], values[2]};
    }
};

TEST_F(CompareView, ATruthThatIsDarkerByAConstantGivesThatBiasAndRmse) {
    load(kLampScene);
    compare(changed([](int, float value) { return value - 0.25f; }), "error");
    const auto found = comparison();
    // The numbers are over covered pixels; subtracting 0.25 in float rounds by 2^-26 at most for values
    // below 1.
    EXPECT_NEAR(found["bias"].get<double>(), 0.25, 1e-7);
    EXPECT_NEAR(found["rmse"].get<double>(), 0.25, 1e-7);
    EXPECT_NEAR(found["max"].get<double>(), 0.25, 1e-7);
    EXPECT_EQ(found["full"].get<double>(), 0.5);
    EXPECT_EQ(found["noise"].get<double>(), 0.001);
    EXPECT_EQ(found["truth"], "fresh");
    EXPECT_GT(found["milliseconds"].get<double>(), 0);
}

TEST_F(CompareView, APictureThatIsItsOwnTruthHasNoError) {
    load(kLampScene);
    compare(picture(), "truth");
    EXPECT_EQ(comparison()["rmse"].get<double>(), 0);
    EXPECT_EQ(comparison()["max"].get<double>(), 0);
}

TEST_F(CompareView, WhatOnlyTheTruthCoversCountsAsAnError) {
    load(kLampScene);
    Image truth = picture();
    ASSERT_EQ(truth.at(0, 0)[3], 0); // beside the field
    for (int channel = 0; channel < 4; ++channel)
        truth.at(0, 0)[channel] = 1;
    compare(truth, "error");
    EXPECT_EQ(comparison()["max"].get<double>(), 1);
}

TEST_F(CompareView, TheSeamIsWhereTheDividerIs) {
    load(kLampScene);
    compare(changed([](int, float) { return 0.f; }), "truth"); // black where the picture is lit
    const int row = 14;                                        // of the field, above the handle
    for (const char* divider : {"0.3", "0.7"}) {
        set("divider", divider);
        const Image screen = window->read();
        const int seam = int(std::lround(std::strtof(divider, nullptr) * kSide));
        for (int x = 11; x < 29; ++x) { // the field is the middle half of the picture
            if (std::abs(x - seam) < 1) continue;
            const float shown = shownAt(screen, {x, row}).g;
            EXPECT_EQ(shown > 0, x < seam) << x << " shows " << shown;
        }
    }
}

TEST_F(CompareView, ADragMovesTheDividerAndNothingElse) {
    load(kLampScene);
    compare(picture(), "truth");
    const std::string lamp = viewer->get("lights.0.position");
    const vec2 start(kLeft + kExtent / 2, 300);
    drag(start, start + vec2(100, 20));
    EXPECT_NEAR(comparison()["divider"].get<double>(), 0.75, 1e-3);
    drag(start + vec2(100, 0), start + vec2(400, 0)); // over the edge
    EXPECT_EQ(comparison()["divider"].get<double>(), 1);
    EXPECT_EQ(viewer->get("lights.0.position"), lamp);
    EXPECT_FALSE(viewer->undo()); // it is no change of the scene
}

TEST_F(CompareView, TheLampIsGrippedWhereItsDotIsShown) {
    load(kLampScene);
    compare(picture(), "truth");
    EXPECT_LT(glm::distance(dot(), vec2(kLeft + 200 + 0.2f * 200, 200 - 0.1f * 200)),
              0.5f); // 200 pixels a metre
    const vec2 start = dot();
    drag(start, start + vec2(30, 10));
    EXPECT_LT(glm::distance(dot(), start + vec2(30, 10)), 0.5f);
}

TEST_F(CompareView, TheErrorHasTheColoursOfTheHeatMap) {
    load(kLampScene);
    const Image truth = changed([](int pixel, float value) { return value + float(pixel % kSide) * 0.01f; });
    compare(truth, "error");
    set("divider", "0");
    move({700, 390});
    settle();
    const Image map = measure::heatMap(picture(), truth, comparison()["full"].get<double>());
    const Image screen = window->read();
    for (int y = 11; y < 29; ++y)
        for (int x = 11; x < 29; ++x) {
            if (glm::distance(vec2(x, y), vec2(24, 18)) < 2) continue; // the lamp's dot
            const float* wanted = map.at(x, y);
            // One step of 8 bits for rounding and another for the curve in float.
            EXPECT_LT(glm::distance(shownAt(screen, {x, y}), vec3(wanted[0], wanted[1], wanted[2])),
                      2.5f / 255)
                << x << ", " << y;
        }
}

TEST_F(CompareView, NumbersNeverCompareDifferentScenes) {
    load(kLampScene);
    compare(picture(), "error");
    set("lights.0.intensity", "0.5");
    EXPECT_EQ(comparison()["truth"], "stale");
    EXPECT_FALSE(comparison().contains("rmse"));
    ASSERT_TRUE(viewer->undo());
    settle();
    EXPECT_EQ(comparison()["truth"], "fresh");
    EXPECT_EQ(comparison()["rmse"].get<double>(), 0);
    set("view.exposure", "1"); // the same light, shown brighter
    set("technique.relief.method", "march");
    EXPECT_EQ(comparison()["truth"], "fresh");
    EXPECT_GT(comparison()["rmse"].get<double>(), 0); // a march has an error
}

TEST_F(CompareView, ATruthFromAFileBelongsToTheSceneAsLoaded) {
    load(kLampScene);
    set("lights.0.intensity", "0.5");
    Image colors(kSide, kSide, 3);
    const Image values = picture();
    for (std::size_t i = 0; i < colors.pixels.size(); ++i)
        colors.pixels[i] = values.pixels[i / 3 * 4 + i % 3];
    ASSERT_TRUE(viewer->openTruth("truth.pfm", *encodeImage(colors, "truth.pfm"), {}).ok());
    set("compare", "truth");
    EXPECT_EQ(comparison()["truth"], "stale");
    ASSERT_TRUE(viewer->undo());
    settle();
    EXPECT_EQ(comparison()["truth"], "fresh");
    EXPECT_EQ(comparison()["rmse"].get<double>(), 0); // its coverage is not known: the picture's holds
    EXPECT_FALSE(comparison().contains("noise"));
    const Status broken = viewer->openTruth("truth.pfm", Bytes(10, std::byte(1)), {});
    ASSERT_FALSE(broken.ok());
    EXPECT_EQ(broken.error().message.substr(0, 10), "truth.pfm:");
    EXPECT_EQ(comparison()["truth"], "fresh");
}

TEST_F(CompareView, ATruthThatNobodyAskedForIsRefused) {
    load(kLampScene);
    const Status refused = viewer->takeComputedTruth(picture(), {});
    ASSERT_FALSE(refused.ok());
    EXPECT_EQ(refused.error().message, "truth: nobody asked for one since the scene was loaded");
    EXPECT_FALSE(viewer->askTruth().empty());
    load(kLampScene); // another scene
    EXPECT_FALSE(viewer->takeComputedTruth(picture(), {}).ok());
}

TEST_F(CompareView, OffAgainShowsThePictureAsBefore) {
    load(kLampScene);
    move({700, 390});
    settle();
    const Image before = window->read();
    compare(changed([](int, float) { return 0.f; }), "truth");
    EXPECT_GT(differences(before, window->read()), 10000);
    EXPECT_TRUE(viewer->key("c", {})); // error
    EXPECT_TRUE(viewer->key("c", {})); // methods
    EXPECT_TRUE(viewer->key("c", {})); // materials
    EXPECT_TRUE(viewer->key("c", {})); // off
    settle();
    EXPECT_EQ(viewer->get("compare"), "off");
    EXPECT_EQ(differences(before, window->read()), 0);
}

TEST_F(CompareView, WithoutATruthItSaysSo) {
    load(kLampScene);
    const Image before = window->read();
    set("compare", "error");
    EXPECT_EQ(comparison()["truth"], "none");
    EXPECT_FALSE(comparison().contains("rmse"));
    EXPECT_GT(differences(before, window->read()), 500); // a card at the bottom
}

TEST_F(CompareView, ThePictureKeepsItsPixelsBesideACoarserTruth) {
    load(kLampScene);
    move({700, 390});
    settle();
    const Image before = window->read();
    compare(changed([](int, float) { return 0.f; }), "truth");
    const Image after = window->read();
    for (int y = 150; y < 250; ++y) // left of the divider at 232, above the card with the numbers
        for (int x = 140; x < 210; ++x)
            for (int channel = 0; channel < 4; ++channel)
                EXPECT_EQ(before.at(x, y)[channel], after.at(x, y)[channel]) << x << ", " << y;
    EXPECT_EQ(comparison()["size"], nlohmann::json({kSide, kSide}));
    EXPECT_EQ(comparison()["place"], nlohmann::json({kLeft, 0, kExtent, kExtent}));
}

TEST_F(CompareView, AStaleTruthIsStillShownAndSaysThatItIs) {
    load(kLampScene);
    compare(changed([](int pixel, float) { return float(pixel % 2); }), "error");
    set("lights.0.intensity", "0.5");
    ASSERT_EQ(comparison()["truth"], "stale");
    const Image screen = window->read();
    // The right side is the truth, in stripes here, with a card in its middle.
    EXPECT_GT(glm::distance(shownAt(screen, {24, 12}), shownAt(screen, {25, 12})), 0.9f);
    const vec3 card = shownAt(screen, {24, 20});
    set("divider", "1"); // no room for it
    EXPECT_GT(glm::distance(card, shownAt(window->read(), {24, 20})), 0.02f);
}

TEST_F(CompareView, MethodsShowsTheOtherOneRightOfTheDivider) {
    load(kLampScene);
    move({700, 390});
    settle();
    const Image hierarchy = window->read();
    set("technique.relief.method", "march");
    set("technique.relief.steps", "4"); // coarse enough to be seen
    const Image marched = window->read();
    viewer->reset("technique.relief.method");
    viewer->reset("technique.relief.steps");
    set("beside.technique.relief.method", "march");
    set("beside.technique.relief.steps", "4");
    set("compare", "methods");
    const auto isLike = [](const Image& a, const Image& b) { // above the cards, beside the handle
        for (int y = 130; y < 180; ++y)
            for (int x = 135; x < 210; ++x)
                if (a.at(x, y)[1] != b.at(x, y)[1]) return false;
        return true;
    };
    ASSERT_FALSE(isLike(marched, hierarchy));
    set("divider", "0");
    EXPECT_TRUE(isLike(window->read(), marched));
    set("divider", "1");
    EXPECT_TRUE(isLike(window->read(), hierarchy));
    EXPECT_EQ(comparison()["left"], "Method hierarchy, Steps 256");
    EXPECT_EQ(comparison()["right"]["name"], "Method march, Steps 4");
    EXPECT_NE(viewer->changes().find("\"beside.technique.relief.method\": \"march\""), std::string::npos);
}

TEST_F(CompareView, MethodsMeasuresBothSidesAgainstTheTruth) {
    load(kLampScene);
    set("beside.technique.relief.method", "march");
    compare(picture(), "methods");
    const auto found = comparison();
    EXPECT_EQ(found["rmse"].get<double>(), 0); // it is its own truth
    EXPECT_EQ(found["flip"].get<double>(), 0);
    EXPECT_GT(found["right"]["rmse"].get<double>(), 0);
    EXPECT_GT(found["right"]["flip"].get<double>(), 0);
    set("beside.technique.relief.method", "hierarchy");
    EXPECT_EQ(comparison()["right"]["rmse"].get<double>(), 0);
    EXPECT_EQ(comparison()["left"], "the same methods");
    EXPECT_FALSE(viewer->undo()); // nothing of it changes the scene
}

TEST_F(CompareView, MaterialsShowsOtherSurfacesRightOfTheDivider) {
    const std::string diffuse = "objects.field.material.diffuse", dark = "#402010";
    load(kLampScene);
    move({700, 390});
    settle();
    const auto middle = [&] { // above the cards, beside the handle
        const Image picture = window->read();
        const float* shown = picture.at(180, 150);
        return vec3(shown[0], shown[1], shown[2]);
    };
    const vec3 bright = middle();
    set(diffuse, dark);
    const vec3 darkened = middle();
    viewer->reset(diffuse);
    ASSERT_GT(glm::distance(bright, darkened), 0.1f);
    set("beside." + diffuse, dark);
    set("compare", "materials");
    set("divider", "0");
    EXPECT_EQ(middle(), darkened);
    set("divider", "1");
    EXPECT_EQ(middle(), bright);
    EXPECT_NE(comparison()["right"]["name"].get<std::string>().find("Diffuse"), std::string::npos);
    EXPECT_NE(viewer->changes().find("\"beside." + diffuse), std::string::npos);
    EXPECT_FALSE(viewer->set("beside.objects.field.material.exponent", "3").ok()); // no relief has one
}

// The truth shows the left side's materials.
TEST_F(CompareView, MaterialsMeasuresTheLeftSideAlone) {
    load(kLampScene);
    set("beside.objects.field.material.diffuse", "#402010");
    compare(picture(), "materials");
    EXPECT_EQ(comparison()["rmse"].get<double>(), 0);
    EXPECT_FALSE(comparison()["right"].contains("rmse"));
}

TEST_F(CompareView, AWrongModeSaysWhatIsExpected) {
    load(kLampScene);
    const Status wrong = viewer->set("compare", "both");
    ASSERT_FALSE(wrong.ok());
    EXPECT_EQ(wrong.error().message, "compare is \"both\"; must be off, truth, error, methods or materials");
}

} // namespace
} // namespace lucent::viewer
