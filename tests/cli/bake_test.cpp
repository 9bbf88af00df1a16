// lucent bake, and scenes that name what it wrote.
#include "tests/cli/Program.h"

namespace lucent::test {
namespace {

class BakeCommand : public ProgramTest {
protected:
    // A wall of marble in the x, y plane.
    void writeScene(const std::string& name, bool precomputed, const std::string& rest = "",
                    const std::string& size = "[0.008, 0.008, 0.004]") const {
        write(name, std::string(R"({ "lucent": 1, "size": [8, 8],
  "camera": { "eye": [0, 0, 1], "height": 0.006 },
  "lights": [ { "type": "distant", "direction": [0, 0, -1] } ],
  "technique": { "throughput": { "side": 256 } },
  "objects": [ { "name": "wall", "shape": { "type": "box", "size": )") +
                        size + R"( },
    "material": { "preset": "marble", "precomputed": )" +
                        (precomputed ? "true" : "false") + " }" + rest + " } ] }\n");
    }
};

TEST_F(BakeCommand, WritesAFileThatTheSceneNamesAndNothingElse) {
    writeScene("wall.json", true);
    const Outcome outcome = run("bake throughput wall.json -o wall.bake --threads 2");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, ""); // the bar is for terminals
    EXPECT_TRUE(outcome.out.starts_with("wall.bake: throughput of wall, ")) << outcome.out;
    EXPECT_EQ(fileCount(), 2u);
    EXPECT_TRUE(text("wall.bake").starts_with("LUCENTTP"));
    writeScene("baked.json", true, R"(, "bake": "wall.bake")");
    EXPECT_EQ(run("bake throughput baked.json -o again.bake").code, 0);
    EXPECT_EQ(text("again.bake"), text("wall.bake")); // threads change nothing
}

TEST_F(BakeCommand, RefusesWhatItDoesNotBake) {
    writeScene("wall.json", false);
    expectRefusal(
        "bake throughput wall.json -o wall.bake",
        "wall.json: has no object that throughput bakes; must have one whose material is precomputed");
    writeScene("wall.json", true);
    expectRefusal("bake relief wall.json -o wall.bake",
                  "bake: is \"relief\", no technique that bakes; the nearest is \"throughput\"");
    expectRefusal("bake throughput wall.json -o wall.bake --object wal",
                  "--object: is \"wal\", which throughput does not bake; the nearest is \"wall\"");
    writeScene("wall.json", true, R"(, "bake": "wall.bake")");
    const Outcome missing = run("bake throughput wall.json -o other.bake");
    EXPECT_EQ(missing.code, 1);
    EXPECT_NE(missing.err.find("wall.bake: cannot be read"), std::string::npos) << missing.err;
}

} // namespace
} // namespace lucent::test
