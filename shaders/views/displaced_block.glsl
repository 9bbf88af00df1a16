#include "lib/quadratic.glsl"
#include "views/field.glsl"
layout(std140) uniform DisplacedBlock {
    mat4 clipFromObject;
    mat4 objectFromPixel; // from (pixel - size / 2, clip z, 1)
    mat4 normalFromObject; // rotation part
    vec4 depthFromObject; // metres along the view to a place of object space
    vec4 cut; // object space, a plane: what lies below it is not shown
    vec4 eye; // object space: the eye with w = 1, or with w = 0 the direction in which all eye rays go
    Field field; // one tile of heights with one texel more on each side
    vec2 size; // of the picture in pixels
    vec2 corner; // of the picture in the target, pixels
    vec2 depths; // nearest and farthest, m
    vec2 span; // of heights that rays are looked at, m: a little below the surface, and above the highest
    int object;
    int method; // as scene::DisplacementMethod counts
    int searchSteps;
    int refineSteps;
    int isClosed; // 0: seen from below the surface is a flat floor
    float normalScale; // of textures, this and the rest
    vec4 wraps; // as in views/mesh_block.glsl
} displaced;
