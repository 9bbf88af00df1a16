#pragma once
/// What this GPU can do. Kept apart are things that others conflate: rendering to float, blending into 32-bit
/// float, filtering 32-bit float.

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lucent::gl {

struct Caps {
    std::string vendor, renderer, version;
    int maxTextureSize = 0;
    int maxArrayLayers = 0;
    int maxDrawBuffers = 0;
    int maxVertexTextureUnits = 0;
    float maxPointSize = 1;        ///< in pixels
    int fragmentBits = 0;          ///< of the mantissa of highp floats in fragment shaders; 23: 32-bit floats
    bool colorBufferFloat = false; ///< EXT_color_buffer_float: draw into 16- and 32-bit floats
    bool halfBlend = false;        ///< R16F and RGBA16F make complete targets; such targets also blend
    bool floatBlend = false;       ///< EXT_float_blend: blend into 32-bit floats
    bool floatLinear = false;      ///< OES_texture_float_linear: filter 32-bit floats
    bool timerQuery = false;       ///< EXT_disjoint_timer_query
    bool parallelCompile = false;  ///< KHR_parallel_shader_compile: tells without a wait what is compiled
    bool software = false;         ///< llvmpipe or SwiftShader: timer queries time submission only

    /// Asks the current context. On the web this also enables the extensions.
    ///
    /// @param without  extensions ("EXT_float_blend") to do without where the device has them: how the ways
    ///                 around them are tested
    static Caps probe(std::span<const std::string_view> without = {});
    /// What is missing and what it costs, one line each, "caps: ..."; empty on a full machine.
    std::vector<std::string> fallbacks() const;
    /// JSON object of the fields above.
    std::string json() const;
};

} // namespace lucent::gl
