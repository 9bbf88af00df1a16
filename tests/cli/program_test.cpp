#include "tests/cli/Program.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lucent::test {
namespace {

class Program : public ProgramTest {
protected:
    /// The command must end with code 1, one message that holds `message`, and leave no new file.
    void expectRefusalNaming(const std::string& arguments, const std::string& message) const {
        const std::size_t before = fileCount();
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.code, 1) << arguments;
        EXPECT_EQ(outcome.out, "") << arguments;
        EXPECT_EQ(outcome.err.rfind("lucent: ", 0), 0u) << outcome.err;
        EXPECT_NE(outcome.err.find(message), std::string::npos) << arguments << "\n" << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        EXPECT_EQ(fileCount(), before) << arguments;
    }
    /// The scene must be refused by every command that reads one.
    void expectBadScene(const std::string& message) const {
        expectRefusalNaming("render scene.json -o out.png", message);
        expectRefusalNaming("truth scene.json -o out.pfm", message);
        expectRefusalNaming("explain scene.json", message);
    }
};

TEST_F(Program, HelpOfEveryCommandHasExamplesAndEndsWellBehaved) {
    EXPECT_EQ(run("--help").code, 0);
    EXPECT_EQ(run("--version").out, "0.1.0\n");
    for (const char* command : {"render", "truth", "compare", "explain", "list", "convert", "schema", "bench",
                                "report", "merge", "selfcheck"}) {
        const Outcome outcome = run(std::string(command) + " --help");
        EXPECT_EQ(outcome.code, 0);
        EXPECT_EQ(outcome.err, "");
        EXPECT_NE(outcome.out.find("Example"), std::string::npos) << command;
    }
}

TEST_F(Program, WrongUsageIsExplained) {
    writeBump("bump.pfm");
    writeScene("\"bump.pfm\"");
    expectRefusalNaming("", "see lucent --help");
    expectRefusalNaming("frobnicate", "command: is \"frobnicate\"; must be one that lucent --help names");
    expectRefusalNaming("render scene.json", "--output is required; see lucent render --help");
    expectRefusalNaming("render scene.json -o out.png --frob", "--frob; see lucent render --help");
    expectRefusalNaming("render scene.json -o out.gif", "out.gif: ends in no known image type; must be .png");
    expectRefusalNaming("render scene.json -o no/out.png",
                        "no/out.png: cannot be written, no is no folder; must be");
    expectRefusalNaming("render scene.json -o out.png --stats no/s.json", "no/s.json: cannot be written");
    for (const char* size : {"0x4", "16", "4x4x4", "-1x5", "9000x1", "ax4"})
        expectRefusalNaming("render scene.json -o out.png --size=" + std::string(size),
                            "--size: is \"" + std::string(size) +
                                "\"; must be WIDTHxHEIGHT, each from 1 to 8192");
    expectRefusalNaming("render scene.json -o out.png --aov shine",
                        "--aov: is \"shine\"; must be one of color, d,");
    expectRefusalNaming("truth scene.json -o out.png --aov normal", "must be color or d");
}

TEST_F(Program, WrongMomentsAndSequencesAreRefused) {
    writeBump("bump.pfm");
    writeScene("\"bump.pfm\"");
    expectRefusal("render scene.json -o out.png --frames 3",
                  "--frames: nothing in scene.json moves; must be left out");
    expectRefusal("render scene.json -o out.png --time 3",
                  "--time: nothing in scene.json moves; must be left out");
    expectRefusal("render scene.json -o out.png --max-error 2", "--max-error: is 2; must be in [0, 1]");
    for (const char* count : {"0", "10000", "many"})
        expectRefusalNaming("render scene.json -o out.png --frames " + std::string(count),
                            "--frames: is \"" + std::string(count) +
                                "\"; must be an integer in [1, 9999]; see lucent render --help");
    expectRefusalNaming("render scene.json -o out.png --fps 3", "--fps requires --frames");
    write("water.json",
          R"({ "lucent": 1, "objects": [ { "name": "pool", "shape": { "type": "water" } } ] })");
    expectRefusal("render water.json -o out.png --time -1", "--time: is -1; must be in [0, 1000000]");
}

TEST_F(Program, NothingThatIsReadIsWrittenOver) {
    writeBump("bump.pfm");
    writeScene("\"bump.pfm\"");
    const std::string message = ": is read as well; must be another file than ";
    expectRefusal("render scene.json -o bump.pfm", "bump.pfm" + message + "bump.pfm");
    expectRefusal("render scene.json -o out.pfm --stats scene.json", "scene.json" + message + "scene.json");
    expectRefusal("convert bump.pfm -o ./bump.pfm", "./bump.pfm" + message + "bump.pfm");
}

TEST_F(Program, TheBenchmarkSaysWhatItsFolderMustBe) {
    write("taken", "a file");
    const Outcome outcome = run("bench --quick -o taken --gallery none");
    EXPECT_EQ(outcome.code, 1);
    const std::string message =
        "lucent: taken: cannot be made (Not a directory); must be a folder, or a place "
        "where one can be made\n";
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("bench: none/elevation.json: is not there and left out\n"), std::string::npos);
}

TEST_F(Program, WrongChangesOfParametersAreRefusedWithTheirPath) {
    writeBump("bump.pfm");
    writeScene("\"bump.pfm\"");
    expectRefusalNaming("render scene.json -o out.png --set depth", "--set: is \"depth\"; must be KEY=VALUE");
    expectRefusalNaming("render scene.json -o out.png --set objects.field.material.depht=1",
                        "--set: objects.field.material.depht is not a parameter; the nearest is "
                        "objects.field.material.depth");
    expectRefusalNaming("truth scene.json -o out.png --set objects.field.material.depth=-1",
                        "--set: objects.field.material.depth is -1; must be");
    expectRefusalNaming("truth scene.json -o out.png --set technique.relief.method=magic",
                        "technique.relief.method is");
}

TEST_F(Program, MissingFilesAreNamed) {
    expectBadScene("scene.json: cannot be read (No such file or directory)");
    writeScene("\"bump.pfm\"");
    expectBadScene("bump.pfm: cannot be read (No such file or directory)");
}

TEST_F(Program, WrongTypesAreNamedWithTheirLine) {
    writeScene("5");
    expectBadScene("scene.json:4: objects.field.shape.heights is 5; must be");
    write("scene.json", std::string("{ \"lucent\": 1,\n  \"objects\": "));
    expectBadScene("scene.json:");
}

TEST_F(Program, UnknownKeysAndValuesOutOfRangeAreNamedWithTheirLine) {
    writeBump("bump.pfm");
    writeScene("\"bump.pfm\"", "\"shine\": 1");
    expectBadScene("scene.json:5: ");
    expectBadScene("shine");
    writeScene("\"bump.pfm\"", "\"specularity\": 2");
    expectBadScene("scene.json:5: objects.field.material.specularity is 2; must be in [0, 1]");
}

TEST_F(Program, ATruncatedPngIsRefused) {
    writeBump("bump.png");
    writeScene("\"bump.png\"");
    write("bump.png", text("bump.png").substr(0, 50));
    expectBadScene("bump.png: ");
}

TEST_F(Program, ATexelThatIsNotANumberIsRefusedWithItsPlace) {
    // PFM by hand, rows from the bottom: the third number stands in column 0 of the upper row.
    const float values[] = {0, 1, std::numeric_limits<float>::quiet_NaN(), 0.5f};
    write("nan.pfm", "Pf\n2 2\n-1\n" + std::string(reinterpret_cast<const char*>(values), sizeof values));
    writeScene("\"nan.pfm\"");
    expectBadScene("nan.pfm: ");
}

TEST_F(Program, AnImageOfNoSizeIsRefused) {
    write("none.pfm", std::string("Pf\n0 4\n-1\n"));
    writeScene("\"none.pfm\"");
    expectBadScene("none.pfm: is 0 x 4 pixels");
}

TEST_F(Program, TruthWritesTheModelsValues) {
    // A flat field in its object's plane under a lamp: d of the middle is the sine of the lamp's elevation
    // from p'.
    write("flat.pfm", Image(8, 8, 1));
    writeScene("\"flat.pfm\"", R"("depth": 0.25)");
    ASSERT_EQ(run("truth scene.json -o d.pfm --aov d --size 1x1 --set 'lights.0.position=0.3 0 0.05'").code,
              0);
    const auto bytes = readFile(path("d.pfm"));
    ASSERT_TRUE(bytes.ok());
    const auto image = decodeImage(*bytes, "d.pfm", Encoding::Linear);
    ASSERT_TRUE(image.ok());
    EXPECT_FLOAT_EQ(image->pixels[0], 0.3f / std::hypot(0.3f, 0.3f)); // 0.3 m aside, 0.05 + 0.25 m up
}

TEST_F(Program, APictureThatIsNotFiniteIsRefused) {
    Image sky(2, 1, 3);
    std::fill(sky.pixels.begin(), sky.pixels.end(), 3e38f);
    write("sky.pfm", sky);
    write("mirror.json", std::string(R"({ "lucent": 1, "size": [4, 4], "camera": { "eye": [0, 0, 3] },
  "environment": { "source": "sky.pfm", "intensity": 1000 },
  "objects": [ { "name": "ball", "shape": { "type": "sphere" }, "material": { "reflectance": [1, 1, 1] } } ] })"));
    for (const char* name : {"out.pfm", "out.exr"})
        expectRefusal(
            std::string("truth mirror.json -o ") + name,
            name +
                std::string(": the picture is NaN or infinite at pixel (0, 0); must be finite everywhere"));
}

TEST_F(Program, StoppingTheTruthLeavesNoFile) {
    writeBump("bump.pfm");
    // Thousands of directions and a large picture: minutes of work.
    writeScene("\"bump.pfm\"", R"("depth": 0.1)", R"("environment": { "source": "sky" })");
    const Outcome outcome = runStopped("truth scene.json -o out.pfm --size 2048x2048");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.err, "lucent: truth: stopped before the picture was complete\n");
    EXPECT_FALSE(exists("out.pfm"));
}

TEST_F(Program, CompareMeasuresAndDrawsWhereItDiffers) {
    Image a(2, 1, 3), b(2, 1, 3);
    for (int channel = 0; channel < 3; ++channel)
        a.at(1, 0)[channel] = 0.5f;
    write("a.pfm", a);
    write("b.pfm", b);
    const Outcome outcome = run("compare a.pfm b.pfm --json --heatmap heat.png");
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.out.find("\"max\": 0.5"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("\"mae\": 0.25"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("\"fluxRatio\": null"), std::string::npos)
        << outcome.out; // the reference is black
    EXPECT_TRUE(exists("heat.png"));
    write("c.pfm", Image(1, 2, 3));
    expectRefusalNaming("compare a.pfm c.pfm --heatmap more.png", "a.pfm: has 2x1 pixels");
    expectRefusalNaming("compare a.pfm nothing.pfm", "nothing.pfm: cannot be read");
    expectRefusalNaming("compare a.pfm b.pfm --heatmap more.txt", "more.txt: ends in no known image type");
}

TEST_F(Program, CompareGivesItsNumbersAsJson) {
    // A difference of 1/4 in one pixel of two, over a reference of 1/4 everywhere.
    Image a(2, 1, 3), b(2, 1, 3);
    std::fill(b.pixels.begin(), b.pixels.end(), 0.25f);
    a.pixels = {0.25f, 0.25f, 0.25f, 0.5f, 0.5f, 0.5f};
    write("a.pfm", a);
    write("b.pfm", b);
    write("b.pfm.json", std::string("{ \"standardError\": 0.03125 }"));
    const Outcome outcome = run("compare a.pfm b.pfm --json");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const nlohmann::json found = parsed(outcome.out);
    ASSERT_TRUE(found.is_object());
    const double rmse = 0.25 / std::sqrt(2);
    const std::pair<const char*, double> expected[] = {{"rmse", rmse},
                                                       {"relRmse", rmse / 0.25},
                                                       {"relMse", 0.5 * 0.0625 / (0.0625 + 0.01)},
                                                       {"relMseEpsilon", 0.01},
                                                       {"mae", 0.125},
                                                       {"p50", 0},
                                                       {"p90", 0.25},
                                                       {"p99", 0.25},
                                                       {"max", 0.25},
                                                       {"bias", 0.125},
                                                       {"psnr", -20 * std::log10(rmse)},
                                                       {"fluxRatio", 1.5},
                                                       {"truthNoise", 0.03125}};
    for (const auto& [key, value] : expected)
        EXPECT_NEAR(found.value(key, -1.0), value, 1e-12) << key;
    EXPECT_EQ(found["maxAt"], nlohmann::json({1, 0}));
    EXPECT_EQ(found["truthTooNoisy"], false); // 0.18 is above 3 times 0.03
}

TEST_F(Program, CompareDrawsTheLargestDifferenceLightest) {
    Image a(3, 1, 1);
    a.pixels = {0, 0.5f, 1};
    write("a.pfm", a);
    write("b.pfm", Image(3, 1, 1));
    ASSERT_EQ(run("compare a.pfm b.pfm --heatmap heat.pfm").code, 0);
    const auto bytes = readFile(path("heat.pfm"));
    ASSERT_TRUE(bytes.ok());
    const auto heat = decodeImage(*bytes, "heat.pfm", Encoding::Linear);
    ASSERT_TRUE(heat.ok());
    const auto light = [&](int x) { return heat->at(x, 0)[0] + heat->at(x, 0)[1] + heat->at(x, 0)[2]; };
    EXPECT_EQ(light(0), 0);
    EXPECT_LT(light(0), light(1));
    EXPECT_LT(light(1), light(2));
}

TEST_F(Program, CompareRefusesWhatCannotBeCompared) {
    write("a.pfm", Image(2, 1, 3));
    write("b.pfm", Image(2, 1, 3));
    write("grey.pfm", Image(2, 1, 1));
    write("tall.pfm", Image(1, 2, 3));
    const float values[] = {0, 1, std::numeric_limits<float>::quiet_NaN(), 0.5f};
    write("nan.pfm", "Pf\n2 2\n-1\n" + std::string(reinterpret_cast<const char*>(values), sizeof values));
    write("four.pfm", Image(2, 2, 1));
    expectRefusal("compare a.pfm grey.pfm", "a.pfm: has 2x1 pixels with 3 colour channels; must have 2x1 "
                                            "pixels with 1 colour channel like grey.pfm");
    expectRefusal("compare a.pfm tall.pfm", "a.pfm: has 2x1 pixels with 3 colour channels; must have 1x2 "
                                            "pixels with 3 colour channels like tall.pfm");
    expectRefusal("compare four.pfm nan.pfm",
                  "nan.pfm: 1 values are NaN or infinite, the first at pixel (0, 0); must be finite");
    expectRefusal("compare a.pfm b.pfm --mask grey.pfm",
                  "a.pfm: no pixel is covered; at least one must be"); // grey.pfm is 0 everywhere
    expectRefusal("compare none.pfm b.pfm", "none.pfm: cannot be read (No such file or directory)");
    expectRefusal("compare a.pfm", "B is required; see lucent compare --help");
}

TEST_F(Program, CompareOverwritesNothingThatItReads) {
    write("a.pfm", Image(2, 1, 1));
    write("b.pfm", Image(2, 1, 1));
    const std::string a = text("a.pfm");
    expectRefusal("compare a.pfm b.pfm --heatmap a.pfm",
                  "a.pfm: is read as well; must be another file than a.pfm");
    expectRefusal("compare a.pfm b.pfm --flip ./b.pfm",
                  "./b.pfm: is read as well; must be another file than b.pfm");
    expectRefusal("compare a.pfm b.pfm --heatmap heat.png --flip heat.png",
                  "heat.png: is written twice, as heat.png too; must be two files");
    EXPECT_EQ(text("a.pfm"), a);
}

TEST_F(Program, CompareWritesBothPicturesOrNone) {
    write("a.pfm", Image(2, 1, 1));
    write("b.pfm", Image(2, 1, 1));
    std::filesystem::create_directory(path("flip.png")); // cannot be written
    expectRefusal("compare a.pfm b.pfm --heatmap heat.png --flip flip.png",
                  "flip.png: is a folder; must be a regular file, or a new one");
}

TEST_F(Program, CompareMeasuresHowVisibleTheDifferenceIs) {
    // White against black: no pixel differs more, and an even picture of 32 x 32 pixels is compared whole.
    Image white(32, 32, 1);
    std::fill(white.pixels.begin(), white.pixels.end(), 1.0f);
    write("white.pfm", white);
    write("black.pfm", Image(32, 32, 1));
    const Outcome outcome = run("compare white.pfm black.pfm --flip flip.png");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    for (const char* line :
         {"FLIP        0.967", "SSIM        9.999e-05", "  over mean nan", "median      1\n"})
        EXPECT_NE(outcome.out.find(line), std::string::npos) << line << "\n" << outcome.out;
    EXPECT_TRUE(exists("flip.png"));
}

TEST_F(Program, CompareCountsOnlyWhatTheMaskShows) {
    Image a(2, 1, 1), mask(2, 1, 1);
    a.pixels = {0.5f, 0.25f};
    mask.pixels = {0, 1};
    write("a.pfm", a);
    write("b.pfm", Image(2, 1, 1));
    write("mask.pfm", mask);
    EXPECT_NE(run("compare a.pfm b.pfm --json --mask mask.pfm").out.find("\"max\": 0.25"), std::string::npos);
    write("mask.pfm", Image(1, 2, 1));
    expectRefusalNaming("compare a.pfm b.pfm --mask mask.pfm",
                        "mask.pfm: has 1x2 pixels; must have 2x1 like");
}

TEST_F(Program, CompareSaysWhenTheTruthIsTooNoisyToJudge) {
    Image a(2, 1, 1);
    a.pixels = {0.25f, 0.25f}; // RMSE 0.25 against black
    write("a.pfm", a);
    write("b.pfm", Image(2, 1, 1));
    EXPECT_EQ(run("compare a.pfm b.pfm").out.find("truth noise"), std::string::npos);
    write("b.pfm.json", std::string("{ \"standardError\": 0.08 }"));
    const std::string judged = run("compare a.pfm b.pfm").out;
    EXPECT_NE(judged.find("truth noise 0.08"), std::string::npos) << judged;
    EXPECT_EQ(judged.find("too noisy"), std::string::npos) << judged;
    write("b.pfm.json", std::string("{ \"standardError\": 0.09 }")); // 3 times it is 0.27
    EXPECT_NE(run("compare a.pfm b.pfm").out.find("too noisy to judge"), std::string::npos);
    EXPECT_NE(run("compare a.pfm b.pfm --json").out.find("\"truthTooNoisy\": true"), std::string::npos);
    write("b.pfm.json", std::string("{\n \"standardError\": \"much\" }"));
    expectRefusalNaming("compare a.pfm b.pfm", "b.pfm.json:2: standardError is \"much\"; must be a number");
}

TEST_F(Program, ReportTakesNothingButReports) {
    write("other.json", std::string("{ \"format\": \"other\" }"));
    expectRefusalNaming("report other.json -o page.html",
                        "other.json: format is \"other\"; must be \"lucent-bench-1\"");
    write("broken.json", std::string("{ \"format\": "));
    expectRefusalNaming("report broken.json -o page.html", "broken.json:1");
    expectRefusalNaming("report none.json -o page.html", "none.json: cannot be read");
    expectRefusalNaming("bench speed -o out",
                        "NAMES: is \"speed\"; must be one of all, relief, environment,");
    // A report is put into the page as it stands, but for what would end its script element.
    write("bench.json", std::string("{ \"format\": \"lucent-bench-1\", \"commit\": \"</script>\" }"));
    const Outcome outcome = run("report bench.json -o page.html");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(text("page.html").find("\"commit\": \"<\\/script>\" }]</script>"), std::string::npos);
}

TEST_F(Program, ReportPutsReportsOnThePageInTheirOrder) {
    write("a.json", std::string("{ \"format\": \"lucent-bench-1\", \"commit\": \"first\" }"));
    write("b.json", std::string("{ \"format\": \"lucent-bench-1\", \"commit\": \"second\" }"));
    ASSERT_EQ(run("report b.json a.json -o page.html").code, 0);
    const std::string page = text("page.html"), start = R"(id="reports">)";
    const std::size_t from = page.find(start), end = page.find("</script>", from);
    ASSERT_NE(end, std::string::npos);
    const nlohmann::json reports = parsed(page.substr(from + start.size(), end - from - start.size()));
    ASSERT_EQ(reports.size(), 2u);
    EXPECT_EQ(reports[0]["commit"], "second");
    EXPECT_EQ(reports[1]["commit"], "first");
}

TEST_F(Program, ReportWritesNothingWhenOneReportIsWrong) {
    const std::string good = "{ \"format\": \"lucent-bench-1\" }";
    write("good.json", good);
    write("other.json", std::string("{ \"passed\": true }")); // as selfcheck writes it
    write("page.html", std::string("kept"));
    expectRefusal("report good.json other.json -o page.html",
                  "other.json: format is missing; must be \"lucent-bench-1\", as lucent bench writes it");
    expectRefusal("report good.json none.json -o page.html",
                  "none.json: cannot be read (No such file or directory)");
    expectRefusal("report good.json -o no/page.html",
                  "no/page.html: cannot be written, no is no folder; must be in an existing one");
    expectRefusal("report good.json -o good.json",
                  "good.json: is read as well; must be another file than good.json");
    expectRefusal("report -o page.html", "JSON is required; see lucent report --help");
    EXPECT_EQ(text("page.html"), "kept");
    EXPECT_EQ(text("good.json"), good);
}

TEST_F(Program, ConvertMakesHeightsOfImagesAndNormalMaps) {
    writeBump("bump.png");
    ASSERT_EQ(run("convert bump.png -o bump.pfm").code, 0);
    const auto bytes = readFile(path("bump.pfm"));
    const auto image = decodeImage(*bytes, "bump.pfm", Encoding::Linear);
    EXPECT_EQ(*image->at(3, 4), 1);
    EXPECT_EQ(*image->at(4, 4), 0);

    // Normals (1, 0, 1) / sqrt 2 everywhere: one texel down for each texel to the right. Stored as (n + 1)
    // / 2.
    Image normals(4, 2, 3);
    for (std::size_t i = 0; i < normals.pixels.size(); ++i)
        normals.pixels[i] = i % 3 == 1 ? 0.5f : 0.5f + 0.5f * std::sqrt(0.5f);
    write("slope.pfm", normals);
    const Outcome outcome = run("convert slope.pfm -o heights.pfm --normals");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    // Three texels high over four texels in a metre: 0.75 m.
    EXPECT_NE(outcome.out.find("heightScale = 0.75 for a width of 1 m"), std::string::npos) << outcome.out;

    expectRefusalNaming("convert bump.png -o out.png", "out.png: 8-bit PNG would make terraces");
    expectRefusalNaming("convert bump.png -o out.pfm --rotate 0,1,2",
                        "bump.png: is no mesh; --size, --rotate");
    expectRefusalNaming("convert nothing.glb -o out.pfm", "nothing.glb: cannot be read");
    write("bad.glb", std::string("glTF and then nothing"));
    expectRefusalNaming("convert bad.glb -o out.pfm", "bad.glb: ");
}

TEST_F(Program, ConvertSeesAMeshFromAboveAndChecksItsOptions) {
    // A triangle as glTF with its buffer beside it: three corners, of which one is 1 m higher.
    const float corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 1};
    write("triangle.bin", std::string(reinterpret_cast<const char*>(corners), sizeof corners));
    write("triangle.gltf",
          std::string(R"({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [ { "nodes": [ 0 ] } ],
  "nodes": [ { "mesh": 0 } ], "meshes": [ { "primitives": [ { "attributes": { "POSITION": 0 } } ] } ],
  "buffers": [ { "uri": "triangle.bin", "byteLength": 36 } ],
  "bufferViews": [ { "buffer": 0, "byteLength": 36 } ],
  "accessors": [ { "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [ 0, 0, 0 ], "max": [ 1, 1, 1 ] } ] })"));
    const Outcome outcome =
        run("convert triangle.gltf -o heights.pfm --size 32x16 --floor-gap 0.5 --margin 0.1");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "heights.pfm: 32 x 16 heights\n");
    expectRefusalNaming("convert triangle.gltf -o out.pfm --margin 2",
                        "--margin: is 2; must be in [0, 0.45]");
    expectRefusalNaming("convert triangle.gltf -o out.pfm --floor-gap x", "--floor-gap: is \"x\"; must be");
    expectRefusalNaming("convert triangle.gltf -o out.pfm --size 0x0", "--size: is \"0x0\"; must be");
    expectRefusalNaming("convert triangle.gltf -o out.pfm --normals",
                        "triangle.gltf: is a mesh; --normals takes an image");
}

TEST_F(Program, ListAndSchemaNameEveryParameter) {
    for (const char* format : {"list", "list --json", "list --markdown", "schema"}) {
        const Outcome outcome = run(format);
        EXPECT_EQ(outcome.code, 0);
        EXPECT_EQ(outcome.err, "");
        for (const char* word :
             {"relief", "hierarchy", "march", "counting", "specularFalloff", "heightScale", "fov"})
            EXPECT_NE(outcome.out.find(word), std::string::npos) << format << " lacks " << word;
    }
}

TEST_F(Program, ListAsJsonSaysKindsRangesAndDefaults) {
    const nlohmann::json list = parsed(run("list --json").out);
    ASSERT_TRUE(list.is_object());
    const auto parameter = [&](const std::string& path, const std::string& id) {
        for (const nlohmann::json& section : list["sections"])
            for (const nlohmann::json& one : section["parameters"])
                if (section["path"] == path && one["id"] == id) return one;
        return nlohmann::json();
    };
    const nlohmann::json steps = parameter("technique.relief", "steps");
    EXPECT_EQ(steps["kind"], "integer");
    EXPECT_EQ(steps["min"], 1);
    EXPECT_EQ(steps["max"], 65536);
    EXPECT_EQ(steps["default"], "256");
    const nlohmann::json depth = parameter("objects.NAME.material", "depth");
    EXPECT_EQ(depth["unit"], "m");
    EXPECT_EQ(depth["min"], 0);
    EXPECT_EQ(depth["minIsExcluded"], true);
    const nlohmann::json method = parameter("technique.relief", "method");
    EXPECT_EQ(method["choices"], nlohmann::json({"hierarchy", "march", "counting", "transfer"}));
    EXPECT_EQ(method["default"], "hierarchy");
    EXPECT_EQ(list["aovs"][0], "color");
}

TEST_F(Program, TheSchemaIsJsonAndKnowsRanges) {
    const nlohmann::json schema = parsed(run("schema").out);
    ASSERT_TRUE(schema.is_object());
    EXPECT_EQ(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    EXPECT_EQ(schema["required"], nlohmann::json({"lucent", "objects"}));
    const nlohmann::json& relief = schema["properties"]["technique"]["properties"]["relief"]["properties"];
    EXPECT_EQ(relief["steps"]["minimum"], 1);
    EXPECT_EQ(relief["steps"]["maximum"], 65536);
    EXPECT_EQ(relief["method"]["enum"][0], "hierarchy");
}

TEST_F(Program, ListAndSchemaTakeNothingElse) {
    expectRefusal("list --json --markdown", "--json excludes --markdown; see lucent list --help");
    expectRefusal("list coin.json",
                  "The following argument was not expected: coin.json; see lucent list --help");
    expectRefusal("schema coin.json",
                  "The following argument was not expected: coin.json; see lucent schema --help");
}

} // namespace
} // namespace lucent::test
