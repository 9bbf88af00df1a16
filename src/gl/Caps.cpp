#include "gl/Caps.h"

#include "gl/Gl.h"

#ifdef __EMSCRIPTEN__
#include <emscripten/html5_webgl.h>
#endif

#include <cstring>

namespace lucent::gl {

namespace {

std::string getString(GLenum name) {
    const auto* text = reinterpret_cast<const char*>(glGetString(name));
    return text ? text : "";
}

int getInteger(GLenum name) {
    GLint value = 0;
    glGetIntegerv(name, &value);
    return value;
}

// In a page an extension does nothing before it is enabled; natively it just works once it is there.
bool enable(const char* extension) {
#ifdef __EMSCRIPTEN__
    return emscripten_webgl_enable_extension(emscripten_webgl_get_current_context(), extension + 3); // "GL_"
#else
    const int count = getInteger(GL_NUM_EXTENSIONS);
    for (int i = 0; i < count; ++i)
        if (!std::strcmp(reinterpret_cast<const char*>(glGetStringi(GL_EXTENSIONS, GLuint(i))), extension))
            return true;
    return false;
#endif
}

} // namespace

Caps Caps::probe() {
    Caps caps;
    caps.vendor = getString(GL_VENDOR);
    caps.renderer = getString(GL_RENDERER);
    caps.version = getString(GL_VERSION);
    caps.maxTextureSize = getInteger(GL_MAX_TEXTURE_SIZE);
    caps.maxDrawBuffers = getInteger(GL_MAX_DRAW_BUFFERS);
    caps.colorBufferFloat = enable("GL_EXT_color_buffer_float");
    caps.floatBlend = enable("GL_EXT_float_blend");
    caps.floatLinear = enable("GL_OES_texture_float_linear");
#ifdef __EMSCRIPTEN__
    caps.timerQuery = enable("GL_EXT_disjoint_timer_query_webgl2");
#else
    caps.timerQuery = enable("GL_EXT_disjoint_timer_query");
#endif
    caps.software = caps.renderer.find("llvmpipe") != std::string::npos ||
                    caps.renderer.find("SwiftShader") != std::string::npos ||
                    caps.renderer.find("WebKit WebGL") != std::string::npos; // masked: assume nothing good
    return caps;
}

std::vector<std::string> Caps::fallbacks() const {
    std::vector<std::string> lines;
    if (!timerQuery)
        lines.push_back(
            "caps: no timer queries (EXT_disjoint_timer_query missing); times are those of finished "
            "frames");
    if (!floatLinear)
        lines.push_back(
            "caps: cannot filter RGBA32F (OES_texture_float_linear missing); maps are filtered in "
            "the shader, to the same values");
    return lines;
}

std::string Caps::json() const {
    const auto text = [](const char* key, const std::string& value) {
        std::string escaped;
        for (char c : value) {
            if (c == '"' || c == '\\') escaped += '\\';
            escaped += c;
        }
        return std::string("\"") + key + "\": \"" + escaped + "\", ";
    };
    const auto flag = [](const char* key, bool value) {
        return std::string("\"") + key + "\": " + (value ? "true" : "false") + ", ";
    };
    return "{" + text("vendor", vendor) + text("renderer", renderer) + text("version", version) +
           flag("colorBufferFloat", colorBufferFloat) + flag("floatBlend", floatBlend) +
           flag("floatLinear", floatLinear) + flag("timerQuery", timerQuery) + flag("software", software) +
           "\"maxTextureSize\": " + std::to_string(maxTextureSize) +
           ", \"maxDrawBuffers\": " + std::to_string(maxDrawBuffers) + "}";
}

} // namespace lucent::gl
