#include "lib/quadratic.glsl"
#include "views/field.glsl"
layout(std140) uniform SurfaceBlock {
    mat4 clipFromObject;
    mat4 objectFromPixel; // from (pixel - size / 2, clip z, 1)
    vec4 depthFromObject; // metres along the view to a place of object space
    vec4 cut; // object space, a plane: what lies below it is not shown
    vec4 eye; // object space: the eye with w = 1, or with w = 0 the direction in which all eye rays go
    Field field;
    vec2 size; // of the picture in pixels
    int object;
    int hasAlpha;
    vec2 corner; // of the picture in the target, pixels
    vec2 depths; // nearest and farthest, m
} surface;
