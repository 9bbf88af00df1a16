// subsurface/steady.frag: what leaves, steadier than the points that it is summed from.
//
// in    uPlaces   subsurface/receivers.frag, of each pixel
//       uNow      [unit] that leaves by this picture's points
//       uCarried  FOLLOWS: subsurface/carried.frag
//       uChange   FOLLOWS: subsurface/change.frag
// out   oLight    [W/m²]
//       oPlaces   uPlaces, for the next picture
// model what was there, all of the change that is smooth from square to square, and a share of the rest: that is
//       mostly how the points happen to lie
#pragma variants - FOLLOWS
#include "subsurface/change_block.glsl"
uniform sampler2D uPlaces;
uniform sampler2D uNow;
#ifdef FOLLOWS
uniform sampler2D uCarried;
uniform sampler2D uChange;
#endif
layout(location = 0) out vec4 oLight;
layout(location = 1) out vec4 oPlaces;

const float kShare = 0.1; // of what changes from place to place. On a bunny 0.05 to 0.2 are as steady

#ifdef FOLLOWS
// Between the four squares around; a: 0 where none of them shows the object.
vec4 changeAt(ivec2 pixel, float object) {
    vec2 at = (vec2(pixel) + 0.5) / float(change.side) - 0.5;
    ivec2 base = ivec2(floor(at));
    ivec2 last = textureSize(uChange, 0) - 1;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 square = base + ivec2(i & 1, i >> 1);
        if (any(lessThan(square, ivec2(0))) || any(greaterThan(square, last))) continue;
        vec4 one = texelFetch(uChange, square, 0);
        if (one.a != object) continue;
        vec2 share = 1.0 - abs(vec2(square) - at);
        sum += share.x * share.y * vec4(one.rgb, 1.0);
    }
    return sum.a > 0.0 ? sum / sum.a : sum;
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    oPlaces = texelFetch(uPlaces, pixel, 0);
    oLight = vec4(change.unit * texelFetch(uNow, pixel, 0).rgb, 1.0);
#ifdef FOLLOWS
    vec4 carried = texelFetch(uCarried, pixel, 0);
    if (carried.a == 0.0) return;
    vec4 even = changeAt(pixel, oPlaces.w);
    if (even.a == 0.0) return;
    vec3 steady = max(carried.rgb + even.rgb, 0.0);
    oLight.rgb = mix(steady, oLight.rgb, kShare);
#endif
}
