// views/reduce.frag: nearest and farthest depth of one layer in blocks of 4 x 4.
//
// in    uFine    FROM_LAYERS: the layers themselves; FROM_SOLID: uSolid of views/layers.glsl;
//                else blocks
// out   oBlock   rg; 1e30, -1e30 where the block is empty
#include "views/view.glsl"
#include "views/layer_texel.glsl"
layout(std140) uniform ReduceBlock {
    View view;
    ivec2 size; // of the fine image
    int layer;
    int padding;
} reduction;
#ifdef FROM_SOLID
uniform sampler2D uFine;
#else
uniform sampler2DArray uFine;
#endif
layout(location = 0) out vec2 oBlock;

// By how much a surface's depth differs between the middle and the corner of a pixel. A surface seen edge-on ends
// before that: at most so many pixels deep.
const float kDeepest = 16.0;
float depthWithin(ivec2 pixel, float depth, vec3 n) {
    bool perspective = reduction.view.eye.w > 0.5;
    float scale = perspective ? depth : 1.0;
    vec3 ray = placeFrom(reduction.view, vec2(pixel) + 0.5, 1.0);
    float facing = abs(dot(n, perspective ? ray : reduction.view.forward.xyz));
    float across = 0.5 * scale * (abs(dot(n, reduction.view.right.xyz)) + abs(dot(n, reduction.view.up.xyz)));
    float deepest = kDeepest * scale * length(reduction.view.right.xyz);
    return across > deepest * facing ? deepest : across / facing;
}

void main() {
    ivec2 corner = 4 * ivec2(gl_FragCoord.xy);
    vec2 range = vec2(1e30, -1e30);
    for (int i = 0; i < 16; ++i) {
        ivec2 texel = corner + ivec2(i & 3, i >> 2);
        if (texel.x >= reduction.size.x || texel.y >= reduction.size.y) continue;
#if defined(FROM_LAYERS)
        vec4 value = texelFetch(uFine, ivec3(texel, reduction.layer), 0);
        if (value.w == 0.0) continue;
        float within = depthWithin(texel, value.x, normalOf(value));
        range = vec2(min(range.x, value.x - within), max(range.y, value.x + within));
#elif defined(FROM_SOLID)
        vec4 value = texelFetch(uFine, texel, 0);
        if (value.w == 0.0) continue;
        float within = depthWithin(texel, value.x, fromOctahedral(value.yz));
        range = vec2(min(range.x, value.x - within), max(range.y, value.x + within));
#else
        vec2 value = texelFetch(uFine, ivec3(texel, reduction.layer), 0).xy;
        range = vec2(min(range.x, value.x), max(range.y, value.y));
#endif
    }
    oBlock = range;
}
