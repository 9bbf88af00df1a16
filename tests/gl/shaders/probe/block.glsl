// All that std140 spaces out (tests/gl/blocks_test.cpp).
#include "other/parts.glsl"

struct Whole {
    float first;
    Part part; // begins a row
};

layout(std140) uniform ProbeBlock {
    float head;
    vec3 afterGap; // begins a row
    float besideVec3, pair;
    vec2 two;
    float numbers[3]; // a row each
    int count;
    mat3 columns; // a row each
    mat2 small;
    vec2 places[2];
    Whole whole;
    Part parts[kParts];
    ivec2 last;
} probe;
