// Painting by hand and by script: the same texels, taken back and saved.
#include "scene/Atlas.h"
#include "scene/Canvas.h"
#include "scene/Load.h"
#include "scene/Painting.h"
#include "tests/viewer/Page.h"

#include <array>
#include <vector>

namespace lucent::viewer {
namespace {

class Paint : public Page {
protected:
    /// A brush that makes translucent what else becomes opaque.
    void takeOpaque() {
        for (const auto& [path, value] :
             {std::pair("mode", "paint"), {"paint.unpainted", "opaque"}, {"paint.brush", "translucency"}})
            EXPECT_TRUE(viewer->set(path, value).ok()) << path;
    }
};

// A ball of marble in front of a matt wall, 0.5 m high on a picture that shows 1 m: 0.0025 m a pixel.
// Texels do not depend on how they are drawn, so that the cheapest method does.
constexpr const char* kBall = R"({"lucent": 1, "title": "Ball", "size": [512, 512],
 "camera": {"type": "orthographic", "eye": [0, 0, 2], "height": 1},
 "lights": [{"type": "distant", "direction": [-0.3, -0.5, -1]}], "view": {"lightDot": false},
 "technique": {"sampling": {"pixelSamples": 1}, "subsurface": {"method": "lambert"}},
 "objects": [{"name": "ball", "shape": {"type": "sphere", "radius": 0.25}, "material": {"preset": "marble"}},
             {"name": "wall", "shape": {"type": "box", "size": [2, 2, 0.1]}, "transform": {"translate": [0, 0, -0.5]}}]})";

// The picture beside the panel is 464 x 400.
constexpr vec2 kMiddle(232, 200);

const scene::Object& ball(const Viewer& viewer) { return viewer.scene()->objects[0]; }

std::array<std::vector<float>, 2> texels(const Viewer& viewer) {
    const auto& painting = ball(viewer).painting;
    if (!painting) return {};
    return {painting->entering->pixels, painting->leaving->pixels};
}

void choose(Viewer& viewer, const std::string& path, const std::string& value) {
    const Status set = viewer.set(path, value);
    EXPECT_TRUE(set.ok()) << set.error().message;
}

TEST_F(Paint, ADragPaintsWhereItGoesOnWhatWasOpaque) {
    load(kBall);
    takeOpaque();
    choose(*viewer, "paint.radius", "0.05");
    EXPECT_EQ(ball(*viewer).painting, nullptr);
    drag(kMiddle, kMiddle + vec2(40, 0));
    ASSERT_NE(ball(*viewer).painting, nullptr);
    const scene::Painting& painting = *ball(*viewer).painting;
    ASSERT_EQ(painting.strokes.size(), 2u); // what makes it opaque, and the drag
    EXPECT_TRUE(painting.strokes[0].fill);
    const std::vector<scene::Dab>& dabs = painting.strokes[1].dabs;
    ASSERT_EQ(dabs.size(), 9u); // one a quarter of 20 pixels, and the first
    for (std::size_t i = 0; i < dabs.size(); ++i) {
        const vec3 place = dabs[i].place;
        EXPECT_NEAR(place.x, 0.0025f * 5 * float(i), 1e-4f);
        EXPECT_NEAR(place.y, 0, 1e-4f);
        EXPECT_NEAR(glm::length(place), 0.25f, 1e-4f);
        EXPECT_GT(place.z, 0.2f); // in front
    }
    std::size_t opaque = 0, translucent = 0;
    for (std::size_t i = 3; i < painting.leaving->pixels.size(); i += 4) {
        opaque += painting.leaving->pixels[i] == 0;
        translucent += painting.leaving->pixels[i] == 1;
    }
    EXPECT_GT(opaque, painting.leaving->pixels.size() / 4 / 3); // most of what charts cover, half of the map
    EXPECT_GT(translucent, 100u);
}

// In pieces while the picture is shown: a stroke that made it would keep the page.
TEST_F(Paint, WhatFirstStrokesNeedIsThereBeforeThem) {
    std::string two = kBall; // balls, behind each other
    two.insert(two.rfind(R"({"name": "wall")"),
               R"({"name": "other", "shape": {"type": "torus", "major": 0.2, "minor": 0.1},
               "material": {"preset": "marble"}, "transform": {"translate": [0, 0, -0.2]}}, )");
    load(two.c_str());
    choose(*viewer, "mode", "paint");
    settle();
    for (int i = 0; i < 2; ++i) {
        const scene::Object& object = viewer->scene()->objects[std::size_t(i)];
        const std::pair source(scene::meshOf(object), scene::kUsualPaintSide);
        const auto* atlas = object.kept.find<std::shared_ptr<const scene::Atlas>>(source);
        ASSERT_NE(atlas, nullptr) << object.name;
        EXPECT_NE(object.kept.find<scene::PaintSurfaceMaking::Made>(*atlas), nullptr) << object.name;
    }
}

TEST_F(Paint, TheScriptOfAHandPaintsTheSameTexels) {
    load(kBall);
    takeOpaque();
    drag(kMiddle, kMiddle + vec2(60, 30));
    choose(*viewer, "paint.brush", "glow");
    choose(*viewer, "paint.color", "1 0.2 0.1");
    choose(*viewer, "paint.symmetric", "true");
    drag(kMiddle + vec2(30, 20), kMiddle + vec2(30, -40));
    const auto byHand = texels(*viewer);
    const std::string script = viewer->strokes(), scene = viewer->sceneJson();
    load(kBall);
    EXPECT_EQ(ball(*viewer).painting, nullptr);
    const Status painted = viewer->paint(script);
    ASSERT_TRUE(painted.ok()) << painted.error().message;
    EXPECT_EQ(texels(*viewer), byHand);
    load(scene.c_str()); // what a page saves
    EXPECT_EQ(texels(*viewer), byHand);
    EXPECT_EQ(viewer->strokes(), script);
}

TEST_F(Paint, UndoGoesBackToTheFirstBitAmongOtherSteps) {
    load(kBall);
    takeOpaque();
    std::vector<std::array<std::vector<float>, 2>> states{texels(*viewer)};
    for (const float y : {-30.0f, 0.0f, 30.0f}) {
        drag(kMiddle + vec2(-20, y), kMiddle + vec2(20, y));
        states.push_back(texels(*viewer));
    }
    choose(*viewer, "view.exposure", "1");
    EXPECT_TRUE(viewer->key("g", {})); // fills
    states.push_back(texels(*viewer));
    for (int i = 4; i > 0; --i) {
        EXPECT_EQ(texels(*viewer), states[std::size_t(i)]);
        EXPECT_TRUE(viewer->undo());
        if (i != 4) continue;
        EXPECT_EQ(viewer->get("view.exposure"), "1");
        EXPECT_TRUE(viewer->undo());
        EXPECT_EQ(viewer->get("view.exposure"), "0");
    }
    EXPECT_EQ(ball(*viewer).painting, nullptr);
    EXPECT_FALSE(viewer->undo());
    settle();
    for (int i = 1; i < 4; ++i) {
        EXPECT_TRUE(viewer->redo());
        EXPECT_EQ(texels(*viewer), states[std::size_t(i)]);
    }
}

TEST_F(Paint, BesideTheObjectAndWithShiftADragLeadsTheCamera) {
    load(kBall);
    choose(*viewer, "mode", "paint");
    drag(kMiddle, kMiddle + vec2(20, 0), {.shift = true});
    EXPECT_EQ(ball(*viewer).painting, nullptr);
    const std::string eye = viewer->get("camera.eye");
    EXPECT_NE(eye, "0 0 2");
    drag({20, 200}, {40, 200}); // the wall cannot be painted
    EXPECT_EQ(ball(*viewer).painting, nullptr);
    EXPECT_NE(viewer->get("camera.eye"), eye);
}

TEST_F(Paint, PressureIsOfTheRadiusAndKeysChangeTheBrush) {
    load(kBall);
    takeOpaque();
    viewer->pointer(PointerEvent::Down, kMiddle, 0, {}, true, 0.5f);
    viewer->pointer(PointerEvent::Up, kMiddle, 0, {}, true, 0);
    EXPECT_EQ(ball(*viewer).painting->strokes[1].dabs[0].pressure, 0.5f);
    EXPECT_TRUE(viewer->key("x", {}));
    EXPECT_EQ(viewer->get("paint.erase"), "true");
    EXPECT_TRUE(viewer->key("2", {}));
    EXPECT_EQ(viewer->get("paint.brush"), "blur");
    const float radius = std::strtof(viewer->get("paint.radius").c_str(), nullptr);
    EXPECT_TRUE(viewer->key("]", {}));
    EXPECT_NEAR(std::strtof(viewer->get("paint.radius").c_str(), nullptr), 1.2f * radius, 1e-5f);
}

TEST_F(Paint, EraseGoesBackToHowTheObjectBegan) {
    load(kBall);
    takeOpaque();
    drag(kMiddle, kMiddle + vec2(40, 0));
    EXPECT_TRUE(viewer->act("paint.fill").ok()); // with a translucency of 1
    choose(*viewer, "paint.erase", "true");
    choose(*viewer, "paint.radius", "1");
    drag(kMiddle, kMiddle + vec2(4, 0));
    const std::string scene = viewer->sceneJson();
    const auto leastSeen = [&] {
        const std::vector<float> leaving = texels(*viewer)[1];
        float least = 1;
        for (std::size_t i = 3; i < leaving.size(); i += 4)
            least = std::min(least, leaving[i]);
        return least;
    };
    EXPECT_EQ(leastSeen(), 0); // opaque, as by hand it begins
    load(scene.c_str());       // and begins still where the file holds its strokes
    takeOpaque();
    choose(*viewer, "paint.erase", "false");
    EXPECT_TRUE(viewer->act("paint.fill").ok());
    EXPECT_EQ(leastSeen(), 1);
    EXPECT_TRUE(viewer->act("paint.clearTranslucency").ok());
    EXPECT_EQ(leastSeen(), 0);

    load(kBall); // a script that says nothing of its start begins translucent, as the material is
    const Status painted = viewer->paint(
        R"({"lucentStrokes": 1, "strokes": [{"brush": "glow", "value": [1, 0, 0], "fill": {}},
                                            {"brush": "translucency", "value": 0, "fill": {}}]})");
    ASSERT_TRUE(painted.ok()) << painted.error().message;
    takeOpaque();
    EXPECT_EQ(leastSeen(), 0);
    EXPECT_TRUE(viewer->act("paint.clearTranslucency").ok());
    EXPECT_EQ(leastSeen(), 1);
}

TEST_F(Paint, ClearingWhatIsNotPaintedChangesNothing) {
    load(kBall);
    EXPECT_FALSE(viewer->act("paint.clearGlow").ok()); // not in this mode
    choose(*viewer, "mode", "paint");
    EXPECT_TRUE(viewer->act("paint.clearGlow").ok());
    EXPECT_EQ(ball(*viewer).painting, nullptr);
    EXPECT_FALSE(viewer->undo());
    EXPECT_EQ(viewer->act("paint.rub").error().message,
              "paint.rub: cannot be done now; actions of paint need the mode paint");
}

// Mean of 9 pixels around a place of the screen, [0,1].
vec3 colorAt(const Image& screen, vec2 at) {
    vec3 sum(0);
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            const float* pixel = screen.at(int(at.x) + x, int(at.y) + y);
            sum += vec3(pixel[0], pixel[1], pixel[2]) / 9.0f;
        }
    return sum;
}

TEST_F(Paint, TheFirstStrokeIsSeenAndTheRestIsKept) {
    load(kBall);
    choose(*viewer, "technique.subsurface.method", "multires"); // which draws the colour of what is scattered
    choose(*viewer, "mode", "paint");
    move({20, 390}); // where no ring is drawn
    settle();
    const Image before = window->read();
    drag(kMiddle, kMiddle + vec2(40, 0));
    move({20, 390});
    settle();
    const Image after = window->read();
    EXPECT_EQ(ball(*viewer).painting->strokes.size(), 1u);
    EXPECT_GT(glm::distance(colorAt(before, kMiddle + vec2(20, 0)), colorAt(after, kMiddle + vec2(20, 0))),
              0.1f);
    for (const vec2 elsewhere : {vec2(0, 60), vec2(-60, 0), vec2(20, -60)})
        EXPECT_LT(glm::distance(colorAt(before, kMiddle + elsewhere), colorAt(after, kMiddle + elsewhere)),
                  0.03f);
}

TEST_F(Paint, TheBrushIsAnEighthAsWideAsTheObjectAndResetGoesBackToThat) {
    load(kBall);
    EXPECT_EQ(viewer->get("paint.radius"), "0.031"); // 0.5 m / 16
    choose(*viewer, "paint.radius", "0.2");
    viewer->reset("paint.radius");
    EXPECT_EQ(viewer->get("paint.radius"), "0.031");
    load(kMarbleScene);
    EXPECT_EQ(viewer->get("paint.radius"), "0.0012"); // 20 mm / 16, by its triangles a little less
}

TEST_F(Paint, LayersAreShownInPlaceOfLight) {
    load(kBall);
    choose(*viewer, "mode", "paint");
    // Left half blurred to 16 times as far, its upper part red; all of it half translucent.
    const Status painted = viewer->paint(
        R"({"lucentStrokes": 1, "strokes": [
            {"brush": "translucency", "value": 0.5, "fill": {}},
            {"brush": "blur", "value": 16, "fill": {"high": [0, null, null]}},
            {"brush": "glow", "value": [1, 0, 0], "fill": {"low": [null, 0, null], "high": [0, null, null]}},
            {"brush": "outgoing", "value": [0, 0, 1], "fill": {"low": [0, null, null]}}]})");
    ASSERT_TRUE(painted.ok()) << painted.error().message;
    settle();
    const Image light = window->read();
    const auto shown = [&](const char* layer, vec2 away) {
        choose(*viewer, "paint.layer", layer);
        settle();
        return colorAt(window->read(), kMiddle + away);
    };
    const auto isNear = [](vec3 color, vec3 expected) {
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(color[i], expected[i], 1.5f / 255) << i;
    };
    const vec2 upperLeft(-40, -40), lowerLeft(-40, 40), right(40, 40);
    const vec3 half(srgbFromLinear(0.5f));
    isNear(shown("translucency", upperLeft), half);
    isNear(shown("translucency", right), half);
    isNear(shown("blur", lowerLeft), vec3(1));
    isNear(shown("blur", right), half);
    isNear(shown("glow", upperLeft), {1, 0, 0}); // without the translucency that halves its light
    isNear(shown("glow", lowerLeft), vec3(1));
    isNear(shown("outgoing", right), {0, 0, 1});
    isNear(shown("outgoing", upperLeft), vec3(1));
    (void)shown("light", right);
    EXPECT_EQ(window->read().pixels, light.pixels); // to the bit
    (void)shown("glow", right);
    choose(*viewer, "mode", "subsurface"); // layers belong to the brush
    settle();
    isNear(colorAt(window->read(), kMiddle + right), colorAt(light, kMiddle + right));
}

TEST_F(Paint, BlurThatDiffusionDoesNotDrawIsNamed) {
    load(kBall);
    choose(*viewer, "mode", "paint");
    choose(*viewer, "technique.subsurface.cells", "8");
    for (const auto& [method, brush] :
         {std::pair("lambert", "blur"), {"diffusion", "glow"}, {"diffusion", "blur"}}) {
        choose(*viewer, "technique.subsurface.method", method);
        choose(*viewer, "paint.brush", brush);
        drag(kMiddle, kMiddle + vec2(4, 0));
        const bool named = viewer->key("Escape", {}); // closes the message
        EXPECT_EQ(named, method == std::string("diffusion") && brush == std::string("blur"));
    }
}

TEST_F(Paint, WrongScriptsChangeNothing) {
    load(kBall);
    const Status painted = viewer->paint(R"({"lucentStrokes": 1, "strokes": [{"brush": "rainbow"}]})");
    ASSERT_FALSE(painted.ok());
    EXPECT_EQ(painted.error().message,
              "strokes:1: strokes.0.brush is \"rainbow\"; must be translucency, blur, glow or outgoing");
    EXPECT_EQ(ball(*viewer).painting, nullptr);
    EXPECT_EQ(viewer->paint(R"({"lucentStrokes": 1, "strokes": []})", "wall").error().message,
              "paint: objects.wall cannot be painted; its material must scatter");
}

} // namespace
} // namespace lucent::viewer
