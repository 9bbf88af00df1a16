// relief/project.frag: four coefficients of the transfer for each texel of a tile, from d in the sensed directions.
//
// in    uTraced        d (relief/trace.frag)
// out   oCoefficients  of d = sum_k coefficient_k basis_k(direction)
const int kSensors = 512; // directions traced for every texel

layout(std140) uniform ProjectBlock {
    vec4 fit[kSensors];  // for each sensed direction its part in the four
    ivec4 tile;     // where the tile lies in the target: x, y; its width and height
} project;
uniform sampler2D uTraced;
layout(location = 0) out vec4 oCoefficients;

void main() {
    ivec2 local = ivec2(gl_FragCoord.xy) - project.tile.xy;
    vec4 sum = vec4(0.0);
    for (int j = 0; j < 128; ++j) {
        vec4 d = texelFetch(uTraced, local + ivec2(j % 16, j / 16) * project.tile.zw, 0);
        sum += d.x * project.fit[4 * j] + d.y * project.fit[4 * j + 1] + d.z * project.fit[4 * j + 2] +
               d.w * project.fit[4 * j + 3];
    }
    oCoefficients = sum;
}
