#pragma once
/// The GL headers, for this folder only. OpenGL ES 3.0: asking EGL for 3.0 may return 3.2, this header keeps
/// us to what WebGL2 has.
#include <GLES3/gl3.h>

namespace lucent::gl {

/// Whether glGetError() and other questions are answered at once. A browser answers when another process has
/// done all commands before; an error stays until it is asked for.
#ifdef __EMSCRIPTEN__
inline constexpr bool kAnswersAtOnce = false;
#else
inline constexpr bool kAnswersAtOnce = true;
#endif

} // namespace lucent::gl
