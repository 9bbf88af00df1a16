// views/ranges.frag: nearest and farthest depths of two surfaces behind each other in blocks of 4 x 4 pixels.
//
// in    views/layers.glsl: uLayers; WITH_SOLID: uSolid
// out   oRanges  xy of the first one, zw of the next; 1e30, -1e30 where the block has none
#pragma variants - WITH_SOLID
#include "views/view.glsl"
#include "views/layer_texel.glsl"
layout(std140) uniform RangesBlock {
    View view;
    ivec2 size; // of the picture
    int first;  // layer; WITH_SOLID: -1, what is opaque
    int count;  // of layers
} picture;
uniform sampler2DArray uLayers;
#ifdef WITH_SOLID
uniform sampler2D uSolid;
#endif
layout(location = 0) out vec4 oRanges;

// By how much a surface's depth differs between the middle and the corner of a pixel. A surface seen edge-on ends
// before that: at most so many pixels deep.
const float kDeepest = 16.0;
float depthWithin(ivec2 pixel, float depth, vec3 n) {
    bool perspective = picture.view.eye.w > 0.5;
    float scale = perspective ? depth : 1.0;
    vec3 ray = placeFrom(picture.view, vec2(pixel) + 0.5, 1.0);
    float facing = abs(dot(n, perspective ? ray : picture.view.forward.xyz));
    float across = 0.5 * scale * (abs(dot(n, picture.view.right.xyz)) + abs(dot(n, picture.view.up.xyz)));
    float deepest = kDeepest * scale * length(picture.view.right.xyz);
    return across > deepest * facing ? deepest : across / facing;
}

void widen(inout vec2 range, ivec2 pixel, float depth, vec3 n) {
    float within = depthWithin(pixel, depth, n);
    range = vec2(min(range.x, depth - within), max(range.y, depth + within));
}

void includeLayer(inout vec2 range, ivec2 pixel, int layer) {
    if (layer >= picture.count) return;
    vec4 texel = texelFetch(uLayers, ivec3(pixel, layer), 0);
    if (texel.w > 0.0) widen(range, pixel, texel.x, normalOf(texel));
}

void main() {
    vec2 first = vec2(1e30, -1e30), next = first;
    for (int i = 0; i < 16; ++i) {
        ivec2 pixel = 4 * ivec2(gl_FragCoord.xy) + ivec2(i & 3, i >> 2);
        if (any(greaterThanEqual(pixel, picture.size))) continue;
#ifdef WITH_SOLID
        vec4 solid = texelFetch(uSolid, pixel, 0);
        if (solid.a > 0.0) widen(first, pixel, solid.x, fromOctahedral(solid.yz));
#else
        includeLayer(first, pixel, picture.first);
#endif
        includeLayer(next, pixel, picture.first + 1);
    }
    oRanges = vec4(first, next);
}
