#include "lib/quadratic.glsl"
#include "views/field.glsl"
layout(std140) uniform SurfaceBlock {
    mat4 clipFromObject;
    mat4 objectFromPixel; // from (pixel - size / 2, clip z, 1)
    vec4 eye; // object space: the eye with w = 1, or with w = 0 the direction in which all eye rays go
    Field field;
    vec2 size; // of the picture in pixels
    int object;
    int hasAlpha;
} surface;
