// Commands that need a device: what they print and write, and what happens without one.
#include "tests/cli/Program.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace lucent::test {
namespace {

class OnThisMachine : public ProgramTest {
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
};

TEST_F(OnThisMachine, SelfcheckPassesAndWritesWhatItPrints) {
    const Outcome outcome = run("selfcheck --json machine.json");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const nlohmann::json machine = parsed(text("machine.json"));
    ASSERT_TRUE(machine.is_object());
    EXPECT_EQ(machine["passed"], true);
    ASSERT_GE(machine["checks"].size(), 1u);
    for (const nlohmann::json& one : machine["checks"]) {
        const std::string name = one["name"];
        EXPECT_LE(std::abs(double(one["found"]) - double(one["expected"])), double(one["tolerance"])) << name;
        EXPECT_NE(outcome.out.find("\n" + name + " "), std::string::npos) << name;
        EXPECT_NE(one["reason"], "") << name;
    }
    for (const nlohmann::json& one : machine["capabilities"])
        EXPECT_NE(outcome.out.find("\n" + std::string(one["name"])), std::string::npos) << one;
    EXPECT_EQ(outcome.out.rfind(std::string(machine["device"]["renderer"]) + ", ", 0), 0u) << outcome.out;
    EXPECT_EQ(outcome.out.find("FAILED"), std::string::npos);
}

TEST_F(OnThisMachine, SelfcheckRefusesWhatItCannotWrite) {
    expectRefusal("selfcheck --json no/machine.json",
                  "no/machine.json: cannot be written, no is no folder; must be in an existing one");
    expectRefusal("selfcheck machine.json",
                  "The following argument was not expected: machine.json; see lucent selfcheck --help");
}

TEST_F(OnThisMachine, ExplainGivesEachPassItsTargetAndItsBytes) {
    const Outcome outcome = run("explain scene.json --size 8x4");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    // 8 x 4 pixels of four 32-bit floats, or of four bytes.
    for (const char* line :
         {"\n  views.surface: ", "\n      -> frame.surface 8x4 RGBA32F, 512 bytes\n",
          "\n  relief.light: lights 0 to 0 of 1 ", "\n      -> screen 8x4 RGBA8, 128 bytes\n"})
        EXPECT_NE(outcome.out.find(line), std::string::npos) << line << "\n" << outcome.out;
    EXPECT_FALSE(exists("out.png"));
}

TEST_F(OnThisMachine, ExplainOfNormalsNamesNoLight) {
    const std::string out = run("explain scene.json --aov normal").out;
    EXPECT_NE(out.find("views.surface"), std::string::npos) << out;
    EXPECT_EQ(out.find("\n  relief.light: "), std::string::npos) << out;
}

TEST_F(OnThisMachine, BenchWritesAReportWithEveryHardCase) {
    const Outcome outcome = run("bench hard --quick --gallery none --commit test -o bench");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const nlohmann::json report = parsed(text("bench/bench.json"));
    ASSERT_TRUE(report.is_object());
    EXPECT_EQ(report["format"], "lucent-bench-1");
    EXPECT_EQ(report["commit"], "test");
    EXPECT_EQ(report["quick"], true);
    EXPECT_EQ(report["measurements"].size(), 0u); // nobody asked for the other parts
    std::map<std::string, int> outcomes;          // of the exact method
    for (const nlohmann::json& one : report["hardCases"]) {
        if (one["method"] != "hierarchy") continue;
        ++outcomes[one["status"]];
        // Eight bits lose the heights' lower digits before any method sees them.
        if (one["status"] == "error") {
            EXPECT_EQ(one["name"], "8-bit terraces against the original");
        }
        if (one["status"] == "refused") {
            EXPECT_NE(std::string(one["message"]).find("texel (5, 2) is "), std::string::npos) << one;
        }
    }
    EXPECT_GE(outcomes["pass"], 18);
    EXPECT_EQ(outcomes["refused"], 2); // NaN and infinity
    EXPECT_NE(text("bench/report.html").find("\"commit\": \"test\""), std::string::npos);
}

TEST_F(OnThisMachine, BenchRefusesFoldersThatCannotBe) {
    expectRefusal("bench hard", "--output is required; see lucent bench --help");
    const std::size_t before = fileCount();
    const Outcome outcome = run("bench hard --gallery none -o bump.pfm/bench");
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.err.find("lucent: bump.pfm/bench: cannot be made ("), std::string::npos) << outcome.err;
    EXPECT_EQ(fileCount(), before);
}

/// Finds no driver, as on a machine without one.
class WithoutADriver : public ProgramTest {
protected:
    void SetUp() override {
        ProgramTest::SetUp();
        setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere", 1);
        writeBump("bump.pfm");
        writeScene("\"bump.pfm\"");
    }
    void TearDown() override {
        unsetenv("__EGL_VENDOR_LIBRARY_FILENAMES");
        ProgramTest::TearDown();
    }
};

TEST_F(WithoutADriver, CommandsThatDrawEndWith2AndWriteNothing) {
    const std::size_t before = fileCount();
    for (const char* arguments : {"render scene.json -o out.png --stats out.json", "explain scene.json",
                                  "selfcheck --json out.json"}) {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 2) << arguments;
        EXPECT_EQ(outcome.out, "") << arguments;
        EXPECT_EQ(outcome.err, "lucent: gl: no OpenGL ES 3.0 context without a window system; install "
                               "libegl-mesa0 and libgl1-mesa-dri, or the driver of the GPU\n")
            << arguments;
        EXPECT_EQ(fileCount(), before) << arguments;
    }
}

TEST_F(WithoutADriver, CommandsThatDoNotDrawWork) {
    write("report.json", std::string("{ \"format\": \"lucent-bench-1\" }"));
    for (const char* arguments : {"truth scene.json -o out.pfm", "compare out.pfm out.pfm", "list", "schema",
                                  "report report.json -o page.html"})
        EXPECT_EQ(run(arguments).code, 0) << arguments;
}

} // namespace
} // namespace lucent::test
