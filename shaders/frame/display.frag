// frame/display.frag: from summed light to what is shown, or to the linear values of an output file.
//
// in    uSum     see relief/light.frag, views/geometry.frag; COMPOSED: refract/refract.frag, whose a is the coverage
// out   oColor   LINEAR: values | coverage; else exposure, clamp and sRGB curve, premultiplied by the coverage
#pragma variants - LINEAR
#pragma variants - COMPOSED
#ifndef COMPOSED
#include "views/surface_pixel.glsl"
#endif
#include "frame/shown.glsl"
layout(std140) uniform DisplayBlock {
    vec4 scale;  // the value is scale * sum + shift, before the exposure
    vec4 shift;
    int isScalar; // show the sum's alpha channel as grey
    int encode;   // apply the sRGB curve: for light, not for normals or counts
    int isHeat;   // show the binary logarithm of the brightest channel, scaled and shifted, in false colours
} display;
uniform sampler2D uSum;
layout(location = 0) out vec4 oColor;

void main() {
    vec4 sum = texelFetch(uSum, ivec2(gl_FragCoord.xy), 0);
    vec3 value = display.isScalar != 0 ? vec3(sum.a) : sum.rgb;
#ifdef COMPOSED
    float coverage = sum.a;
#else
    SurfacePixel pixel = readSurface();
    float coverage = pixel.object < 0 ? 0.0 : pixel.coverage;
#endif
#ifdef LINEAR
    oColor = coverage > 0.0 ? vec4(value * display.scale.rgb + display.shift.rgb, coverage) : vec4(0.0);
#else
    vec3 color =
        shownColor(value, display.scale.rgb, display.shift.rgb, display.encode != 0, display.isHeat != 0);
    oColor = vec4(color * coverage, coverage);
#endif
}
