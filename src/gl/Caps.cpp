#include "gl/Caps.h"

#include "gl/Gl.h"

#ifdef __EMSCRIPTEN__
#include <emscripten/html5_webgl.h>
#endif

#include <algorithm>
#include <cstring>

namespace lucent::gl {

namespace {

#ifdef __EMSCRIPTEN__
constexpr GLenum kUnmaskedVendor = 0x9245;   // UNMASKED_VENDOR_WEBGL
constexpr GLenum kUnmaskedRenderer = 0x9246; // UNMASKED_RENDERER_WEBGL
#endif

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

// Whether a texture of this format can be drawn into. The extensions' names promise it for all 16-bit
// formats; drivers are asked all the same.
bool completes(GLenum internalFormat) {
    GLuint texture = 0, framebuffer = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexStorage2D(GL_TEXTURE_2D, 1, internalFormat, 1, 1);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    const bool complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(1, &texture);
    return complete;
}

} // namespace

Caps Caps::probe(std::span<const std::string_view> without) {
    const auto has = [without](const char* extension) {
        const std::string_view name(extension + 3); // "GL_"
        return std::find(without.begin(), without.end(), name) == without.end() && enable(extension);
    };
    Caps caps;
    caps.vendor = getString(GL_VENDOR);
    caps.renderer = getString(GL_RENDERER);
    caps.version = getString(GL_VERSION);
#ifdef __EMSCRIPTEN__
    if (enable("GL_WEBGL_debug_renderer_info")) { // else some browsers name themselves instead
        caps.vendor = getString(kUnmaskedVendor);
        caps.renderer = getString(kUnmaskedRenderer);
    }
#endif
    caps.maxTextureSize = getInteger(GL_MAX_TEXTURE_SIZE);
    caps.maxArrayLayers = getInteger(GL_MAX_ARRAY_TEXTURE_LAYERS);
    caps.maxDrawBuffers = getInteger(GL_MAX_DRAW_BUFFERS);
    caps.maxVertexTextureUnits = getInteger(GL_MAX_VERTEX_TEXTURE_IMAGE_UNITS);
    GLfloat points[2] = {1, 1};
    glGetFloatv(GL_ALIASED_POINT_SIZE_RANGE, points);
    caps.maxPointSize = points[1];
    GLint range[2] = {}, bits = 0;
    glGetShaderPrecisionFormat(GL_FRAGMENT_SHADER, GL_HIGH_FLOAT, range, &bits);
    caps.fragmentBits = bits;
    caps.colorBufferFloat = has("GL_EXT_color_buffer_float");
    caps.halfBlend = completes(GL_R16F) && completes(GL_RGBA16F);
    caps.floatBlend = has("GL_EXT_float_blend");
    caps.floatLinear = has("GL_OES_texture_float_linear");
#ifdef __EMSCRIPTEN__
    caps.timerQuery = has("GL_EXT_disjoint_timer_query_webgl2");
#else
    caps.timerQuery = has("GL_EXT_disjoint_timer_query");
#endif
    caps.parallelCompile = has("GL_KHR_parallel_shader_compile");
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
           flag("halfBlend", halfBlend) + flag("floatLinear", floatLinear) + flag("timerQuery", timerQuery) +
           flag("parallelCompile", parallelCompile) + flag("software", software) +
           "\"fragmentBits\": " + std::to_string(fragmentBits) +
           ", \"maxTextureSize\": " + std::to_string(maxTextureSize) +
           ", \"maxArrayLayers\": " + std::to_string(maxArrayLayers) +
           ", \"maxDrawBuffers\": " + std::to_string(maxDrawBuffers) +
           ", \"maxVertexTextureUnits\": " + std::to_string(maxVertexTextureUnits) +
           ", \"maxPointSize\": " + std::to_string(int(maxPointSize)) + "}";
}

} // namespace lucent::gl
