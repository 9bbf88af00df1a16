// What commands read of the files that a scene names.
#include "tests/cli/Program.h"

#include <sys/stat.h>

namespace lucent::test {
namespace {

class Reach : public ProgramTest {
protected:
    void SetUp() override {
        ProgramTest::SetUp();
        for (const char* folder : {"scenes", "scenes/maps", "scenes-too"})
            std::filesystem::create_directory(path(folder));
        writeBump("outside.pfm");
        writeBump("scenes/inside.pfm");
        writeBump("scenes-too/near.pfm");
        write("secret.txt", std::string("password hunter2\n"));
        std::filesystem::create_symlink("../outside.pfm", path("scenes/link.pfm"));
        std::filesystem::create_symlink("..", path("scenes/up"));
    }
    /// "scenes/scene.json" over these heights.
    void writeSceneOver(const std::string& heights) const {
        writeScene("\"" + heights + "\"");
        std::filesystem::rename(path("scene.json"), path("scenes/scene.json"));
    }
    /// "scenes/model.obj", a triangle with materials from there.
    void writeModel(const std::string& materials) const {
        write("scenes/model.obj", "mtllib " + materials + "\nv 0 0 0\nv 1 0 0\nv 0 1 1\nf 1 2 3\n");
    }
};

const std::string kTruth = "truth scenes/scene.json -o out.pfm --size 4x4";

TEST_F(Reach, EndsAtTheFolderOfTheScene) {
    for (const std::string& heights :
         {std::string("../outside.pfm"), std::string("maps/../../outside.pfm"), std::string("link.pfm"),
          std::string("up/outside.pfm"), std::string("../scenes-too/near.pfm"), path("outside.pfm"),
          std::string("/dev/zero"), std::string("../none.pfm")}) {
        writeSceneOver(heights);
        const std::string named = heights.starts_with("/") ? heights : "scenes/" + heights;
        expectRefusal(kTruth,
                      "scenes/scene.json:4: objects.field.shape.heights: " + named +
                          ": lies outside scenes; must lie beneath it, or beneath a folder that --allow "
                          "names");
    }
    for (const char* heights : {"inside.pfm", "maps/../inside.pfm", "up/scenes/inside.pfm"}) {
        writeSceneOver(heights);
        EXPECT_EQ(run(kTruth).code, 0) << heights;
    }
}

TEST_F(Reach, GoesAsFarAsIsAllowed) {
    writeSceneOver("../outside.pfm");
    EXPECT_EQ(run(kTruth + " --allow scenes-too --allow .").code, 0);
    EXPECT_EQ(run(kTruth + " --allow scenes-too").code, 1);
    expectRefusal(kTruth + " --allow none",
                  "--allow: Directory does not exist: none; see lucent truth --help");
}

TEST_F(Reach, OfAModelIsNoLonger) {
    const std::string convert = "convert scenes/model.obj -o out.mesh";
    for (const std::string& materials : {std::string("../secret.txt"), path("secret.txt"),
                                         std::string("/dev/zero"), std::string("/etc/passwd")}) {
        writeModel(materials);
        const Outcome outcome = run(convert);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_NE(outcome.err.find("lies outside scenes"), std::string::npos) << outcome.err;
        for (const char* quoted : {"hunter2", "password", "root"})
            EXPECT_EQ(outcome.err.find(quoted), std::string::npos) << outcome.err;
    }
    for (const char* uri : {"../secret.txt", "%2e%2e/secret.txt", "..%2fsecret.txt"}) {
        write("scenes/model.gltf",
              R"({ "asset": { "version": "2.0" }, "buffers": [ { "byteLength": 8, "uri": ")" +
                  std::string(uri) + R"(" } ] })");
        const Outcome outcome = run("convert scenes/model.gltf -o out.mesh");
        EXPECT_EQ(outcome.code, 1);
        EXPECT_NE(outcome.err.find("lies outside scenes"), std::string::npos) << outcome.err;
    }
}

TEST_F(Reach, IsForRegularFilesOnly) {
    mkfifo(path("scenes/pipe").c_str(), 0600);
    writeSceneOver("pipe");
    expectRefusal(kTruth,
                  "scenes/scene.json:4: objects.field.shape.heights: scenes/pipe: is a device or a pipe; "
                  "must be a regular file");
    expectRefusal("truth /dev/zero -o out.pfm", "/dev/zero: is a device or a pipe; must be a regular file");
}

TEST_F(Reach, MessagesQuoteNothingOfWhatIsNoStrokeScript) {
    write("scenes/notes.txt", std::string("hunter2\n"));
    write("scenes/painted.json", std::string(R"({ "lucent": 1, "objects": [ { "name": "ball",
  "shape": { "type": "sphere" }, "material": { "preset": "marble" }, "paint": { "strokes": "notes.txt" } } ] })"));
    expectRefusal(
        "truth scenes/painted.json -o out.pfm",
        "scenes/painted.json:2: objects.ball.paint.strokes: scenes/notes.txt:1:1: is no JSON; must be");
}

// A folder may hold more than the scene's author should see.
TEST_F(Reach, MessagesQuoteNothingOfWhatIsNoMaterialFile) {
    write("scenes/notes.txt", std::string("newmtl a\nhunter2 one\nKd hunter2 0 0\n"));
    writeModel("notes.txt");
    const Outcome outcome = run("convert scenes/model.obj -o out.mesh");
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(outcome.err, "lucent: scenes/notes.txt:3: Kd has what is none; must be a number\n");
    write("scenes/notes.txt", std::string("hunter2 one\n"));
    EXPECT_EQ(run("convert scenes/model.obj -o out.mesh").err,
              "lucent: scenes/notes.txt:1: a line comes before a material; must follow newmtl\n");
    write("scenes/notes.txt", std::string("newmtl a\nKs 1 1 1\nhunter2 one\n"));
    const std::string warned = run("convert scenes/model.obj -o out.mesh").err;
    EXPECT_NE(warned.find("not read: Ks, lines of unknown kinds"), std::string::npos) << warned;
    EXPECT_EQ(warned.find("hunter2"), std::string::npos) << warned;
}

} // namespace
} // namespace lucent::test
