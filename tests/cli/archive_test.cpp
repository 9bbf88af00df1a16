// Scenes in zip archives, wherever a command takes a scene.
#include "tests/cli/Program.h"
#include "tests/support/Zip.h"

namespace lucent::test {
namespace {

class SceneArchive : public ProgramTest {
protected:
    void SetUp() override {
        ProgramTest::SetUp();
        writeBump("bump.pfm");
        writeScene("\"bump.pfm\"");
        scene_ = text("scene.json");
    }
    /// "scene.lucent.zip" with the scene over these heights, and the bump as "bump.pfm".
    void pack(const std::string& heights = "bump.pfm") const {
        std::string scene = scene_;
        scene.replace(scene.find("bump.pfm"), 8, heights);
        write("scene.lucent.zip",
              zipOf({{.name = "scene.json", .content = scene, .deflated = true},
                     {.name = "bump.pfm", .content = text("bump.pfm"), .deflated = true}}));
    }

    std::string scene_;
};

TEST_F(SceneArchive, IsSolvedToTheBitLikeItsFiles) {
    pack();
    ASSERT_EQ(run("truth scene.json -o files.pfm --set objects.field.material.depth=0.2").code, 0);
    const Outcome outcome =
        run("truth scene.lucent.zip -o archive.pfm --set objects.field.material.depth=0.2");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(text("archive.pfm"), text("files.pfm"));
}

TEST_F(SceneArchive, NamesThePlaceOfAMistakeInIt) {
    pack("none.pfm");
    expectRefusal(
        "truth scene.lucent.zip -o out.pfm",
        "scene.lucent.zip/scene.json:4: objects.field.shape.heights: scene.lucent.zip/none.pfm: is not "
        "in the archive; must be");
    for (const std::string& heights :
         {std::string("../bump.pfm"), path("bump.pfm"), std::string("a/../../bump.pfm")}) {
        pack(heights);
        const std::string named = heights.starts_with("/") ? heights : "scene.lucent.zip/" + heights;
        expectRefusal("truth scene.lucent.zip -o out.pfm --allow .",
                      "scene.lucent.zip/scene.json:4: objects.field.shape.heights: " + named +
                          ": lies outside scene.lucent.zip; must lie in it");
    }
    pack("maps/../bump.pfm");
    EXPECT_EQ(run("truth scene.lucent.zip -o out.pfm").code, 0);
}

TEST_F(SceneArchive, IsNotWrittenOver) {
    pack();
    write("archive.pfm.zip", text("scene.lucent.zip"));
    std::filesystem::create_symlink("archive.pfm.zip", path("out.pfm"));
    expectRefusal("truth archive.pfm.zip -o out.pfm",
                  "out.pfm: is read as well; must be another file than archive.pfm.zip");
}

TEST_F(SceneArchive, IsRefusedWhereItIsNone) {
    write("scene.lucent.zip", std::string("hello"));
    expectRefusal("truth scene.lucent.zip -o out.pfm",
                  "scene.lucent.zip: cannot be read (Not a zip archive); must be a zip archive");
    expectRefusal("truth none.zip -o out.pfm", "none.zip: cannot be read (No such file or directory)");
    write("scene.lucent.zip", zipOf({{.name = "scene.json", .content = "", .size = 0xf0000000}}));
    expectRefusal("truth scene.lucent.zip -o out.pfm",
                  "scene.lucent.zip: unpacks to more than 1 GiB with \"scene.json\"; must be at most that");
}

TEST_F(SceneArchive, TakesNoPaintedMapsBesideIt) {
    pack();
    write("strokes.json", std::string("{}"));
    expectRefusal(
        "paint scene.lucent.zip --strokes strokes.json -o painted.json",
        "scene.lucent.zip: is an archive, beside which no painted map is found; must be a scene file");
}

} // namespace
} // namespace lucent::test
