// frame/mean.frag: the mean over a pixel's samples, with one more.
//
// in    uShown   the picture of that sample, as in frame/display.frag
//       uMean    of those before; not there with FIRST
// out   oMean    linear Rec. 709 of what is covered; a: coverage, the mean of theirs
#pragma variants - COMPOSED
#pragma variants - FIRST
#ifndef COMPOSED
#include "views/surface_pixel.glsl"
#endif
layout(std140) uniform MeanBlock {
    float share; // of the new sample: 1 over the number of all
} mean;
uniform sampler2D uShown;
#ifndef FIRST
uniform sampler2D uMean;
#endif
layout(location = 0) out vec4 oMean;

// Times what it covers: nothing adds no colour.
vec4 weighed(vec4 value) { return value.a > 0.0 ? vec4(value.rgb * value.a, value.a) : vec4(0.0); }

void main() {
    vec4 shown = texelFetch(uShown, ivec2(gl_FragCoord.xy), 0);
#ifndef COMPOSED
    SurfacePixel pixel = readSurface();
    shown.a = pixel.object < 0 ? 0.0 : pixel.coverage;
#endif
    vec4 sum = weighed(shown);
#ifndef FIRST
    sum = mix(weighed(texelFetch(uMean, ivec2(gl_FragCoord.xy), 0)), sum, mean.share);
#endif
    oMean = sum.a > 0.0 ? vec4(sum.rgb / sum.a, sum.a) : vec4(0.0);
}
