#pragma once
/// The GL headers, for this folder only. OpenGL ES 3.0: asking EGL for 3.0 may return 3.2, this header keeps us
/// to what WebGL2 has.
#include <GLES3/gl3.h>
