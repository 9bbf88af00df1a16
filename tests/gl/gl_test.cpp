// The GL layer on a real driver.
#include "gl/Context.h"
#include "gl/Timer.h"
#include "shaders/Shaders.h"
#include "tests/support/Gl.h"

#include <cstring>

namespace lucent::gl {
namespace {

using Gl = support::GlTest;

TEST_F(Gl, EveryShaderCompilesInEveryVariant) {
    const std::vector<std::pair<std::string, std::vector<std::string>>> programs = {
        {"views/surface", {}},
        {"views/geometry", {"SHOW_NORMAL"}},
        {"views/geometry", {"SHOW_POSITION"}},
        {"views/geometry", {"SHOW_DEPTH"}},
        {"relief/light", {}},
        {"relief/light", {"METHOD_MARCH", "SHOW_VISIBILITY"}},
        {"relief/light", {"METHOD_COUNTING", "SHOW_ITERATIONS"}},
        {"relief/light", {"USE_BASE_MAP", "USE_DIFFUSE_MAP", "USE_SPECULAR_MAP"}},
        {"frame/display", {}},
        {"frame/display", {"LINEAR"}}};
    for (const auto& [stem, defines] : programs) {
        const Status& ready = context->program(stem, defines)->ready();
        EXPECT_TRUE(ready.ok()) << (ready.ok() ? "" : ready.error().message);
    }
}

TEST_F(Gl, AProgramIsCompiledOnceForEachSetOfSwitches) {
    const Program* first = context->program("frame/display", {"LINEAR"});
    EXPECT_EQ(first, context->program("frame/display", {"LINEAR"}));
    EXPECT_NE(first, context->program("frame/display", {}));
}

TEST_F(Gl, ShaderErrorsNameOurFileAndLine) {
    // A switch that breaks a line of an include: the message must name the include, not the joined source.
    const Program broken("frame/display", {"srgbFromLinear 1bad"});
    const Status& status = broken.ready();
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.error().message.find("lib/shading.glsl:"), std::string::npos) << status.error().message;
    EXPECT_EQ(status.error().fault, Fault::Machine);
}

TEST_F(Gl, AProgramThatDoesNotCompileSaysSoWhenItDraws) {
    const Program broken("frame/display", {"srgbFromLinear 1bad"});
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
