// The panel: every declared parameter has its control, and hands on it change the scene.
#include "tests/viewer/Page.h"

namespace lucent::viewer {
namespace {

class PanelTest : public Page {
protected:
    /// The widget of a control in CSS pixels, scrolled into view by the focus.
    vec4 widget(const std::string& path) {
        viewer->focusControl(path);
        settle();
        const nlohmann::json panel = stats()["panel"];
        EXPECT_TRUE(panel.contains(path)) << path;
        if (!panel.contains(path)) return vec4(0);
        return {panel[path][0].get<float>(), panel[path][1].get<float>(), panel[path][2].get<float>(),
                panel[path][3].get<float>()};
    }
    bool isOffered(const std::string& path) {
        for (const nlohmann::json& control : nlohmann::json::parse(viewer->controls()))
            if (control["path"] == path) return control["group"] != "";
        return false;
    }
    vec2 inside(vec4 rect, float u, float v) { return {rect.x + u * rect.z, rect.y + v * rect.w}; }
    void type(const std::string& text) {
        for (const char c : text)
            EXPECT_TRUE(viewer->key(std::string(1, c), {}));
        EXPECT_TRUE(viewer->key("Enter", {}));
        settle();
    }
};

TEST_F(PanelTest, EveryParameterWithAGroupHasAControlThatCanBeReached) {
    load(kLampScene);
    int shown = 0;
    for (const nlohmann::json& control : nlohmann::json::parse(viewer->controls())) {
        const std::string path = control["path"].get<std::string>();
        EXPECT_EQ(control["value"], viewer->get(path));
        if (control["group"] == "") continue;
        const vec4 rect = widget(path);
        EXPECT_GT(rect.z, 20) << path;
        EXPECT_GE(rect.x, 800 - 12 - 312) << path;
        EXPECT_LE(rect.x + rect.z, 800 - 12) << path;
        ++shown;
    }
    EXPECT_GT(shown, 20);
}

TEST_F(PanelTest, ASliderFollowsThePointerAndADragIsOneStep) {
    load(kLampScene);
    const vec4 slider = widget("lights.0.intensity"); // 0 to 4
    drag(inside(slider, 0.25f, 0.5f), inside(slider, 0.5f, 0.5f));
    EXPECT_NEAR(number("lights.0.intensity"), 2, 0.02f);
    EXPECT_TRUE(viewer->undo());
    EXPECT_EQ(viewer->get("lights.0.intensity"), "1");
    EXPECT_FALSE(viewer->undo());
}

TEST_F(PanelTest, ALogarithmicSliderHasItsGeometricMeanInTheMiddle) {
    load(kLampScene);
    const vec4 slider = widget("objects.field.material.depth"); // 0.002 to 0.5
    click(inside(slider, 0.5f, 0.5f));
    EXPECT_NEAR(number("objects.field.material.depth"), std::sqrt(0.002f * 0.5f), 1e-3f);
}

TEST_F(PanelTest, AVectorHasASliderForEachComponent) {
    load(kLampScene);
    const vec4 rows = widget("lights.0.position"); // -1 to 1 each
    click(inside(rows, 0.25f, 5.0f / 6));
    EXPECT_NEAR(vector("lights.0.position").z, -0.5f, 0.02f);
    EXPECT_EQ(vec2(vector("lights.0.position")), vec2(0.2f, 0.1f));
}

TEST_F(PanelTest, TheEndsOfARangeDoNotCross) {
    load(kLampScene);
    const std::string path = "objects.field.material.specularFalloff"; // 0 and 1
    const vec4 slider = widget(path);
    drag(inside(slider, 0.9f, 0.5f), inside(slider, 0.6f, 0.5f));
    EXPECT_EQ(viewer->get(path), "0 0.6");
    drag(inside(slider, 0.05f, 0.5f), inside(slider, 0.95f, 0.5f));
    EXPECT_EQ(viewer->get(path), "0.6 0.6");
}

TEST_F(PanelTest, TogglesAndChoicesTakeAClick) {
    load(kLampScene);
    click(inside(widget("environment.enabled"), 0.5f, 0.5f));
    EXPECT_EQ(viewer->get("environment.enabled"), "true");
    EXPECT_EQ(viewer->get("lights.0.falloff"), "none");
    click(inside(widget("lights.0.falloff"), 0, 0.5f) + vec2(90, 0)); // the second option
    EXPECT_EQ(viewer->get("lights.0.falloff"), "inverse-square");
}

TEST_F(PanelTest, AColourIsChosenInItsPicker) {
    load(kLampScene);
    const std::string path = "objects.field.material.diffuse";
    const vec4 swatch = widget(path);
    click(inside(swatch, 0.5f, 0.5f));
    // The square's right edge is full saturation, its top full value: pure red, as a grey's hue is 0. The
    // swatch ends the line at the panel's inner edge; the square begins 10 pixels below it.
    click({swatch.x + swatch.z - 1, swatch.y + swatch.w + 13});
    const vec3 color = vector(path);
    EXPECT_GT(color.r, 0.9f);
    EXPECT_LT(color.g, 0.05f);
    EXPECT_LT(color.b, 0.05f);
}

TEST_F(PanelTest, AValueCanBeTypedAndAWrongOneIsRefusedAloud) {
    load(kLampScene);
    const std::string path = "objects.field.material.specularity";
    const vec4 slider = widget(path);
    const vec2 value = inside(slider, 1, 0) + vec2(-8, -12); // at the end of the line above
    click(value);
    type("0.123");
    EXPECT_EQ(viewer->get(path), "0.123");
    const Image before = window->read();
    click(value);
    type("7");
    EXPECT_EQ(viewer->get(path), "0.123");
    EXPECT_GT(differences(before, window->read()), 1000); // the message
    click(value);
    EXPECT_TRUE(viewer->key("5", {}));
    EXPECT_TRUE(viewer->key("Escape", {}));
    settle();
    EXPECT_EQ(viewer->get(path), "0.123");
    EXPECT_TRUE(viewer->key("h", {})); // keys are shortcuts again
    settle();
    EXPECT_TRUE(stats()["panel"].empty());
}

TEST_F(PanelTest, AChangedValueHasAMarkThatBringsItBack) {
    load(kLampScene);
    const std::string path = "lights.0.intensity";
    const vec4 slider = widget(path);
    const Image before = window->read();
    drag(inside(slider, 0.25f, 0.5f), inside(slider, 0.75f, 0.5f));
    move({100, 100});
    settle();
    // The mark stands behind the label: look for the click that resets.
    for (float x = slider.x; viewer->get(path) != "1" && x < slider.x + 150; x += 6)
        click({x, slider.y - 13});
    EXPECT_EQ(viewer->get(path), "1");
    move({100, 100});
    settle();
    EXPECT_EQ(differences(before, window->read()), 0);
}

TEST_F(PanelTest, TheFocusOfTheTwinIsMarkedWithoutMovingAnything) {
    load(kLampScene);
    const Image before = window->read();
    viewer->focusControl("lights.0.intensity");
    settle();
    const int marked = differences(before, window->read());
    EXPECT_GT(marked, 300); // a ring around some 300 x 60 pixels
    EXPECT_LT(marked, 4000);
    viewer->focusControl("");
    settle();
    EXPECT_EQ(differences(before, window->read()), 0);
}

TEST_F(PanelTest, ATooltipComesAfterARestAndThenNothingIsDrawn) {
    load(kLampScene);
    const vec4 slider = widget("lights.0.intensity");
    move(inside(slider, 0.5f, 0.5f));
    EXPECT_TRUE(viewer->draw(time += 0.02)); // waits
    const Image before = window->read();
    const int drawn = viewer->drawCount();
    EXPECT_TRUE(viewer->draw(time += 0.1));
    EXPECT_EQ(viewer->drawCount(), drawn); // waiting draws nothing
    settle();
    EXPECT_EQ(viewer->drawCount(), drawn + 1);
    EXPECT_GT(differences(before, window->read()), 2000);
    EXPECT_FALSE(viewer->draw(time += 10));
}

TEST_F(PanelTest, TheHeaderFoldsThePanelAndGivesThePictureItsRoom) {
    load(kLampScene);
    EXPECT_NEAR(dot().x, 232 + 0.2f / 0.005f, 0.1f); // the middle of 800 - 312 - 24 pixels
    click({640, 36});
    EXPECT_NEAR(dot().x, 400 + 0.2f / 0.005f, 0.1f);
    EXPECT_TRUE(stats()["panel"].empty());
    click({640, 36});
    EXPECT_FALSE(stats()["panel"].empty());
}

TEST_F(PanelTest, ANarrowCanvasHasAClosedSheetAtItsBottom) {
    open({390, 700}, 2);
    load(kLampScene);
    EXPECT_TRUE(stats()["panel"].empty());
    click({100, 680});
    const nlohmann::json panel = stats()["panel"];
    ASSERT_TRUE(panel.contains("lights.0.position"));
    EXPECT_GT(panel["lights.0.position"][1].get<float>(), 350); // the picture's upper half stays free
}

TEST_F(PanelTest, AFingerScrollsThePanelWhereItHoldsNothing) {
    load(kLampScene);
    const float before = stats()["panel"]["lights.0.intensity"][1].get<float>();
    const auto finger = [&](PointerEvent event, float y) { viewer->pointer(event, {490, y}, 0, {}, true); };
    finger(PointerEvent::Down, 300);
    finger(PointerEvent::Move, 290);
    finger(PointerEvent::Move, 260);
    finger(PointerEvent::Up, 260);
    settle();
    EXPECT_NEAR(stats()["panel"]["lights.0.intensity"][1].get<float>(), before - 40, 1.5f);
    EXPECT_EQ(viewer->changes(), "{}\n");
}

TEST_F(PanelTest, TheWheelScrollsThePanelAndLeavesTheSceneAlone) {
    load(kLampScene);
    const std::uint64_t revision = viewer->revision();
    EXPECT_TRUE(viewer->wheel({640, 300}, 200, {}));
    settle();
    EXPECT_FALSE(stats()["panel"].contains("lights.0.position"));
    EXPECT_EQ(viewer->revision(), revision);
}

TEST_F(PanelTest, AWaveDraggedFlatKeepsItsSliders) {
    openCoarse();
    load(kGlassScene);
    const std::string path = "objects.tent.wave.amplitude";
    widget(path);
    ASSERT_TRUE(viewer->set(path, "0 0 0").ok());
    settle();
    widget(path);
    widget("objects.tent.wave.period");
    widget("view.time");
}

TEST_F(PanelTest, WhatPlaysHasASwitchAndATime) {
    openCoarse();
    load(kGlassScene);
    const vec2 play = inside(widget("playing"), 0.5f, 0.5f);
    move(play);
    down(play);
    up(play);
    EXPECT_EQ(viewer->get("playing"), "true");
}

TEST_F(PanelTest, OnlyTechniquesThatTheSceneNeedsHaveControls) {
    load(kLampScene);
    EXPECT_TRUE(isOffered("technique.relief.method"));
    openCoarse();
    load(kGlassScene);
    EXPECT_FALSE(isOffered("technique.relief.method"));
    EXPECT_TRUE(viewer->set("technique.relief.method", "march").ok()); // a scene file may still say it
}

TEST_F(PanelTest, SlicesHaveControlsOnlyWhereThereAreVoxels) {
    const char* const slices[] = {"technique.refract.slices", "technique.refract.bounds",
                                  "technique.refract.peeling"};
    openCoarse();
    load(kGlassScene);
    for (const char* path : slices)
        EXPECT_FALSE(isOffered(path)) << path;
    EXPECT_FALSE(isOffered("technique.refract.normals")); // pyramids know the stored ones only
    EXPECT_TRUE(isOffered("technique.refract.maxLayers"));
    EXPECT_TRUE(viewer->set("technique.refract.slices", "512").ok()); // a scene file may still say it
    for (const auto& [key, value] :
         {std::pair("layers", "voxels"), {"trace", "bisection"}, {"normals", "delta1"}})
        ASSERT_TRUE(viewer->set(std::string("technique.refract.") + key, value).ok());
    settle();
    for (const char* path : slices)
        EXPECT_TRUE(isOffered(path)) << path;
    EXPECT_TRUE(isOffered("technique.refract.normals"));
}

} // namespace
} // namespace lucent::viewer
