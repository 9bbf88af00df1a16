// views/voxel_peel.frag: depths of the surfaces of a pixel from its set bits (thesis 2008, 3.4.2).
//
// out   oDepths0..  depths [m] of four surfaces each, from surface 4 FIRST on, as many as TARGETS; kNoDepth behind the
//                   last one
#pragma variants SLICES=256 SLICES=512
#pragma variants - GLOBAL_BOUNDS
#pragma variants FIRST=0..7
#pragma variants TARGETS=1..8
#include "views/depth.glsl"
#include "views/voxel_block.glsl"
#include "views/voxels.glsl"
layout(location = 0) out vec4 oDepths0;
#if TARGETS > 1
layout(location = 1) out vec4 oDepths1;
#endif
#if TARGETS > 2
layout(location = 2) out vec4 oDepths2;
#endif
#if TARGETS > 3
layout(location = 3) out vec4 oDepths3;
#endif
#if TARGETS > 4
layout(location = 4) out vec4 oDepths4;
#endif
#if TARGETS > 5
layout(location = 5) out vec4 oDepths5;
#endif
#if TARGETS > 6
layout(location = 6) out vec4 oDepths6;
#endif
#if TARGETS > 7
layout(location = 7) out vec4 oDepths7;
#endif

vec4 fourOf(float depths[4 * TARGETS], int from) {
    return vec4(depths[4 * from], depths[4 * from + 1], depths[4 * from + 2], depths[4 * from + 3]);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 bounds = boundsAt(pixel, voxels.bounds);
    float depths[4 * TARGETS];
    for (int i = 0; i < 4 * TARGETS; ++i) depths[i] = kNoDepth;
    int found = -4 * FIRST; // those of images before this pass's first
    for (int eight = 0; eight < kBytes / 8 && found < 4 * TARGETS; ++eight) {
        ivec4 counts = countsOf(pixel, eight);
        if (counts == ivec4(0)) continue;
        for (int byte = 8 * eight; byte < 8 * eight + 8; ++byte) {
            int count = countIn(counts, byte);
            if (count == 0) continue;
            int bits = bitsOf(pixel, byte);
            for (int nth = 0; nth < count; ++nth, ++found)
                if (found >= 0 && found < 4 * TARGETS)
                    depths[found] = depthOfSlice(8 * byte + placeIn(bits, count, nth), bounds);
        }
    }
    oDepths0 = fourOf(depths, 0);
#if TARGETS > 1
    oDepths1 = fourOf(depths, 1);
#endif
#if TARGETS > 2
    oDepths2 = fourOf(depths, 2);
#endif
#if TARGETS > 3
    oDepths3 = fourOf(depths, 3);
#endif
#if TARGETS > 4
    oDepths4 = fourOf(depths, 4);
#endif
#if TARGETS > 5
    oDepths5 = fourOf(depths, 5);
#endif
#if TARGETS > 6
    oDepths6 = fourOf(depths, 6);
#endif
#if TARGETS > 7
    oDepths7 = fourOf(depths, 7);
#endif
}
