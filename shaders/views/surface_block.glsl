#include "lib/quadratic.glsl"
#include "views/field.glsl"
layout(std140) uniform SurfaceBlock {
    mat4 clipFromObject;
    vec4 eye; // object space: the eye with w = 1, or with w = 0 the direction in which all eye rays go
    Field field;
    int object;
    int hasAlpha;
} surface;
