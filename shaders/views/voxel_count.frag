// views/voxel_count.frag: how many surfaces of a pixel the bits tell apart.
//
// out   oCount  x: surfaces; y: those in bytes where two or more lay in one slice; z: such bytes; w: of them saturated
#pragma variants SLICES=256 SLICES=512
#pragma variants - GLOBAL_BOUNDS
#include "views/voxels.glsl"
layout(location = 0) out vec4 oCount;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec4 sum = ivec4(0);
    for (int byte = 0; byte < kBytes; ++byte) {
        int count = countIn(countsOf(pixel, byte >> 3), byte);
        if (count == 0) continue;
        int set = setBits(bitsOf(pixel, byte));
        sum += ivec4(count, set == count ? 0 : count, set == count ? 0 : 1, set > count ? 1 : 0);
    }
    oCount = vec4(sum);
}
