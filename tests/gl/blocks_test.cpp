// Uniform blocks as scripts/shader_blocks.py writes them lie where the driver looks for them.
#include "base/File.h"
#include "shaders/Shaders.h"
#include "shaders/probe/Blocks.h"
#include "tests/support/Gl.h"

#include <GLES3/gl3.h>

#include <regex>

namespace lucent::gl {
namespace {

struct Blocks : support::GlTest {
    const std::string source =
        std::regex_replace(text("other/parts.glsl") + text("probe/block.glsl"), std::regex("#include.*"), "");
    const shaders::Piece vertexPiece{"test.vert", 1, "void main() { gl_Position = vec4(0.0); }\n"};
    // Each member is used, so that none is dropped.
    const std::string fragment =
        source +
        "layout(location = 0) out vec4 oSum;\n"
        "void main() {\n"
        "    oSum = vec4(probe.head + probe.afterGap.x + probe.besideVec3 + probe.pair + probe.two.x);\n"
        "    oSum += vec4(probe.numbers[probe.count] + probe.columns[2].x + probe.small[1].x);\n"
        "    oSum += vec4(probe.places[1].x + probe.whole.first + probe.whole.part.corner.x);\n"
        "    oSum += vec4(probe.parts[2].size + float(probe.last.y));\n"
        "}\n";
    const shaders::Piece fragmentPiece{"test.frag", 1, fragment.c_str()};
    const shaders::Piece *const ofVertex = &vertexPiece, *const ofFragment = &fragmentPiece;

    static std::string text(const std::string& file) {
        const auto read = readFile("tests/gl/shaders/" + file);
        EXPECT_TRUE(read.ok());
        return read.ok() ? std::string(reinterpret_cast<const char*>(read->data()), read->size()) : "";
    }
    GLint ask(const Program& program, const std::string& member, GLenum question) {
        const std::string name = "ProbeBlock." + member;
        const char* asked = name.c_str();
        GLuint index = GL_INVALID_INDEX;
        glGetUniformIndices(program.id(), 1, &asked, &index);
        GLint answer = -1;
        if (index != GL_INVALID_INDEX) glGetActiveUniformsiv(program.id(), 1, &index, question, &answer);
        return answer;
    }
};

TEST_F(Blocks, MembersLieWhereTheDriverLooksForThem) {
    const Program program("probe", shaders::Stage{"test.vert", &ofVertex, 1},
                          shaders::Stage{"test.frag", &ofFragment, 1}, {});
    ASSERT_TRUE(program.ready().ok()) << program.ready().error().message;
    using Block = probe::ProbeBlock;
    const auto at = [&](const char* member) { return ask(program, member, GL_UNIFORM_OFFSET); };
    EXPECT_EQ(at("head"), GLint(offsetof(Block, head)));
    EXPECT_EQ(at("afterGap"), GLint(offsetof(Block, afterGap)));
    EXPECT_EQ(at("besideVec3"), GLint(offsetof(Block, besideVec3)));
    EXPECT_EQ(at("pair"), GLint(offsetof(Block, pair)));
    EXPECT_EQ(at("two"), GLint(offsetof(Block, two)));
    EXPECT_EQ(at("numbers[0]"), GLint(offsetof(Block, numbers)));
    EXPECT_EQ(at("count"), GLint(offsetof(Block, count)));
    EXPECT_EQ(at("columns"), GLint(offsetof(Block, columns)));
    EXPECT_EQ(at("small"), GLint(offsetof(Block, small)));
    EXPECT_EQ(at("places[0]"), GLint(offsetof(Block, places)));
    EXPECT_EQ(at("whole.first"), GLint(offsetof(Block, whole.first)));
    EXPECT_EQ(at("whole.part.corner"), GLint(offsetof(Block, whole.part.corner)));
    EXPECT_EQ(at("parts[0].place"), GLint(offsetof(Block, parts)));
    EXPECT_EQ(at("parts[2].size"), GLint(offsetof(Block, parts) + 2 * sizeof(other::PartBlock) +
                                         offsetof(other::PartBlock, size)));
    EXPECT_EQ(at("last"), GLint(offsetof(Block, last)));
    EXPECT_TRUE(program.checkBlock(Block{}).ok());
}

TEST_F(Blocks, WhatIsSpacedOutTakesAVec4Each) {
    const Program program("probe", shaders::Stage{"test.vert", &ofVertex, 1},
                          shaders::Stage{"test.frag", &ofFragment, 1}, {});
    ASSERT_TRUE(program.ready().ok()) << program.ready().error().message;
    EXPECT_EQ(ask(program, "numbers[0]", GL_UNIFORM_ARRAY_STRIDE), GLint(sizeof(vec4)));
    EXPECT_EQ(ask(program, "places[0]", GL_UNIFORM_ARRAY_STRIDE), GLint(sizeof(vec4)));
    EXPECT_EQ(ask(program, "columns", GL_UNIFORM_MATRIX_STRIDE), GLint(sizeof(vec4)));
    const probe::ProbeBlock block;
    EXPECT_EQ(block.numbers.size(), 3u);
    EXPECT_EQ(block.columns.size(), 3u);
    EXPECT_EQ(block.small.size(), 2u);
    EXPECT_EQ(block.parts.size(), std::size_t(other::kParts));
}

} // namespace
} // namespace lucent::gl
