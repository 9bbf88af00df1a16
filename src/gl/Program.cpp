#include "gl/Program.h"

#include "gl/Gl.h"
#include "shaders/Shaders.h"

#include <algorithm>
#include <cctype>

namespace lucent::gl {

namespace {

// Everything that stands above the first line of our own source.
std::string preamble(const std::vector<std::string>& defines) {
    std::string text = "#version 300 es\n"
                       "precision highp float;\n"
                       "precision highp int;\n"
                       "precision highp sampler2D;\n"
                       "precision highp usampler2D;\n"
                       "precision highp sampler2DArray;\n"
                       "precision highp usampler2DArray;\n";
    for (const std::string& define : defines)
        text += "#define " + define + "\n";
    return text;
}

int lineCount(const std::string& text) { return int(std::count(text.begin(), text.end(), '\n')); }

std::string infoLog(GLuint object, bool isShader) {
    GLint length = 0;
    isShader ? glGetShaderiv(object, GL_INFO_LOG_LENGTH, &length)
             : glGetProgramiv(object, GL_INFO_LOG_LENGTH, &length);
    std::string log(std::size_t(std::max(length, 1)), '\0');
    isShader ? glGetShaderInfoLog(object, length, nullptr, log.data())
             : glGetProgramInfoLog(object, length, nullptr, log.data());
    while (!log.empty() && (log.back() == '\0' || log.back() == '\n'))
        log.pop_back();
    return log;
}

Result<GLuint> compile(GLenum type, const shaders::Stage& stage, const std::vector<std::string>& defines) {
    const std::string head = preamble(defines);
    std::string source = head;
    for (int i = 0; i < stage.pieceCount; ++i)
        source += stage.pieces[i]->source;
    const char* text = source.c_str();
    const GLuint shader = glCreateShader(type);
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint compiled = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
    if (compiled) return shader;
    const std::string log = translateLog(infoLog(shader, true), stage.path, lineCount(head) + 1);
    glDeleteShader(shader);
    return Error{log.empty() ? std::string(stage.path) + ": does not compile; the driver says nothing" : log,
                 Fault::Machine};
}

const shaders::Stage* findStage(const std::string& stem, const char* ending) {
    return shaders::find(stem + ending);
}

// What a sampler of this type reads; 0: no sampler that we know.
GLenum textureTarget(GLenum type) {
    switch (type) {
    case GL_SAMPLER_2D:
    case GL_UNSIGNED_INT_SAMPLER_2D:
        return GL_TEXTURE_2D;
    case GL_SAMPLER_2D_ARRAY:
    case GL_UNSIGNED_INT_SAMPLER_2D_ARRAY:
        return GL_TEXTURE_2D_ARRAY;
    default:
        return 0;
    }
}

} // namespace

namespace {

// "relief/light.frag:12" for a line of a stage's source, counted from 0; "" behind its end.
std::string placeOf(const shaders::Stage& stage, int line) {
    for (int i = 0; i < stage.pieceCount; ++i) {
        const shaders::Piece& piece = *stage.pieces[i];
        const int lines = lineCount(piece.source);
        if (line < lines) return std::string(piece.file) + ":" + std::to_string(piece.line + line);
        line -= lines;
    }
    return "";
}

} // namespace

std::string translateLog(const std::string& log, const std::string& stagePath, int firstSourceLine) {
    const shaders::Stage* stage = shaders::find(stagePath);
    std::string out;
    for (std::size_t at = 0; at < log.size();) {
        const std::size_t lineEnd = std::min(log.find('\n', at), log.size());
        std::string line = log.substr(at, lineEnd - at);
        at = lineEnd + 1;
        // llvmpipe: "0:41(7): error: ..."; ANGLE: "ERROR: 0:41: ..."
        const std::size_t mark = line.find("0:");
        std::size_t end = mark + 2;
        int number = 0;
        while (mark != std::string::npos && end < line.size() && std::isdigit((unsigned char)line[end]))
            number = number * 10 + (line[end++] - '0');
        const int index = number - firstSourceLine;
        const bool known = stage && mark != std::string::npos && index >= 0;
        if (const std::string place = known ? placeOf(*stage, index) : ""; !place.empty()) {
            if (end < line.size() && line[end] == '(') end = line.find(')', end) + 1;
            line = place + line.substr(end);
        }
        out += (out.empty() ? "" : "\n") + line;
    }
    return out;
}

Result<Program> Program::build(const std::string& stem, const std::vector<std::string>& defines) {
    const shaders::Stage* vertexStage = findStage(stem, ".vert");
    if (!vertexStage) vertexStage = findStage("lib/screen", ".vert");
    const shaders::Stage* fragmentStage = findStage(stem, ".frag");
    assert(vertexStage && fragmentStage && "no such shader in shaders/");
    return link(stem, *vertexStage, *fragmentStage, defines);
}

Result<Program> Program::link(const std::string& name, const shaders::Stage& vertexStage,
                              const shaders::Stage& fragmentStage, const std::vector<std::string>& defines) {
    Result<GLuint> vertex = compile(GL_VERTEX_SHADER, vertexStage, defines);
    if (!vertex) return vertex.error();
    Result<GLuint> fragment = compile(GL_FRAGMENT_SHADER, fragmentStage, defines);
    if (!fragment) {
        glDeleteShader(*vertex);
        return fragment.error();
    }
    Program program;
    program.stem_ = name;
    program.id_ = glCreateProgram();
    glAttachShader(program.id_, *vertex);
    glAttachShader(program.id_, *fragment);
    glLinkProgram(program.id_);
    glDeleteShader(*vertex);
    glDeleteShader(*fragment);
    GLint linked = 0;
    glGetProgramiv(program.id_, GL_LINK_STATUS, &linked);
    if (!linked) return Error{name + ": does not link: " + infoLog(program.id_, false), Fault::Machine};
    program.bindSamplers();
    return program;
}

Program::Program(Program&& other) noexcept
    : id_(std::exchange(other.id_, 0)), stem_(std::move(other.stem_)), samplers_(std::move(other.samplers_)),
      checked_(other.checked_) {}

Program::~Program() {
    if (id_) glDeleteProgram(id_);
}

void Program::bindSamplers() {
    glUseProgram(id_);
    GLint count = 0;
    glGetProgramiv(id_, GL_ACTIVE_UNIFORMS, &count);
    for (GLint i = 0; i < count; ++i) {
        char uniform[128];
        GLint size = 0;
        GLenum type = 0;
        glGetActiveUniform(id_, GLuint(i), sizeof uniform, nullptr, &size, &type, uniform);
        const GLenum target = textureTarget(type);
        if (!target) continue;
        glUniform1i(glGetUniformLocation(id_, uniform), int(samplers_.size()));
        samplers_.push_back({uniform, target});
    }
    glUseProgram(0);
}

Status Program::checkBlock(const graph::BlockLayout& layout) const {
    if (checked_ == &layout) return Done{};
    const std::string blockName(layout.name);
    const std::string where = stem_ + ": block " + blockName + ": ";
    const GLuint block = glGetUniformBlockIndex(id_, blockName.c_str());
    if (block == GL_INVALID_INDEX) return Error{where + "not in the shader", Fault::Machine};
    glUniformBlockBinding(id_, block, 0);
    for (const auto& member : layout.members) {
        const std::string name = blockName + "." + std::string(member.name);
        const char* text = name.c_str();
        GLuint index = GL_INVALID_INDEX;
        glGetUniformIndices(id_, 1, &text, &index);
        if (index == GL_INVALID_INDEX) continue; // the compiler dropped what this variant does not use
        GLint offset = 0;
        glGetActiveUniformsiv(id_, 1, &index, GL_UNIFORM_OFFSET, &offset);
        if (std::size_t(offset) == member.offset) continue;
        return Error{where + std::string(member.name) + " at offset " + std::to_string(offset) +
                         " in GLSL, " + std::to_string(member.offset) + " in C++",
                     Fault::Machine};
    }
    GLint size = 0;
    glGetActiveUniformBlockiv(id_, block, GL_UNIFORM_BLOCK_DATA_SIZE, &size);
    if (std::size_t(size) > layout.size)
        return Error{where + std::to_string(size) + " bytes in GLSL, " + std::to_string(layout.size) +
                         " in C++",
                     Fault::Machine};
    checked_ = &layout;
    return Done{};
}

} // namespace lucent::gl
