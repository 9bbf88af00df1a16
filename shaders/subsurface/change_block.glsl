// subsurface/change_block.glsl: how light is compared with that of the picture before.
layout(std140) uniform ChangeBlock {
    int side;   // of a square
    float unit; // [W/m²] of uNow
} change;
