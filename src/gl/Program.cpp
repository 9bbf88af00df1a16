#include "gl/Program.h"

#include "gl/Gl.h"
#include "gl/Variants.h"
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

GLuint compileStage(GLenum type, const shaders::Stage& stage, std::string source) {
    for (int i = 0; i < stage.pieceCount; ++i)
        source += stage.pieces[i]->source;
    const char* text = source.c_str();
    const GLuint shader = glCreateShader(type);
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    return shader;
}

const shaders::Stage& vertexStage(const std::string& stem) {
    const shaders::Stage* own = shaders::find(stem + ".vert");
    return own ? *own : *shaders::find("lib/screen.vert");
}

const shaders::Stage& fragmentStage(const std::string& stem) {
    const shaders::Stage* stage = shaders::find(stem + ".frag");
    assert(stage && "no such shader in shaders/");
    return *stage;
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

Program::Program(const std::string& stem, const std::vector<std::string>& defines)
    : Program(stem, vertexStage(stem), fragmentStage(stem), defines) {
    if (isVariant(fragmentStage(stem).variants, defines)) return;
    std::string asked = stem + ": its #pragma variants do not allow";
    for (const std::string& define : defines)
        asked += " " + define;
    status_ = Error{asked + (defines.empty() ? " to leave all switches out" : ""), Fault::Machine};
}

Program::Program(const std::string& name, const shaders::Stage& vertex, const shaders::Stage& fragment,
                 const std::vector<std::string>& defines)
    : name_(name), preamble_(preamble(defines)), sources_{vertex, fragment} {}

Program::~Program() {
    deleteStages();
    glDeleteProgram(id_);
}

void Program::compile() const {
    if (isBegun()) return;
    id_ = glCreateProgram();
    stages_ = {compileStage(GL_VERTEX_SHADER, sources_[0], preamble_),
               compileStage(GL_FRAGMENT_SHADER, sources_[1], preamble_)};
    for (const unsigned stage : stages_)
        glAttachShader(id_, stage);
    glLinkProgram(id_);
}

bool Program::isCompiling() const {
    if (status_) return false;
    constexpr GLenum kCompletionStatus = 0x91B1; // COMPLETION_STATUS_KHR
    GLint complete = 0;
    glGetProgramiv(id_, kCompletionStatus, &complete);
    return !complete;
}

const Status& Program::ready() const {
    if (status_) return *status_;
    compile();
    GLint linked = 0;
    glGetProgramiv(id_, GL_LINK_STATUS, &linked);
    status_ = linked ? Status(Done{}) : Error{log(), Fault::Machine};
    deleteStages();
    if (linked) {
        bindSamplers();
        bindBlocks();
    }
    return *status_;
}

// Why it does not link: most often because a stage does not compile.
std::string Program::log() const {
    for (std::size_t i = 0; i < stages_.size(); ++i) {
        GLint compiled = 0;
        glGetShaderiv(stages_[i], GL_COMPILE_STATUS, &compiled);
        if (compiled) continue;
        const std::string path = sources_[i].path;
        const std::string text = translateLog(infoLog(stages_[i], true), path, lineCount(preamble_) + 1);
        return text.empty() ? path + ": does not compile; the driver says nothing" : text;
    }
    return name_ + ": does not link: " + infoLog(id_, false);
}

void Program::deleteStages() const {
    for (const unsigned stage : stages_)
        glDeleteShader(stage);
    stages_.clear();
}

void Program::bindSamplers() const {
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

// Asked here and not when something is drawn: a browser then waits for all that was drawn before.
void Program::bindBlocks() const {
    GLint count = 0;
    glGetProgramiv(id_, GL_ACTIVE_UNIFORM_BLOCKS, &count);
    for (GLuint i = 0; i < GLuint(count); ++i) {
        char block[128];
        GLint size = 0;
        glGetActiveUniformBlockName(id_, i, sizeof block, nullptr, block);
        glGetActiveUniformBlockiv(id_, i, GL_UNIFORM_BLOCK_DATA_SIZE, &size);
        glUniformBlockBinding(id_, i, 0);
        blocks_.push_back({block, std::size_t(size)});
    }
}

Status Program::checkBlock(const graph::Block& block) const {
    const auto found = std::find_if(blocks_.begin(), blocks_.end(),
                                    [&](const BlockSize& known) { return known.name == block.name; });
    if (found != blocks_.end() && found->bytes <= block.bytes.size()) return Done{};
    const std::string where = name_ + ": block " + std::string(block.name) + ": ";
    if (found == blocks_.end()) return Error{where + "not in the shader", Fault::Machine};
    return Error{where + std::to_string(found->bytes) + " bytes in GLSL, " +
                     std::to_string(block.bytes.size()) + " in C++",
                 Fault::Machine};
}

} // namespace lucent::gl
