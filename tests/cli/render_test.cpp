#include "tests/cli/Program.h"

#include "scene/readers/Readers.h"

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
    Image load(const std::string& name) const {
        const auto bytes = scene::plainFiles()(path(name));
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
    for (const char* aov : {"color", "d"}) {
        EXPECT_EQ(run(std::string("render scene.json -o gpu.pfm --aov ") + aov).code, 0);
        EXPECT_EQ(run(std::string("truth scene.json -o truth.pfm --aov ") + aov).code, 0);
        const Image gpu = load("gpu.pfm"), exact = load("truth.pfm");
        ASSERT_EQ(gpu.pixels.size(), exact.pixels.size());
        for (std::size_t i = 0; i < gpu.pixels.size(); ++i)
            EXPECT_NEAR(gpu.pixels[i], exact.pixels[i], 2e-5);
    }
}

TEST_F(Render, PngIsTheDisplayedPictureOnTheGpuAndInTheTruthAlike) {
    ASSERT_EQ(run("render scene.json -o gpu.png --set view.exposure=0.5").code, 0);
    ASSERT_EQ(run("truth scene.json -o truth.png --set view.exposure=0.5").code, 0);
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

TEST_F(Render, ExplainNamesThePassesAndWhatWasLeftOut) {
    const Outcome outcome = run("explain scene.json");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.out.find("relief.light"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("left out"), std::string::npos) << outcome.out;
}

} // namespace
} // namespace lucent::test
