// The renderer: only the passes that a scene needs, stages of an environment, and what explain says.
#include "tests/support/Fields.h"
#include "tests/support/Gl.h"

namespace lucent::frame {
namespace {

struct Frame : support::GlTest {
    scene::Scene scene = support::sceneOf(support::waves({40, 30}), 0.2f, 0.05f);
    void addEnvironment(int lights) {
        scene.environment.emplace();
        auto white = std::make_shared<Image>(8, 4, 3);
        std::fill(white->pixels.begin(), white->pixels.end(), 1.0f);
        scene.environment->map = white;
        views::samplingOf(scene).directions = lights;
    }
    // Slice by slice. @return what was said of each before the last
    std::vector<Progress> complete(Renderer& renderer, std::uint64_t revision, bool isPreview = false) {
        std::vector<Progress> said;
        while (said.size() < 10000) {
            const Result<Progress> progress = renderer.advance(scene, revision, {40, 30}, isPreview);
            EXPECT_TRUE(progress.ok()) << progress.error().message;
            if (!progress || progress->complete) return said;
            said.push_back(*progress);
        }
        ADD_FAILURE() << "the picture does not come to its end";
        return said;
    }
    // "views.surface relief.light frame.display": the passes of explain(), in order.
    std::string passes() {
        Renderer renderer(*context);
        const Result<std::string> text = renderer.explain(scene, {40, 30});
        EXPECT_TRUE(text.ok());
        std::string names;
        const std::size_t begin = text->find("passes"), end = text->find("textures that stay");
        for (std::size_t at = text->find("\n  ", begin); at < end; at = text->find("\n  ", at + 1)) {
            if ((*text)[at + 3] == ' ') continue; // a target
            names += (names.empty() ? "" : " ") + text->substr(at + 3, text->find(':', at) - at - 3);
        }
        return names;
    }
};

TEST_F(Frame, APointLightRunsSurfaceLightAndDisplayOnly) {
    scene.lights.push_back(scene::PointLight{});
    EXPECT_EQ(passes(), "views.surface relief.light frame.display");
}

TEST_F(Frame, AGeometricViewRunsNoLight) {
    scene.view.show = scene::Aov::Normal;
    EXPECT_EQ(passes(), "views.surface views.geometry frame.display");
}

TEST_F(Frame, ExplainNamesReasonsBytesAndWhatWasLeftOut) {
    scene.lights.push_back(scene::PointLight{});
    Renderer renderer(*context);
    const std::string text = *renderer.explain(scene, {40, 30});
    for (const char* part :
         {"relief: object \"field\" is a height field",
          "lights 0 to 0 of 1 through the solid, method hierarchy",
          "-> frame.surface 40x30 RGBA32F, 19200 bytes",
          "views.depth: one visible object cannot hide another", "environment: the scene names none",
          "heights, pyramids, meshes and maps of the objects"})
        EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
}

TEST_F(Frame, APointLightIsOneDrawOverItsSurface) {
    scene.lights.push_back(scene::PointLight{});
    Renderer renderer(*context);
    complete(renderer, 1);
    EXPECT_EQ(renderer.stats().draws, 2); // the surface and the light; present() adds one
    EXPECT_EQ(renderer.stats().passes, 2);
    EXPECT_EQ(renderer.stats().lights, 1);
}

TEST_F(Frame, ACompletePictureIsNotDrawnAgain) {
    scene.lights.push_back(scene::PointLight{});
    Renderer renderer(*context);
    ASSERT_TRUE(renderer.finish(scene, 1, {40, 30}).ok());
    const int draws = context->device().drawCount();
    ASSERT_TRUE(renderer.advance(scene, 1, {40, 30})->complete);
    EXPECT_EQ(context->device().drawCount(), draws);
    complete(renderer, 2); // a changed scene is
    EXPECT_GT(context->device().drawCount(), draws);
}

TEST_F(Frame, ItsTasksFollowEachOtherAndTheirSharesGrow) {
    addEnvironment(300);
    scene.quality.maxError = 0.03f;
    technique::addSettings(scene);
    views::samplingOf(scene).pixelSamples = 3;
    scene.objects.push_back({});
    scene.objects.back().name = "ball";
    scene.objects.back().shape = scene::Sphere{};
    scene.objects.back().material.kind = scene::Mirror{};
    Renderer renderer(*context);
    std::vector<Task> tasks;
    std::vector<float> shares;
    for (const Progress& progress : complete(renderer, 1)) {
        if (tasks.empty() || tasks.back() != progress.task) {
            tasks.push_back(progress.task);
            shares = {0};
        }
        EXPECT_GE(progress.share, shares.back()) << nameOf(progress.task);
        EXPECT_LE(progress.share, 1) << nameOf(progress.task);
        shares.push_back(progress.share);
        EXPECT_EQ(progress.task == Task::Samples, progress.samples > 0);
    }
    std::erase(tasks, Task::Picture); // which is small enough for a slice
    EXPECT_EQ(tasks, (std::vector{Task::Settings, Task::Surroundings, Task::Samples}));
    EXPECT_GT(shares.back(), 0.4f);
}

TEST_F(Frame, AfterAWholePreviewTheSharesOfItsSamplesBegin) {
    scene.lights.push_back(scene::PointLight{});
    technique::addSettings(scene);
    views::samplingOf(scene).pixelSamples = 256;
    Renderer renderer(*context);
    complete(renderer, 1, true);
    std::vector<float> shares;
    for (const Progress& progress : complete(renderer, 1)) {
        EXPECT_EQ(progress.task, Task::Samples);
        shares.push_back(progress.share);
    }
    ASSERT_GT(shares.size(), 1u);
    EXPECT_LT(shares.front(), 0.5f);
    EXPECT_TRUE(std::is_sorted(shares.begin(), shares.end()));
}

TEST_F(Frame, AnEnvironmentIsSummedInStagesToTheSameMean) {
    addEnvironment(300);
    Renderer renderer(*context);
    const std::vector<Progress> said = complete(renderer, 1);
    EXPECT_TRUE(std::is_sorted(said.begin(), said.end(), [](const Progress& one, const Progress& other) {
        return one.share < other.share;
    }));
    EXPECT_EQ(renderer.advance(scene, 1, {40, 30})->share, 1);
    EXPECT_GE(said.size(), 2u); // 20, 80 and 300 directions
    const int all = renderer.stats().lights;
    EXPECT_NEAR(all, 300, 30);
    // However the sum was sliced, the picture is that of all directions at once.
    const Image sliced = *renderer.read(scene, scene::Aov::Color);
    double mean = 0;
    for (std::size_t i = 0; i < sliced.pixels.size(); i += 4)
        mean += sliced.pixels[i];
    mean /= double(sliced.pixels.size() / 4);
    EXPECT_GT(mean, 0.4);
    EXPECT_LT(mean, 2); // the diffuse albedo is 1; twice the light of a level field
}

TEST_F(Frame, ACoarseLookIsTheFirstStageAlone) {
    addEnvironment(300);
    Renderer renderer(*context);
    const auto lightsOfLook = [&](std::uint64_t revision) {
        for (;;) {
            const auto progress = renderer.advance(scene, revision, {40, 30}, true);
            EXPECT_TRUE(progress.ok());
            if (!progress || progress->complete) return renderer.stats().lights;
        }
    };
    EXPECT_NEAR(lightsOfLook(1), context->caps().software ? 6 : 20, 6) << "the very first";
    EXPECT_NEAR(lightsOfLook(2), 20, 6);
    EXPECT_FALSE(renderer.advance(scene, 2, {40, 30}, false)->complete); // letting go refines
}

TEST_F(Frame, ACoarseLookAtALargeLampIsRefined) {
    scene.lights.push_back(scene::PointLight{.radius = 0.3f});
    Renderer coarse(*context), whole(*context);
    while (!coarse.advance(scene, 1, {40, 30}, true)->complete)
        ;
    while (!coarse.advance(scene, 1, {40, 30}, false)->complete)
        ;
    ASSERT_TRUE(whole.finish(scene, 1, {40, 30}).ok());
    EXPECT_EQ(coarse.read(scene, scene::Aov::Color)->pixels, whole.read(scene, scene::Aov::Color)->pixels);
}

TEST_F(Frame, NormaliseDividesByTheNumberOfLights) {
    addEnvironment(20);
    scene.lights.push_back(scene::PointLight{});
    scene.objects[0].material.base = vec3(0);
    const auto mean = [&](bool normalise) {
        static_cast<relief::Settings*>(scene.technique.at("relief").data())->normalise = normalise;
        Renderer renderer(*context);
        EXPECT_TRUE(renderer.finish(scene, 1, {40, 30}).ok());
        return renderer.read(scene, scene::Aov::Color)->at(20, 15)[0];
    };
    // One point light and one environment: everything is halved.
    EXPECT_NEAR(mean(true) / mean(false), 0.5, 1e-6);
}

TEST_F(Frame, DisplayIsExposedEncodedAndClamped) {
    scene.objects[0].material.base = vec3(0.5f, 2.0f, 0.0f);
    Renderer renderer(*context);
    ASSERT_TRUE(renderer.finish(scene, 1, {40, 30}).ok());
    const auto pixel = [&] {
        const Image image = *renderer.readDisplay(scene);
        return vec3(image.at(20, 15)[0], image.at(20, 15)[1], image.at(20, 15)[2]);
    };
    // sRGB of 0.5 is 0.7354; one step up makes it 1, one down 0.25 -> 0.5371.
    EXPECT_NEAR(pixel().r, 0.7354, 0.5 / 255);
    EXPECT_EQ(pixel().g, 1);
    EXPECT_EQ(pixel().b, 0);
    scene.view.exposure = -1;
    EXPECT_NEAR(pixel().r, 0.5371, 0.5 / 255);
}

TEST_F(Frame, ReleaseGivesTheMemoryBackAndThePictureComesAgain) {
    scene.lights.push_back(scene::PointLight{});
    const std::size_t before = context->device().textureBytes();
    Renderer renderer(*context);
    ASSERT_TRUE(renderer.finish(scene, 1, {40, 30}).ok());
    const Image first = *renderer.read(scene, scene::Aov::Color);
    EXPECT_GT(context->device().textureBytes(), before);
    renderer.release();
    EXPECT_EQ(context->device().textureBytes(), before);
    ASSERT_TRUE(renderer.finish(scene, 1, {40, 30}).ok());
    EXPECT_EQ(renderer.read(scene, scene::Aov::Color)->pixels, first.pixels);
}

TEST_F(Frame, AMapLargerThanTheGpuAllowsIsRefusedByItsSize) {
    const int limit = context->caps().maxTextureSize;
    scene.objects[0].field().heights = support::heights({limit + 1, 1}, [](int, int) { return 0.0f; });
    Renderer renderer(*context);
    const Status status = renderer.finish(scene, 1, {8, 8});
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().message, "image of " + std::to_string(limit + 1) +
                                          "x1 pixels: too large for this GPU; must be at most " +
                                          std::to_string(limit) + " on a side");
    EXPECT_EQ(status.error().fault, Fault::Machine);
}

} // namespace
} // namespace lucent::frame
