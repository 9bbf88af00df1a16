// caustics/lines_block.glsl: rays drawn in the camera's picture.
#include "views/view.glsl"
layout(std140) uniform LinesBlock {
    View view; // of the camera
    vec4 low, high; // of a box around the receivers
    ivec2 grid; // rays a side
    float unit; // [W] that the picture of lines counts as 1
} light;
