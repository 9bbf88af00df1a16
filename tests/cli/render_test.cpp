#include "tests/cli/Program.h"

#include "scene/readers/Readers.h"

#include <cmath>

namespace lucent::test {
namespace {

class Render : public ProgramTest {
protected:
    void SetUp() override {
        ProgramTest::SetUp();
        writeBump("bump.pfm");
        writeScene("\"bump.pfm\"");
        const Outcome outcome = run("explain scene.json");
        if (outcome.code != 2) return;
        if (std::getenv("LUCENT_REQUIRE_GL")) FAIL() << outcome.err;
        GTEST_SKIP() << outcome.err;
    }
    static inline const std::string kMiddles = " --set technique.sampling.pixelSamples=1";

    /// "moving.json": a ball through which a wave runs sideways.
    void writeMovingScene() const {
        write("moving.json", R"({ "lucent": 1, "size": [16, 16],
  "camera": { "type": "orthographic", "eye": [0, 0, 5], "height": 4 },
  "objects": [ { "name": "ball", "shape": { "type": "sphere" }, "material": { "base": [1, 1, 1] },
                 "wave": { "amplitude": [1, 0, 0], "direction": [0, 0, 1], "wavelength": 100 } } ] })");
    }
    Image load(const std::string& name) const {
        const auto bytes = scene::plainFiles(path(name))(path(name));
        EXPECT_TRUE(bytes.ok());
        const auto image = decodeImage(*bytes, name, Encoding::Linear);
        EXPECT_TRUE(image.ok());
        return *image;
    }
};

TEST_F(Render, WritesEveryKindOfPictureInTheWantedSize) {
    for (const char* name : {"out.png", "out.hdr", "out.exr", "out.pfm"}) {
        const Outcome outcome = run(std::string("render scene.json --size 24x12 -o ") + name);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        EXPECT_EQ(load(name).size(), ivec2(24, 12)) << name;
    }
    EXPECT_EQ(run("render scene.json -o own.pfm").code, 0);
    EXPECT_EQ(load("own.pfm").size(), ivec2(16, 16));
}

TEST_F(Render, AgreesWithTheTruth) {
    for (const std::string aov : {"color", "d"}) {
        EXPECT_EQ(run("render scene.json -o gpu.pfm --aov " + aov + kMiddles).code, 0);
        EXPECT_EQ(run("truth scene.json -o truth.pfm --aov " + aov + kMiddles).code, 0);
        const Image gpu = load("gpu.pfm"), exact = load("truth.pfm");
        ASSERT_EQ(gpu.pixels.size(), exact.pixels.size());
        for (std::size_t i = 0; i < gpu.pixels.size(); ++i)
            EXPECT_NEAR(gpu.pixels[i], exact.pixels[i], 2e-5);
    }
}

// What a pixel of 2 x 2 texels shows varies: its mean is not what its middle shows.
TEST_F(Render, MeansOverPixelsComeNearerToThoseOfTheTruthThanMiddles) {
    ASSERT_EQ(run("truth scene.json -o truth.pfm --size 4x4").code, 0);
    const Image exact = load("truth.pfm");
    const auto squares = [&](const std::string& options) {
        EXPECT_EQ(run("render scene.json -o gpu.pfm --size 4x4" + options).code, 0);
        const Image gpu = load("gpu.pfm");
        double sum = 0;
        for (std::size_t i = 0; i < gpu.pixels.size(); ++i)
            sum += std::pow(double(gpu.pixels[i]) - double(exact.pixels[i]), 2);
        return sum;
    };
    EXPECT_LT(squares(""), 0.5 * squares(kMiddles));
}

TEST_F(Render, PngIsTheDisplayedPictureOnTheGpuAndInTheTruthAlike) {
    ASSERT_EQ(run("render scene.json -o gpu.png --set view.exposure=0.5" + kMiddles).code, 0);
    ASSERT_EQ(run("truth scene.json -o truth.png --set view.exposure=0.5" + kMiddles).code, 0);
    const Image gpu = load("gpu.png"), exact = load("truth.png");
    ASSERT_EQ(gpu.pixels.size(), exact.pixels.size());
    for (std::size_t i = 0; i < gpu.pixels.size(); ++i)
        EXPECT_NEAR(gpu.pixels[i], exact.pixels[i], 1.01 / 255);
}

TEST_F(Render, ChangedParametersChangeThePicture) {
    ASSERT_EQ(run("render scene.json -o a.pfm").code, 0);
    ASSERT_EQ(run("render scene.json -o b.pfm --set objects.field.material.diffuse='0 0 0' "
                  "--set objects.field.material.base='0.25 0 0'")
                  .code,
              0);
    EXPECT_GT(load("a.pfm").at(4, 4)[1], 0.1f);
    EXPECT_EQ(load("b.pfm").at(4, 4)[1], 0);
    EXPECT_FLOAT_EQ(load("b.pfm").at(4, 4)[0], 0.25f);
}

TEST_F(Render, WritesWhatItCostAsJson) {
    ASSERT_EQ(run("render scene.json -o a.pfm --stats stats.json").code, 0);
    for (const char* key :
         {"\"milliseconds\"", "\"passes\"", "\"lights\": 1", "\"textureBytes\"", "\"width\": 16"})
        EXPECT_NE(text("stats.json").find(key), std::string::npos) << text("stats.json");
}

TEST_F(Render, StatsNameWhatTheErrorBudgetChose) {
    writeScene("\"bump.pfm\"", R"("depth": 0.1)", R"("environment": { "source": "sky" })");
    ASSERT_EQ(run("render scene.json -o a.pfm --stats stats.json --max-error 0.1").code, 0);
    const nlohmann::json stats = parsed(text("stats.json"));
    EXPECT_NE(stats["settings"], "");
    EXPECT_GT(stats["predictedError"], 0);
    EXPECT_LE(stats["predictedError"], 0.1);
    EXPECT_GT(stats["planMilliseconds"], 0);
    EXPECT_LT(stats["planMilliseconds"], stats["milliseconds"]);
}

TEST_F(Render, ASequenceHasNumberedPicturesAndTheirTimes) {
    writeMovingScene();
    const Outcome outcome =
        run("render moving.json -o out.pfm --time 1 --frames 3 --fps 4 --stats stats.json");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const nlohmann::json stats = parsed(text("stats.json"));
    ASSERT_EQ(stats["pictures"].size(), 3u);
    for (int i = 0; i < 3; ++i) {
        const std::string file = "out-000" + std::to_string(i + 1) + ".pfm";
        EXPECT_EQ(load(file).size(), ivec2(16, 16));
        EXPECT_EQ(stats["pictures"][i]["file"], file);
        EXPECT_EQ(stats["pictures"][i]["time"], 1 + 0.25 * i);
    }
    EXPECT_FALSE(exists("out.pfm"));
    // The wave moves the ball sideways by half its width: no picture is like the next, and each is what one
    // picture of its moment is.
    EXPECT_NE(load("out-0001.pfm").pixels, load("out-0002.pfm").pixels);
    ASSERT_EQ(run("render moving.json -o one.pfm --time 1.25").code, 0);
    EXPECT_EQ(load("one.pfm").pixels, load("out-0002.pfm").pixels);
}

TEST_F(Render, AStoppedSequenceLeavesWholePicturesOnly) {
    writeMovingScene();
    const Outcome outcome =
        runStopped("render moving.json -o out.pfm --frames 9999", [&] { return exists("out-0002.pfm"); });
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.err.find(" of 9999 pictures"), std::string::npos) << outcome.err;
    const std::size_t pictures = fileCount() - 3; // bump and two scenes
    for (std::size_t i = 1; i <= pictures; ++i) {
        char name[32];
        std::snprintf(name, sizeof name, "out-%04zu.pfm", i);
        EXPECT_EQ(load(name).size(), ivec2(16, 16)) << name;
    }
}

TEST_F(Render, WhatIsNotDrawnIsToldOnStderrAsExplainSaysIt) {
    write("mirror.json", R"({ "lucent": 1, "size": [8, 8],
  "camera": { "type": "orthographic", "eye": [0, 0, 5], "height": 4 },
  "objects": [ { "name": "mirror", "shape": { "type": "sphere" }, "material": { "reflectance": [1, 1, 1] } },
               { "name": "ball", "shape": { "type": "sphere" }, "transform": { "translate": [2, 0, 0] } } ] })");
    std::string lines, explained = run("explain mirror.json").out;
    explained.erase(0, explained.find("not drawn\n") + 10);
    for (std::size_t end; (end = explained.find('\n')) != std::string::npos; explained.erase(0, end + 1))
        lines += "lucent: not drawn: " + explained.substr(2, end - 1);
    EXPECT_NE(lines.find("mirror"), std::string::npos) << lines;
    for (const char* command : {"render", "truth"}) {
        const Outcome outcome = run(command + std::string(" mirror.json -o out.pfm"));
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_EQ(outcome.err, lines) << command;
    }
}

TEST_F(Render, ExplainNamesThePassesAndWhatWasLeftOut) {
    const Outcome outcome = run("explain scene.json");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.out.find("relief.light"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("left out"), std::string::npos) << outcome.out;
}

} // namespace
} // namespace lucent::test
