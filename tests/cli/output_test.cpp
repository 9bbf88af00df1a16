// What commands leave of the files that were there before.
#include "tests/cli/Program.h"

#include <sys/stat.h>

namespace lucent::test {
namespace {

class Outputs : public ProgramTest {
protected:
    void SetUp() override {
        ProgramTest::SetUp();
        writeBump("bump.pfm");
        writeScene("\"bump.pfm\"");
        for (const char* old : {"old.pfm", "old.pfm.json", "old.png", "old.json"})
            write(old, std::string("old"));
        std::filesystem::create_directory(path("folder.pfm"));
        std::filesystem::create_directory(path("folder.png"));
    }
    void expectAllOld() const {
        for (const char* old : {"old.pfm", "old.pfm.json", "old.png", "old.json"})
            EXPECT_EQ(text(old), "old") << old;
    }
};

const std::string kMust = "; must be a regular file, or a new one";

TEST_F(Outputs, AFailedCommandLeavesEveryFileAsItWas) {
    const std::string part = "scene.json -o old.pfm ";
    expectRefusal("truth " + part + "--errors folder.pfm", "folder.pfm: is a folder" + kMust);
    expectRefusal("render " + part + "--stats folder.png", "folder.png: is a folder" + kMust);
    expectRefusal("render " + part + "--stats no/stats.json",
                  "no/stats.json: cannot be written, no is no folder; must be in an existing one");
    expectRefusal("compare bump.pfm bump.pfm --heatmap old.png --flip folder.png",
                  "folder.png: is a folder" + kMust);
    expectAllOld();
}

TEST_F(Outputs, ADeviceStaysADevice) {
    expectRefusal("render scene.json -o old.pfm --stats /dev/null", "/dev/null: is a device" + kMust);
    expectRefusal("truth scene.json -o /dev/null --tile 1/2", "/dev/null: is a device" + kMust);
    expectRefusal("report old.json -o /dev/null", "/dev/null: is a device" + kMust);
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
    expectAllOld();
}

TEST_F(Outputs, TwoOfOnePathAreRefused) {
    const auto twice = [](const std::string& path, const std::string& other) {
        return path + ": is written twice, as " + other + " too; must be two files";
    };
    expectRefusal("truth scene.json -o old.pfm --errors ./old.pfm", twice("./old.pfm", "old.pfm"));
    expectRefusal("render scene.json -o old.png --stats old.png", twice("old.png", "old.png"));
    expectRefusal("compare bump.pfm bump.pfm --heatmap old.png --flip ./old.png",
                  twice("./old.png", "old.png"));
    expectAllOld();
}

TEST_F(Outputs, WhatIsReplacedKeepsItsPermissionsAndItsLinks) {
    std::filesystem::permissions(path("old.pfm"), std::filesystem::perms(0600));
    std::filesystem::create_symlink("old.pfm", path("link.pfm"));
    ASSERT_EQ(run("truth scene.json -o link.pfm").code, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(path("link.pfm")));
    EXPECT_NE(text("old.pfm"), "old");
    EXPECT_EQ(std::filesystem::status(path("old.pfm")).permissions(), std::filesystem::perms(0600));
}

TEST_F(Outputs, AFullDiskLeavesEveryFileAsItWas) {
    const std::string command = "cd '" + path("") +
                                "' && ulimit -f 1 && '" LUCENT_PROGRAM
                                "' truth scene.json --size 64x64 -o old.pfm 2>err";
    const int status = std::system(("bash -c \"" + command + "\"").c_str());
    EXPECT_EQ(WEXITSTATUS(status), 1);
    EXPECT_EQ(text("err"), "lucent: old.pfm: cannot be written (File too large)\n");
    expectAllOld();
    std::filesystem::remove(path("err"));
    EXPECT_EQ(fileCount(), 8u); // two inputs, four files, two folders
}

} // namespace
} // namespace lucent::test
