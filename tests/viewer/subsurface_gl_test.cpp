// Mode subsurface: words for subsurface scattering, its curves, and the comparison with a matt surface.
#include "tests/viewer/Page.h"

#include "diffusion/Profile.h"
#include "scene/MaterialPresets.h"
#include "viewer/Mode.h"

#include <algorithm>

namespace lucent::viewer {
namespace {

const std::string kMaterial = "objects.ball.material.";

class SubsurfaceTest : public Page {
protected:
    void SetUp() override {
        Page::SetUp();
        if (!context) return;
        load(kMarbleScene);
        if (viewer) start = materialNow();
    }
    nlohmann::json controls() const { return nlohmann::json::parse(viewer->controls()); }
    nlohmann::json profile() const { return nlohmann::json::parse(viewer->profiles())[0]; }
    vec4 widget(const std::string& path) {
        viewer->focusControl(path);
        settle();
        const nlohmann::json panel = stats()["panel"];
        EXPECT_TRUE(panel.contains(path)) << path;
        if (!panel.contains(path)) return vec4(0);
        return {panel[path][0].get<float>(), panel[path][1].get<float>(), panel[path][2].get<float>(),
                panel[path][3].get<float>()};
    }
    // Draws nothing.
    void loadOnly(const char* scene) {
        const Status loaded = viewer->load("scene.json", files(scene));
        ASSERT_TRUE(loaded.ok()) << loaded.error().message;
    }
    static vec2 inside(vec4 rect, float u) { return {rect.x + u * rect.z, rect.y + 0.5f * rect.w}; }
    const scene::Material& material() const { return viewer->scene()->objects[1].material; }
    struct Coefficients {
        vec3 scattering, absorption;
        float ior;
        bool operator==(const Coefficients&) const = default;
    };
    Coefficients materialNow() const {
        return {material().translucent().scattering, material().translucent().absorption,
                material().translucent().ior};
    }
    void set(const std::string& id, const std::string& value) {
        const Status done = viewer->set(kMaterial + id, value);
        ASSERT_TRUE(done.ok()) << done.error().message;
    }

    Coefficients start;
};

TEST_F(SubsurfaceTest, TheModeOfASceneThatScattersHasItsSlidersFirst) {
    EXPECT_EQ(viewer->get("mode"), "subsurface");
    EXPECT_EQ(stats()["modes"], nlohmann::json({"subsurface", "paint"}));
    std::vector<std::string> paths;
    for (const nlohmann::json& control : controls())
        if (control["group"] != "") paths.push_back(control["path"]);
    const std::vector<std::string> first(paths.begin(), paths.begin() + 5);
    EXPECT_EQ(first, (std::vector<std::string>{"mode", "matt", kMaterial + "preset", kMaterial + "blur",
                                               kMaterial + "glow"}));
    EXPECT_LT(std::find(paths.begin(), paths.end(), "technique.subsurface.profile"),
              std::find(paths.begin(), paths.end(), "lights.0.irradiance"));
    EXPECT_EQ(std::count(paths.begin(), paths.end(), kMaterial + "attenuationColor"),
              0); // said in better words
    for (const nlohmann::json& control : controls()) {
        const auto offers = [&](const char* choice) {
            const nlohmann::json& choices = control["choices"];
            return std::find(choices.begin(), choices.end(), choice) != choices.end();
        };
        if (control["path"] == kMaterial + "scatteringPerMm") {
            EXPECT_EQ(control["axes"], "rgb");
        }
        if (control["path"] == kMaterial + "preset") {
            EXPECT_FALSE(offers("own"));
        }
        if (control["path"] != "view.show") continue;
        EXPECT_TRUE(offers("color") && offers("radiosity") && offers("irradiance"));
        EXPECT_FALSE(offers("caustic-map") || offers("visibility"));
    }
}

TEST_F(SubsurfaceTest, AMeasuredMaterialIsOneStepAndUndoneToTheBit) {
    const Image before = window->read();
    EXPECT_EQ(viewer->get(kMaterial + "preset"), "marble");
    set("preset", "skin1");
    settle();
    EXPECT_EQ(material().translucent().ior, 1.3f);
    EXPECT_NEAR(material().translucent().scattering.z, 1010, 1e-3);
    EXPECT_GT(differences(before, window->read()), 5000);
    EXPECT_TRUE(viewer->undo());
    EXPECT_EQ(materialNow(), start);
    settle();
    EXPECT_EQ(differences(before, window->read()), 0);
    EXPECT_TRUE(viewer->redo());
    EXPECT_EQ(viewer->get(kMaterial + "preset"), "skin1");
    EXPECT_TRUE(viewer->undo());
    EXPECT_FALSE(viewer->undo());
    EXPECT_EQ(viewer->changes(), "{}\n");
}

TEST_F(SubsurfaceTest, ADragOnBlurMovesTheOthersAndIsOneStep) {
    const float glow = number(kMaterial + "glow");
    const vec4 slider = widget(kMaterial + "blur"); // 0.02 to 50 mm
    drag(inside(slider, 0.4f), inside(slider, 0.75f));
    const double wanted = 0.02 * std::pow(50 / 0.02, 0.75);
    EXPECT_NEAR(number(kMaterial + "blur"), wanted, 0.01 * wanted); // steps of a pixel
    EXPECT_NEAR(number(kMaterial + "glow"), glow, 1e-5);
    const double factor = double(material().translucent().scattering.x) / double(start.scattering.x);
    EXPECT_NEAR(material().translucent().absorption.y, factor * double(start.absorption.y),
                1e-5 * factor * double(start.absorption.y));
    EXPECT_NEAR(vector(kMaterial + "scatteringPerMm").x, material().translucent().scattering.x / 1000, 1e-6);
    EXPECT_EQ(viewer->get(kMaterial + "preset"), "own");
    EXPECT_TRUE(viewer->undo());
    EXPECT_EQ(materialNow(), start);
    EXPECT_FALSE(viewer->undo());
}

TEST_F(SubsurfaceTest, ADragThatPassesAPlaceTwiceFindsTheSameNumbersThere) {
    for (const std::string id : {"blur", "glow"}) {
        const vec4 slider = widget(kMaterial + id);
        move(inside(slider, 0.5f));
        down(inside(slider, 0.5f));
        const Coefficients middle = materialNow();
        for (int i = 0; i < 60; ++i)
            move(inside(slider, 0.5f + 0.4f * std::sin(float(i))));
        EXPECT_NE(materialNow(), middle) << id;
        move(inside(slider, 0.5f));
        EXPECT_EQ(materialNow(), middle) << id;
        up(inside(slider, 0.5f));
        EXPECT_TRUE(viewer->undo());
        EXPECT_EQ(materialNow(), start) << id;
    }
}

TEST_F(SubsurfaceTest, GlowAndTheCoefficientsFollowEachOther) {
    set("glow", "0.5");
    EXPECT_NEAR(number(kMaterial + "blur"), 3 / 7.8233, 1e-5); // sigma_t' stays
    EXPECT_GT(material().translucent().absorption.x, start.absorption.x);
    const std::string scattering = viewer->get(kMaterial + "scatteringPerMm");
    set("absorptionPerMm", "0 0 0");
    EXPECT_EQ(viewer->get(kMaterial + "scatteringPerMm"), scattering);
    EXPECT_EQ(viewer->get(kMaterial + "glow"), "1");
    EXPECT_FALSE(viewer->set(kMaterial + "blur", "0").ok());
    EXPECT_EQ(viewer->get(kMaterial + "scatteringPerMm"), scattering);
}

TEST_F(SubsurfaceTest, ResetBringsBackNumbersThatAreNobodysMeasurement) {
    loadOnly(R"({"lucent": 1, "lights": [{"type": "distant"}],
 "objects": [{"name": "ball", "shape": {"type": "sphere"}, "material": {"scattering": [3, 4, 5], "absorption": 0.5}}]})");
    EXPECT_EQ(viewer->get("objects.ball.material.preset"), "own");
    set("preset", "cream");
    viewer->reset(kMaterial + "preset");
    EXPECT_EQ(viewer->changes(), "{}\n");
    EXPECT_EQ(viewer->get(kMaterial + "preset"), "own");
    set("blur", "7");
    viewer->reset(kMaterial + "blur");
    EXPECT_EQ(viewer->get(kMaterial + "scattering"), "3 4 5");
}

TEST_F(SubsurfaceTest, TheCurvesAreTheProfileThatIsDrawn) {
    for (const std::string name : {"dipole", "multipole", "burley"}) {
        EXPECT_TRUE(viewer->set("technique.subsurface.profile", name).ok());
        set("thickness", "0.004");
        const auto shape = diffusion::Shape(name == "dipole" ? 0 : name == "multipole" ? 1 : 2);
        const nlohmann::json plot = profile();
        EXPECT_EQ(plot["owner"], "ball");
        EXPECT_EQ(plot["profile"], name);
        const auto media = diffusion::mediaOf(material());
        double last = 0;
        for (std::size_t i = 0; i < plot["distances"].size(); ++i) {
            const double mm = plot["distances"][i];
            EXPECT_GT(mm, last);
            last = mm;
            for (std::size_t c = 0; c < 3; ++c) {
                const double exact = diffusion::reflectance(
                    media[c], shape, double(material().translucent().thickness), mm / 1000);
                // the numbers are floats, and so is the distance at which the curve is taken
                EXPECT_NEAR(plot["values"][i][c].get<double>(), exact / 1e6, 2e-5 * exact / 1e6)
                    << name << " at " << mm;
            }
        }
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(
                plot["whole"][c].get<double>(),
                diffusion::totalReflectance(media[c], shape, double(material().translucent().thickness)),
                1e-6);
    }
}

TEST_F(SubsurfaceTest, TheCurvesAreSaidInWords) {
    // Total reflectance of a half space of marble: 0.830, 0.791, 0.753. At 19.5 mm the dipole of red has 1.0
    // % of its light left: (0.456 + 2.86) / 19.5 e^(-0.1175 * 19.5) / (0.948 + 0.714).
    const std::string text = profile()["text"];
    EXPECT_EQ(text.find("Subsurface scattering of ball, dipole: red reaches 19.5 mm, 83.0 % leaves again; "
                        "green reaches "),
              0)
        << text;
    EXPECT_NE(text.find(" 79.1 % leaves again; blue reaches "), std::string::npos) << text;
    EXPECT_NE(text.find(" 75.3 % leaves again."), std::string::npos) << text;
}

TEST_F(SubsurfaceTest, ThePanelDrawsTheCurves) {
    (void)widget("technique.subsurface.method"); // below them
    const Image before = window->read();
    EXPECT_TRUE(viewer->set("technique.subsurface.profile", "burley").ok());
    settle();
    int reds = 0;
    const Image after = window->read();
    for (int y = 0; y < after.height; ++y)
        for (int x = 800 - 312; x < after.width; ++x) {
            const float* pixel = after.at(x, y);
            reds += pixel[0] > 0.7f && pixel[1] < 0.45f && pixel[2] < 0.45f;
        }
    EXPECT_GT(reds, 50); // a curve across some 240 pixels, where nothing else is red
    EXPECT_GT(differences(before, after), 200);
}

TEST_F(SubsurfaceTest, AsMattTheSceneStaysAndTheFarSideIsDark) {
    const auto brightness = [&](vec2 at) { // of the picture left of the panel: 464 x 400 pixels, 0.1 mm each
        const Image image = window->read();
        const float* pixel = image.at(int(232 + at.x / 1e-4f), int(200 - at.y / 1e-4f));
        return pixel[0] + pixel[1] + pixel[2];
    };
    const vec2 lit(0.004f, 0.002f), terminator(-0.0085f, -0.002f); // the light comes from the right
    const float litBefore = brightness(lit), darkBefore = brightness(terminator);
    const std::string sceneBefore = viewer->sceneJson();
    EXPECT_TRUE(viewer->key("m", {}));
    settle();
    EXPECT_EQ(viewer->get("matt"), "true");
    EXPECT_EQ(viewer->sceneJson(), sceneBefore);
    EXPECT_FALSE(viewer->undo()); // no step
    EXPECT_LT(brightness(terminator), 0.5f * darkBefore);
    EXPECT_NEAR(brightness(lit), litBefore, 0.25f * litBefore);
    EXPECT_TRUE(viewer->key("M", {}));
    settle();
    EXPECT_EQ(brightness(terminator), darkBefore);
}

TEST_F(SubsurfaceTest, ModesFollowWhatIsThere) {
    loadOnly(kGlassScene);
    EXPECT_EQ(stats()["modes"], nlohmann::json({"refraction", "caustics"}));
    EXPECT_FALSE(viewer->key("m", {})); // nothing that could be matt
    EXPECT_EQ(viewer->get("matt"), "false");
    ASSERT_TRUE(viewer->set("objects.floor.material.preset", "potato").ok());
    EXPECT_EQ(stats()["modes"], nlohmann::json({"refraction", "caustics", "subsurface", "paint"}));
    EXPECT_EQ(viewer->get("mode"), "refraction"); // which stays
    ASSERT_TRUE(viewer->set("mode", "subsurface").ok());
    EXPECT_EQ(controls()[0]["path"], "mode");
    EXPECT_EQ(controls()[1]["path"], "matt");
}

} // namespace
} // namespace lucent::viewer
