// subsurface/change.frag: by how much light has changed over squares of pixels since the picture before.
//
// in    uPlaces   subsurface/receivers.frag, of each pixel
//       uNow      [unit] that leaves
//       uCarried  subsurface/carried.frag
// out   oChange   rgb: mean over the pixels that show one object, the first one met [W/m²]; a: 1 + object, 0: none
#include "subsurface/change_block.glsl"
uniform sampler2D uPlaces;
uniform sampler2D uNow;
uniform sampler2D uCarried;
layout(location = 0) out vec4 oChange;

void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * change.side;
    ivec2 last = textureSize(uPlaces, 0) - 1;
    vec4 sum = vec4(0.0);
    oChange = vec4(0.0);
    for (int i = 0; i < change.side * change.side; ++i) {
        ivec2 pixel = corner + ivec2(i % change.side, i / change.side);
        if (any(greaterThan(pixel, last))) continue;
        vec4 carried = texelFetch(uCarried, pixel, 0);
        if (carried.a == 0.0) continue;
        float object = texelFetch(uPlaces, pixel, 0).w;
        if (oChange.a == 0.0) oChange.a = object;
        if (object != oChange.a) continue;
        sum += vec4(change.unit * texelFetch(uNow, pixel, 0).rgb - carried.rgb, 1.0);
    }
    if (sum.a > 0.0) oChange.rgb = sum.rgb / sum.a;
}
