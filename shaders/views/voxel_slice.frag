// views/voxel_slice.frag: the bit of the slice that a surface lies in, and how many lie in its byte (thesis 2008, 3.3).
//
// in    uBounds     views/voxel_bounds.frag; GLOBAL_BOUNDS: the view's near and far depth stand for it
// out   oTarget0..  images FIRST, FIRST + 1 .. of views/voxels.glsl, as many as TARGETS; drawn with addition
// model WebGL blends no integers and has no logic operations: bits are added. Two surfaces in one slice carry, or, in
//       the last slice of a byte, saturate it; the counts tell
#pragma variants SLICES=256 SLICES=512
#pragma variants - GLOBAL_BOUNDS
#pragma variants FIRST=0..23
#pragma variants TARGETS=1..8
#include "views/mesh_block.glsl"
#include "views/slices.glsl"
in float vDepth;
#ifndef GLOBAL_BOUNDS
uniform sampler2DArray uBounds;
#endif
layout(location = 0) out vec4 oTarget0;
#if TARGETS > 1
layout(location = 1) out vec4 oTarget1;
#endif
#if TARGETS > 2
layout(location = 2) out vec4 oTarget2;
#endif
#if TARGETS > 3
layout(location = 3) out vec4 oTarget3;
#endif
#if TARGETS > 4
layout(location = 4) out vec4 oTarget4;
#endif
#if TARGETS > 5
layout(location = 5) out vec4 oTarget5;
#endif
#if TARGETS > 6
layout(location = 6) out vec4 oTarget6;
#endif
#if TARGETS > 7
layout(location = 7) out vec4 oTarget7;
#endif

vec4 inChannel(int channel, int value) {
    return float(value) / 255.0 * vec4(equal(ivec4(0, 1, 2, 3), ivec4(channel)));
}

// What the surface adds to an image: 32 slices are one of bits, 64 one of counts.
vec4 addedTo(int image, int slice) {
    if (image < SLICES / 32) return slice >> 5 == image ? inChannel((slice >> 3) & 3, 1 << (slice & 7)) : vec4(0.0);
    return slice >> 6 == image - SLICES / 32 ? inChannel((slice >> 4) & 3, (slice & 8) == 0 ? 1 : 16) : vec4(0.0);
}

void main() {
#ifdef GLOBAL_BOUNDS
    vec2 bounds = vec2(mesh.view.right.w, mesh.view.forward.w);
#else
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 bounds = vec2(-texelFetch(uBounds, ivec3(pixel, 0), 0).r, texelFetch(uBounds, ivec3(pixel, 1), 0).r);
#endif
    int slice = sliceOf(vDepth, bounds);
    oTarget0 = addedTo(FIRST, slice);
#if TARGETS > 1
    oTarget1 = addedTo(FIRST + 1, slice);
#endif
#if TARGETS > 2
    oTarget2 = addedTo(FIRST + 2, slice);
#endif
#if TARGETS > 3
    oTarget3 = addedTo(FIRST + 3, slice);
#endif
#if TARGETS > 4
    oTarget4 = addedTo(FIRST + 4, slice);
#endif
#if TARGETS > 5
    oTarget5 = addedTo(FIRST + 5, slice);
#endif
#if TARGETS > 6
    oTarget6 = addedTo(FIRST + 6, slice);
#endif
#if TARGETS > 7
    oTarget7 = addedTo(FIRST + 7, slice);
#endif
}
