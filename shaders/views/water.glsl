// views/water.glsl: a sheet of water, a texel a crossing of its grid's lines.
//
// state x [m]    height above the mean
//       y [m/s]  how fast it rises, half a step earlier
layout(std140) uniform WaterBlock {
    vec4 sine;     // xy: radians for each metre along x and z; z: amplitude, m; w: radians for each second
    vec4 drop;     // xy: where, m along x and z; z: radius, m; w: depth, m
    vec2 size;     // m along x and z
    vec2 cell;     // m
    float step;    // s
    float damping; // 1/s
    float speed;   // m/s
    float rest;    // s since the last step
    ivec2 squares; // of the mesh that is drawn
} water;

vec2 placeOf(ivec2 texel) { return vec2(texel) * water.cell - 0.5 * water.size; }
