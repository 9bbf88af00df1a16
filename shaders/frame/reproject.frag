// frame/reproject.frag: the colours of frame/reproject.vert.
//
// in    uPicture  linear values | coverage
// out   oPicture  the same; ENVIRONMENT: where there is nothing, what is there already
#pragma variants - ENVIRONMENT
#include "frame/reproject_block.glsl"
uniform sampler2D uPicture;
in vec2 vPixel;
flat in float vNearest;
flat in vec2 vBehind;
layout(location = 0) out vec4 oPicture;

vec4 pictureAt(vec2 pixel) {
    return texelFetch(uPicture, clamp(ivec2(floor(pixel)), ivec2(0), textureSize(uPicture, 0) - 1), 0);
}

// Between the middles of four pixels.
vec4 smoothedAt(vec2 pixel) {
    vec2 corner = floor(pixel - 0.5) + 0.5, part = pixel - corner;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        vec2 step = vec2(i & 1, i >> 1), share = mix(1.0 - part, part, step);
        vec4 value = pictureAt(corner + step);
        sum += share.x * share.y * vec4(value.rgb * value.a, value.a);
    }
    return vec4(sum.rgb / max(sum.a, 1e-6), sum.a);
}

void main() {
    bool isBefore = vNearest > 0.0;
    if (isBefore && isApart(vNearest, depthAt(vPixel))) discard;
    vec2 pixel = vBehind.x < 0.0 ? vPixel : vBehind;
#ifdef ENVIRONMENT
    if (depthAt(pixel) == nothingDepth()) discard;
#endif
    oPicture = isBefore || vBehind.x >= 0.0 ? pictureAt(pixel) : smoothedAt(pixel); // beside an outline others stand
}
