// views/deepest.frag: the farthest depth of each layer, by blocks of 4 x 4 (thesis 2008, 3.7).
//
// in    FROM_...   depths (views/depth_layers.glsl); else uFine: what this pass left before
// out   oDeepest   four layers a texel. Each four have an image of their own, four of which stand beside each other, so
//                  that one pass reduces them all
#pragma variants FROM_FINE FROM_PEEL FROM_VOXELS FROM_BITS FROM_BOUNDS
#pragma variants SLICES=256 SLICES=512 if FROM_BITS
#pragma variants - GLOBAL_BOUNDS if FROM_BITS
#include "views/depth.glsl"
#include "views/layer_texel.glsl"
#include "views/voxel_block.glsl"
#ifdef FROM_FINE
uniform sampler2D uFine;
#else
#ifdef FROM_PEEL
uniform sampler2DArray uLayers;
#endif
#include "views/depth_layers.glsl"
#endif
layout(location = 0) out vec4 oDeepest;

vec4 depthsOf(ivec2 group, ivec2 pixel) {
#ifdef FROM_FINE
    return texelFetch(uFine, group * voxels.size + pixel, 0);
#else
    vec4 depths = vec4(kNoDepth);
    int first = 4 * (group.x + 4 * group.y);
    for (int i = 0; i < 4 && first + i < voxels.count; ++i) depths[i] = depthOf(pixel, first + i, voxels.bounds);
    return depths;
#endif
}

void main() {
    ivec2 place = ivec2(gl_FragCoord.xy);
    ivec2 group = place / voxels.blocks;
    ivec2 corner = 4 * (place - group * voxels.blocks);
    vec4 deepest = vec4(kNoDepth);
    for (int i = 0; i < 16; ++i) {
        ivec2 pixel = corner + ivec2(i & 3, i >> 2);
        if (pixel.x < voxels.size.x && pixel.y < voxels.size.y) deepest = max(deepest, depthsOf(group, pixel));
    }
    oDeepest = deepest;
}
