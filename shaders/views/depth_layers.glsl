// views/depth_layers.glsl: how far surfaces behind each other lie, and nothing else of them.
//
// FROM_PEEL    uLayers of views/layer_texel.glsl, which the file that includes this declares
// FROM_VOXELS  uDepths: four surfaces an image, of views/voxel_peel.frag
// FROM_BITS    the set bits of views/voxels.glsl, looked for each time
// FROM_BOUNDS  uBounds: the first and the last surface, of views/voxel_bounds.frag
#include "views/depth.glsl"
#if defined(FROM_VOXELS)
uniform sampler2DArray uDepths;
uniform sampler2DArray uBounds;
#elif defined(FROM_BITS)
#include "views/voxels.glsl"
#elif defined(FROM_BOUNDS)
uniform sampler2DArray uBounds;
#endif

// Depth [m] of a pixel's surface, 0 the nearest; kNoDepth: there are not so many.
//
// all_  nearest and farthest depth of the whole view
float depthOf(ivec2 pixel, int layer, vec2 all_) {
#if defined(FROM_PEEL)
    vec4 texel = texelFetch(uLayers, ivec3(pixel, layer), 0);
    return texel.w == 0.0 ? kNoDepth : texel.x;
#elif defined(FROM_VOXELS)
    return texelFetch(uDepths, ivec3(pixel, layer >> 2), 0)[layer & 3];
#elif defined(FROM_BITS)
    for (int eight = 0; eight < kBytes / 8; ++eight) {
        ivec4 counts = countsOf(pixel, eight);
        if (counts == ivec4(0)) continue;
        for (int byte = 8 * eight; byte < 8 * eight + 8; ++byte) {
            int count = countIn(counts, byte);
            if (layer < count)
                return depthOfSlice(8 * byte + placeIn(bitsOf(pixel, byte), count, layer), boundsAt(pixel, all_));
            layer -= count;
        }
    }
    return kNoDepth;
#else
    float depth = texelFetch(uBounds, ivec3(pixel, layer), 0).r;
    return depth == kNoDepth || layer > 0 ? depth : -depth;
#endif
}

// How many surfaces lie in a pixel, at most `most`.
int surfacesAt(ivec2 pixel, int most, vec2 all_) {
    int count = 0;
#ifdef FROM_BITS
    for (int byte = 0; byte < kBytes; ++byte) count += countIn(countsOf(pixel, byte >> 3), byte);
    return min(count, most);
#else
    while (count < most && depthOf(pixel, count, all_) != kNoDepth) ++count;
    return count;
#endif
}

// Depth of the last surface of a pixel that has `layer` at `depth`.
float lastDepthOf(ivec2 pixel, int layer, float depth) {
#ifdef FROM_PEEL
    for (++layer; layer < textureSize(uLayers, 0).z; ++layer) {
        vec4 texel = texelFetch(uLayers, ivec3(pixel, layer), 0);
        if (texel.w == 0.0) break;
        depth = texel.x;
    }
    return depth;
#else
    return texelFetch(uBounds, ivec3(pixel, 1), 0).r;
#endif
}
