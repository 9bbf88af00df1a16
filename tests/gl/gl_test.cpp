// The GL layer on a real driver.
#include "gl/Context.h"
#include "gl/Timer.h"
#include "gl/Variants.h"
#include "shaders/Shaders.h"
#include "tests/support/Gl.h"

#include <cstring>

namespace lucent::gl {
namespace {

using Gl = support::GlTest;

// With every set of switches that shaders declare, which are all that programs may be asked for with. Those
// of one shader are compiled beside each other where the driver can.
TEST_F(Gl, EveryShaderCompilesInEveryVariant) {
    const std::string ending = ".frag";
    int shaders = 0, compiled = 0;
    for (const shaders::Stage* stage = shaders::begin(); stage != shaders::end(); ++stage) {
        const std::string path = stage->path;
        if (path.size() < ending.size() || path.substr(path.size() - ending.size()) != ending) continue;
        const std::string stem = path.substr(0, path.size() - ending.size());
        const std::vector<Switches> variants = variantsOf(stage->variants);
        std::vector<std::unique_ptr<Program>> programs;
        for (const Switches& switches : variants)
            programs.push_back(std::make_unique<Program>(stem, switches));
        for (std::size_t i = 0; i < programs.size(); ++i) {
            const Status& ready = programs[i]->ready();
            std::string with;
            for (const std::string& one : variants[i])
                with += " " + one;
            EXPECT_TRUE(ready.ok()) << stem << with << ": " << (ready.ok() ? "" : ready.error().message);
        }
        ++shaders;
        compiled += int(programs.size());
    }
    EXPECT_GT(shaders, 50);
    EXPECT_GT(compiled, 1000);
}

TEST_F(Gl, AVariantThatAShaderDoesNotDeclareIsRefused) {
    const Program unknown("frame/display", {"LINEAR", "USE_X"}), missing("views/geometry", {});
    ASSERT_FALSE(unknown.ready().ok());
    EXPECT_EQ(unknown.ready().error().message,
              "frame/display: its #pragma variants do not allow LINEAR USE_X");
    ASSERT_FALSE(missing.ready().ok());
    EXPECT_EQ(missing.ready().error().message,
              "views/geometry: its #pragma variants do not allow to leave all switches out");
}

TEST(Variants, AreAllSetsThatTheLinesAllow) {
    const std::string_view lines = "- A\nB C\nN=1..4 if A";
    const std::vector<Switches> expected = {
        {"B"}, {"C"}, {"A", "B", "N 1"}, {"A", "B", "N 4"}, {"A", "C", "N 1"}, {"A", "C", "N 4"}};
    EXPECT_EQ(variantsOf(lines), expected);
    for (const Switches& one : expected)
        EXPECT_TRUE(isVariant(lines, one));
    EXPECT_TRUE(isVariant(lines, {"N 3", "C", "A"})); // within the range, in any order
    EXPECT_FALSE(isVariant(lines, {"A", "B"}));       // N is missing
    EXPECT_FALSE(isVariant(lines, {"B", "N 1"}));     // N only with A
    EXPECT_FALSE(isVariant(lines, {"A", "B", "N 5"}));
    EXPECT_FALSE(isVariant(lines, {"B", "C"}));
    EXPECT_FALSE(isVariant(lines, {"B", "D"}));
    EXPECT_EQ(variantsOf("- A\n- B unless A"), (std::vector<Switches>{{}, {"B"}, {"A"}}));
    EXPECT_FALSE(isVariant("- A\n- B unless A", {"A", "B"}));
    EXPECT_EQ(variantsOf(""), std::vector<Switches>{Switches{}});
}

TEST_F(Gl, AProgramIsCompiledOnceForEachSetOfSwitches) {
    const Program* first = context->program("frame/display", {"LINEAR"});
    EXPECT_EQ(first, context->program("frame/display", {"LINEAR"}));
    EXPECT_NE(first, context->program("frame/display", {}));
}

// A switch that breaks a line of an include: the message must name the include, not the joined source.
Program brokenProgram() {
    return Program("frame/display", *shaders::find("lib/screen.vert"), *shaders::find("frame/display.frag"),
                   {"srgbFromLinear 1bad"});
}

TEST_F(Gl, ShaderErrorsNameOurFileAndLine) {
    const Program broken = brokenProgram();
    const Status& status = broken.ready();
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().message.find("lib/shading.glsl:"), std::string::npos) << status.error().message;
    EXPECT_EQ(status.error().fault, Fault::Machine);
}

TEST_F(Gl, AProgramThatDoesNotCompileSaysSoWhenItDraws) {
    const Program broken = brokenProgram();
    const graph::Texture target(context->device(), {.size = {1, 1}, .format = graph::Format::RGBA8}, "test");
    EXPECT_EQ(context->takeError(), "") << "before it draws";
    context->device().runPass({.label = "test", .colors = {{.texture = target.handle()}}},
                              [&](graph::Commands& commands) { commands.draw({.program = &broken}); });
    EXPECT_NE(context->takeError().find("lib/shading.glsl:"), std::string::npos);
}

TEST_F(Gl, NobodyWaitsForAProgramThatIsReady) {
    const Program* program = context->program("frame/display", {"LINEAR"});
    EXPECT_TRUE(program->ready().ok());
    EXPECT_FALSE(program->isCompiling());
}

TEST_F(Gl, LogsOfBothDriversAreTranslated) {
    const shaders::Stage* stage = shaders::find("frame/display.frag");
    ASSERT_NE(stage, nullptr);
    const shaders::Piece& first = *stage->pieces[0];
    const std::string place = std::string(first.file) + ":" + std::to_string(first.line);
    EXPECT_EQ(translateLog("0:7(12): error: no", "frame/display.frag", 7), place + ": error: no");
    EXPECT_EQ(translateLog("ERROR: 0:7: 'x' : no", "frame/display.frag", 7), place + ": 'x' : no");
    EXPECT_EQ(translateLog("something else", "frame/display.frag", 7), "something else");
}

TEST_F(Gl, TexturesComeBackAsTheyWereSent) {
    Image sent(3, 2, 4);
    for (std::size_t i = 0; i < sent.pixels.size(); ++i)
        sent.pixels[i] = 0.25f * float(i) - 1;
    const graph::Texture texture(context->device(), {.size = {3, 2}, .format = graph::Format::RGBA32F},
                                 "test");
    // upload() and read() both speak of the top row first, but a texture drawn by GL starts at the bottom:
    // what was uploaded as the first row is GL's bottom row.
    context->device().upload(texture.handle(), 0, sent.pixels);
    const Image back = context->device().read(texture.handle());
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 3; ++x)
            for (int c = 0; c < 4; ++c)
                EXPECT_EQ(back.at(x, y)[c], sent.at(x, 1 - y)[c]);
}

TEST_F(Gl, ABlockThatDiffersFromItsShaderIsRefused) {
    const Program* program = context->program("frame/display", {});
    ASSERT_TRUE(program->ready().ok());
    graph::Block block;
    block.name = "DisplayBlock";
    block.bytes.resize(16);
    const Status small = program->checkBlock(block);
    ASSERT_FALSE(small.ok());
    EXPECT_NE(small.error().message.find("frame/display: block DisplayBlock: "), std::string::npos);
    EXPECT_NE(small.error().message.find(" bytes in GLSL, 16 in C++"), std::string::npos);
    block.name = "OtherBlock";
    const Status unknown = program->checkBlock(block);
    ASSERT_FALSE(unknown.ok());
    EXPECT_EQ(unknown.error().message, "frame/display: block OtherBlock: not in the shader");
}

TEST_F(Gl, ATextureTooLargeForTheGpuIsReported) {
    {
        const graph::Texture huge(context->device(), {.size = {1 << 20, 4}, .format = graph::Format::R8},
                                  "huge");
        EXPECT_NE(context->takeError().find("texture \"huge\" of 1048576x4 R8: "), std::string::npos);
    }
}

TEST_F(Gl, TextureBytesAreCountedAndGivenBack) {
    const std::size_t before = context->device().textureBytes();
    {
        const graph::Texture texture(context->device(), {.size = {16, 8}, .format = graph::Format::R32F},
                                     "test");
        EXPECT_EQ(context->device().textureBytes(), before + 16 * 8 * 4);
    }
    EXPECT_EQ(context->device().textureBytes(), before);
}

TEST_F(Gl, CapsNameTheDriver) {
    EXPECT_FALSE(context->caps().renderer.empty());
    EXPECT_GE(context->caps().maxTextureSize, 2048); // the least that ES 3.0 allows
    EXPECT_GE(context->caps().maxDrawBuffers, 4);
}

TEST_F(Gl, TimerQueriesAnswerWhereTheyExist) {
    Timer timer(*context);
    if (!timer.available()) return; // nothing to wait for; Caps::fallbacks() says so
    timer.begin();
    const graph::Texture texture(context->device(), {.size = {64, 64}, .format = graph::Format::RGBA32F},
                                 "test");
    context->device().wait(texture.handle());
    timer.end();
    std::optional<double> milliseconds;
    for (int frame = 0; frame < 1000 && !milliseconds; ++frame) {
        context->device().wait(texture.handle());
        milliseconds = timer.milliseconds();
    }
    ASSERT_TRUE(milliseconds.has_value());
    EXPECT_GE(*milliseconds, 0);
}

} // namespace
} // namespace lucent::gl
