#include "tests/cli/Program.h"

#include <algorithm>
#include <sstream>

namespace lucent::test {
namespace {

/// A rough little field under a soft lamp and a sky: everything in it is sampled.
class Truth : public ProgramTest {
protected:
    void SetUp() override {
        ProgramTest::SetUp();
        writeBump("bump.pfm");
        writeScene("\"bump.pfm\"", R"("depth": 0.1)", R"("environment": { "source": "sky" })");
    }
    static inline const std::string kFew = " --directions 32 --samples 16 --set lights.0.radius=0.2";

    void expectDone(const std::string& arguments) const {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 0) << arguments << "\n" << outcome.err;
        std::istringstream lines(outcome.err);
        for (std::string line; std::getline(lines, line);)
            EXPECT_EQ(line.rfind("lucent: not drawn: ", 0), 0u) << arguments << "\n" << line;
    }
};

TEST_F(Truth, SaysItsStandardErrorAndWritesWhatItIsBesideThePicture) {
    const Outcome outcome = run("truth scene.json -o a.pfm --seed 7 --errors e.pfm" + kFew);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out.rfind("a.pfm: standard error 0.0", 0), 0u) << outcome.out;
    const std::string facts = text("a.pfm.json");
    for (const char* fact : {"\"scene\": \"scene.json\"", "\"width\": 16", "\"height\": 16",
                             "\"aov\": \"color\"", "\"estimator\": \"relief\"", "\"seed\": 7",
                             "\"samples\": 16", "\"directions\": 32", "\"standardError\": 0.0"})
        EXPECT_NE(facts.find(fact), std::string::npos) << fact << " in " << facts;
    EXPECT_TRUE(exists("e.pfm"));
    // A lamp without size alone leaves nothing to sample in the middles of pixels.
    const std::string single = "truth scene.json -o b.pfm --set environment.enabled=false";
    EXPECT_EQ(run(single + " --set technique.sampling.pixelSamples=1").out, "b.pfm: standard error 0\n");
    EXPECT_EQ(run(single).out.rfind("b.pfm: standard error 0.0", 0), 0u);
}

TEST_F(Truth, DependsOnTheSeedAndNotOnThreads) {
    for (const char* estimator : {" --estimator relief --directions 32", " --estimator lambert"}) {
        const std::string rest = estimator + std::string(" --samples 16 --set lights.0.radius=0.2");
        expectDone("truth scene.json -o a.pfm --seed 1 --threads 1" + rest);
        expectDone("truth scene.json -o b.pfm --seed 1 --threads 3" + rest);
        expectDone("truth scene.json -o c.pfm --seed 2 --threads 1" + rest);
        EXPECT_EQ(text("a.pfm"), text("b.pfm"));
        EXPECT_EQ(text("a.pfm.json"), text("b.pfm.json"));
        EXPECT_NE(text("a.pfm"), text("c.pfm"));
    }
}

TEST_F(Truth, MergedTilesAreTheUntiledPictureBitByBit) {
    expectDone("truth scene.json -o whole.pfm --errors whole-e.pfm" + kFew);
    for (const char* tile : {"1", "2", "3"})
        expectDone(std::string("truth scene.json -o ") + tile + ".tile --tile " + tile + "/3" + kFew);
    expectDone("merge 2.tile 3.tile 1.tile -o merged.pfm --errors merged-e.pfm");
    EXPECT_EQ(text("merged.pfm"), text("whole.pfm"));
    EXPECT_EQ(text("merged.pfm.json"), text("whole.pfm.json"));
    EXPECT_EQ(text("merged-e.pfm"), text("whole-e.pfm"));
}

TEST_F(Truth, MergeRefusesWhatDoesNotBelongTogether) {
    for (const char* tile : {"1/2", "2/2"})
        expectDone(std::string("truth scene.json -o ") + tile[0] + ".tile --tile " + tile + kFew);
    expectDone("truth scene.json -o other.tile --tile 2/2 --seed 3" + kFew);
    expectRefusal("merge 1.tile other.tile -o out.pfm", "other.tile: the seed is 3; must be 0 as in 1.tile");
    expectRefusal("merge 2.tile -o out.pfm",
                  "2.tile: is part 2 of 2 and these are missing: 1; must be given all 2");
    expectRefusal("merge 1.tile 1.tile -o out.pfm",
                  "1.tile: is part 1 of 2, as 1.tile is; must be given once");
    expectRefusal("merge 1.tile bump.pfm -o out.pfm",
                  "bump.pfm: is no part of a truth; must be a file that lucent truth --tile wrote");
    expectRefusal("merge 1.tile none.tile -o out.pfm",
                  "none.tile: cannot be read (No such file or directory)");
    const std::string whole = text("2.tile");
    write("cut.tile", whole.substr(0, whole.size() - 5));
    expectRefusal("merge 1.tile cut.tile -o out.pfm", "cut.tile: has " + std::to_string(whole.size() - 5) +
                                                          " bytes; must have " +
                                                          std::to_string(whole.size()));
    // The heights changed between the two parts.
    Image heights(8, 8, 1);
    *heights.at(1, 1) = 0.5f;
    write("bump.pfm", heights);
    expectDone("truth scene.json -o 2.tile --tile 2/2" + kFew);
    const Outcome outcome = run("merge 1.tile 2.tile -o out.pfm");
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.err.find("2.tile: the scene's fingerprint is "), std::string::npos) << outcome.err;
}

TEST_F(Truth, MergeRefusesTilesOfOtherPicturesAndOfOtherCuts) {
    expectDone("truth scene.json -o half.tile --tile 1/2" + kFew);
    expectDone("truth scene.json -o third.tile --tile 2/3" + kFew); // has rows that half.tile has
    expectRefusal("merge half.tile third.tile -o out.pfm",
                  "third.tile: the number of parts is 3; must be 2 as in half.tile");
    expectRefusal("merge third.tile -o out.pfm",
                  "third.tile: is part 2 of 3 and these are missing: 1, 3; must be given all 3");
    expectDone("truth scene.json -o other.tile --tile 2/2 --size 16x8" + kFew);
    expectRefusal("merge half.tile other.tile -o out.pfm",
                  "other.tile: the size is 16x8; must be 16x16 as in half.tile");
    expectDone("truth scene.json -o other.tile --tile 2/2 --aov d" + kFew);
    expectRefusal("merge half.tile other.tile -o out.pfm",
                  "other.tile: the AOV is d; must be color as in half.tile");
    expectDone("truth scene.json -o other.tile --tile 2/2 --estimator lambert --samples 16 --set "
               "lights.0.radius=0.2");
    expectRefusal("merge half.tile other.tile -o out.pfm",
                  "other.tile: the estimator is lambert; must be relief as in half.tile");
}

TEST_F(Truth, ARefusedMergeLeavesAnOlderPictureAsItWas) {
    expectDone("truth scene.json -o 1.tile --tile 1/2" + kFew);
    write("out.pfm", std::string("kept"));
    write("out.pfm.json", std::string("kept as well"));
    expectRefusal("merge 1.tile -o out.pfm",
                  "1.tile: is part 1 of 2 and these are missing: 2; must be given all 2");
    expectRefusal("merge 1.tile -o out.gif",
                  "out.gif: ends in no known image type; must be .png, .hdr, .exr or .pfm");
    expectRefusal("merge 1.tile -o no/out.pfm",
                  "no/out.pfm: cannot be written, no is no folder; must be in an existing one");
    EXPECT_EQ(text("out.pfm"), "kept");
    EXPECT_EQ(text("out.pfm.json"), "kept as well");
}

TEST_F(Truth, WhatIsReadIsNotWrittenOver) {
    expectRefusal("truth scene.json -o bump.pfm",
                  "bump.pfm: is read as well; must be another file than bump.pfm");
    expectRefusal("truth scene.json -o scene.json --tile 1/2",
                  "scene.json: is read as well; must be another file than scene.json");
    expectRefusal("truth scene.json -o a.pfm --errors ./bump.pfm",
                  "./bump.pfm: is read as well; must be another file than bump.pfm");
    write("a.pfm.json", text("scene.json"));
    expectRefusal("truth a.pfm.json -o a.pfm",
                  "a.pfm.json: is read as well; must be another file than a.pfm.json");
    expectDone("truth scene.json -o a.pfm --tile 1/1" + kFew);
    const std::string part = text("a.pfm");
    expectRefusal("merge a.pfm -o a.pfm", "a.pfm: is read as well; must be another file than a.pfm");
    expectRefusal("merge a.pfm -o b.pfm --errors a.pfm",
                  "a.pfm: is read as well; must be another file than a.pfm");
    EXPECT_EQ(text("a.pfm"), part);
}

TEST_F(Truth, CausticsThatAreDrawnBelongToTheTruth) {
    const std::string view =
        R"({"lucent": 1, "size": [4, 4], "camera": {"eye": [0, 3, 0], "up": [0, 0, -1]},)";
    const std::string objects = R"("objects": [{"name": "floor", "shape": {"type": "plane"}},
        {"name": "ball", "shape": {"type": "sphere", "radius": 0.3}, "material": {"transmission": 1},
         "transform": {"translate": [0, 1, 0]}}]})";
    write("dark.json", view + objects);
    write("lit.json", view + R"("lights": [{"type": "distant", "direction": [0, -1, 0]}],)" + objects);
    const auto estimator = [&](const std::string& scene) {
        expectDone("truth " + scene + " -o out.pfm --threads 1 --samples 4");
        const std::string facts = text("out.pfm.json"), key = "\"estimator\": \"";
        const std::size_t from = facts.find(key) + key.size();
        return facts.substr(from, facts.find('"', from) - from);
    };
    EXPECT_EQ(estimator("dark.json"), "glass");
    const bool drawn = run("explain lit.json").out.find("caustics.") != std::string::npos;
    EXPECT_EQ(estimator("lit.json"), drawn ? "light" : "glass");
    EXPECT_EQ(estimator("lit.json --estimator glass"), "glass");
    EXPECT_EQ(estimator("lit.json --aov depth"), "glass");
    EXPECT_EQ(estimator("lit.json --aov irradiance"), "light");
}

TEST_F(Truth, WhatScattersInsideIsSolvedByDipoleOrWalk) {
    write("marble.json", std::string(R"({"lucent": 1, "size": [6, 6], "camera": {"height": 0.024},
        "lights": [{"type": "distant", "direction": [-1, 0, 0]}], "objects": [
        {"name": "ball", "shape": {"type": "sphere", "radius": 0.01}, "material": {"preset": "marble"}}]})"));
    const auto fact = [&](const std::string& key) {
        const std::string facts = text("out.pfm.json");
        const std::size_t from = facts.find("\"" + key + "\": ") + key.size() + 4;
        return facts.substr(from, facts.find_first_of(",\n", from) - from);
    };
    expectDone("truth marble.json -o out.pfm --samples 16");
    EXPECT_EQ(fact("estimator"), "\"dipole\"");
    const std::string planar = text("out.pfm");
    expectDone("truth marble.json -o out.pfm --samples 16 --set technique.subsurface.dipoleGeometry=offset");
    EXPECT_NE(text("out.pfm"), planar);
    expectDone("truth marble.json -o out.pfm --samples 16 --aov radiosity");
    EXPECT_EQ(fact("estimator"), "\"dipole\"");
    for (const std::string estimator : {"dipole --samples 16", "walk --photons 2000"}) {
        expectDone("truth marble.json -o out.pfm --threads 1 --estimator " + estimator);
        const std::string whole = text("out.pfm");
        expectDone("truth marble.json -o out.pfm --threads 3 --estimator " + estimator);
        EXPECT_EQ(text("out.pfm"), whole);
        for (const char* tile : {"1", "2"})
            expectDone(std::string("truth marble.json -o ") + tile + ".tile --tile " + tile +
                       "/2 --estimator " + estimator);
        expectDone("merge 1.tile 2.tile -o merged.pfm");
        EXPECT_EQ(text("merged.pfm"), whole);
    }
    EXPECT_EQ(fact("photons"), "2000");
    expectRefusal(
        "truth marble.json -o out.pfm --aov depth --estimator walk",
        "--estimator: walk does not solve the AOV depth; must be glass, or --aov color or radiosity");
    expectRefusal("truth marble.json -o out.pfm --aov radiosity --estimator glass",
                  "--estimator: glass does not solve the AOV radiosity; must be dipole or walk");
    expectRefusal("truth marble.json -o out.pfm --photons 5",
                  "--photons: is of light, light-tree and walk; must be --samples for dipole");
    expectRefusal("truth scene.json -o out.pfm --estimator walk",
                  "truth: no object has subsurface scattering; must be one with material.scattering above 0");
}

TEST_F(Truth, ADamagedTileIsRefused) {
    expectDone("truth scene.json -o 1.tile --tile 1/1" + kFew);
    const std::string whole = text("1.tile");
    const std::size_t width = whole.find("\"width\": 16");
    ASSERT_NE(width, std::string::npos);
    write("damaged.tile", std::string(whole).replace(width, 11, "\"width\": -1"));
    expectRefusal("merge damaged.tile -o out.pfm",
                  "damaged.tile: the header of the part is damaged; must be as lucent truth --tile wrote it");
    std::string flipped = whole; // one bit of one pixel
    flipped[flipped.size() - 100] = char(flipped[flipped.size() - 100] ^ 1);
    write("flipped.tile", flipped);
    expectRefusal("merge flipped.tile -o out.pfm", "flipped.tile: has another checksum than its first line "
                                                   "says; must be as lucent truth --tile wrote it");
    write("empty.tile", std::string());
    expectRefusal("merge empty.tile -o out.pfm",
                  "empty.tile: is no part of a truth; must be a file that lucent truth --tile wrote");
    expectDone("merge 1.tile -o out.pfm");
}

TEST_F(Truth, WrongOptionsAreRefused) {
    for (const char* tile : {"0/3", "4/3", "1", "1/17", "x/2", "1/2/3", "-1/2"})
        expectRefusal(std::string("truth scene.json -o a.tile --tile=") + tile,
                      std::string("--tile: is \"") + tile +
                          "\"; must be I/N with I from 1 to N, and N at most the picture's 16 rows");
    expectRefusal("truth scene.json -o a.tile --tile 1/2 --errors e.pfm",
                  "--errors: is of the whole picture; must be given to lucent merge");
    expectRefusal("truth scene.json -o a.pfm --errors e.png",
                  "e.png: PNG cannot hold standard errors; must be .hdr, .exr or .pfm");
    expectRefusal("truth scene.json -o a.pfm --estimator lambert --directions 5",
                  "--directions: is of the relief estimator; must be --samples for lambert");
}

TEST_F(Truth, StoppingATileLeavesNoFile) {
    const std::size_t before = fileCount();
    const Outcome outcome = runStopped("truth scene.json -o out.tile --size 2048x2048 --tile 1/2");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.err, "lucent: truth: stopped before the picture was complete\n");
    EXPECT_EQ(fileCount(), before);
}

class TruthScript : public Truth {
protected:
    void SetUp() override {
        Truth::SetUp();
        // scripts/setup installs it; without it the rest of these tests still says something.
        if (std::system("command -v parallel >/dev/null") != 0) GTEST_SKIP() << "parallel is not installed";
    }
    /// Runs scripts/truth in the folder.
    Outcome script(const std::string& arguments, const std::string& program = LUCENT_PROGRAM) const {
        const std::string command = "cd '" + path("") + "' && LUCENT='" + program +
                                    "' '" LUCENT_ROOT "/scripts/truth' " + arguments + " >.out 2>.err";
        const int status = std::system(command.c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text(".out"), text(".err")};
    }
    /// A program that runs `line` and then is lucent.
    void writeProgram(const std::string& name, const std::string& line) const {
        write(name, "#!/bin/sh\n" + line + "\nexec '" LUCENT_PROGRAM "' \"$@\"\n");
        std::filesystem::permissions(path(name), std::filesystem::perms::owner_all);
    }
};

TEST_F(TruthScript, MakesThePictureOfOneProcess) {
    expectDone("truth scene.json -o whole.pfm" + kFew);
    const Outcome outcome = script("scene.json -o out.pfm --parts 3" + kFew);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(text("out.pfm"), text("whole.pfm"));
    EXPECT_EQ(text("out.pfm.json"), text("whole.pfm.json"));
    EXPECT_FALSE(exists("out.pfm.parts"));
}

TEST_F(TruthScript, MakesOnlyWhatIsMissing) {
    // The first run ends at the merge, as if it had been stopped there; then one part is lost.
    writeProgram("stopping.sh", "[ $1 != merge ] || exit 1");
    writeProgram("counting.sh", "echo $* >>calls");
    const std::string wish = "scene.json -o out.pfm --parts 3" + kFew;
    EXPECT_NE(script(wish, "./stopping.sh").code, 0);
    ASSERT_FALSE(exists("out.pfm"));
    std::size_t removed = 0;
    for (const auto& folder : std::filesystem::directory_iterator(path("out.pfm.parts")))
        removed += std::filesystem::remove(folder.path() / "2.tile");
    ASSERT_EQ(removed, 1u);
    const Outcome outcome = script(wish, "./counting.sh");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const std::string calls = text("calls");
    EXPECT_EQ(std::count(calls.begin(), calls.end(), '\n'), 2) << calls;
    EXPECT_NE(calls.find("--tile 2/3"), std::string::npos) << calls;
    EXPECT_NE(calls.find("merge"), std::string::npos) << calls;
    EXPECT_TRUE(exists("out.pfm"));
}

TEST_F(TruthScript, NamesWhatIsWrong) {
    EXPECT_EQ(script("scene.json").err,
              "truth: scene or output is missing; expected scripts/truth SCENE -o FILE\n");
    EXPECT_EQ(script("none.json -o a.pfm").err, "truth: none.json cannot be read; expected a scene file\n");
    EXPECT_EQ(script("scene.json -o a.pfm --parts 0").err,
              "truth: --parts is \"0\"; expected a whole number above 0\n");
    EXPECT_EQ(script("scene.json -o a.pfm --tile 1/2").err,
              "truth: --tile is not passed on; expected an option that all parts share\n");
    const Outcome outcome = script("scene.json -o a.pfm --aov shine");
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.err.find("--aov: is \"shine\""), std::string::npos) << outcome.err;
    EXPECT_FALSE(exists("a.pfm"));
}

} // namespace
} // namespace lucent::test
