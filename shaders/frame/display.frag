// frame/display.frag: from summed light to what is shown, or to the linear values of an output file.
//
// in    uSum     see relief/light.frag, views/geometry.frag; COMPOSED: refract/refract.frag, whose a is the coverage;
//                SCALED: a preview of fewer pixels, smoothed between them
// out   oColor   LINEAR: values | coverage; else exposure, clamp and sRGB curve, premultiplied by the coverage
#pragma variants - LINEAR
#pragma variants - COMPOSED
#pragma variants - SCALED if COMPOSED
#ifndef COMPOSED
#include "views/surface_pixel.glsl"
#endif
#include "frame/shown.glsl"
layout(std140) uniform DisplayBlock {
    vec4 scale;  // the value is scale * sum + shift, before the exposure
    vec4 shift;
    vec2 texels;  // SCALED: of the picture along each side, for a pixel
    int isScalar; // show the sum's alpha channel as grey
    int encode;   // apply the sRGB curve: for light, not for normals or counts
    int isHeat;   // show the binary logarithm of the brightest channel, scaled and shifted, in false colours
} display;
uniform sampler2D uSum;
layout(location = 0) out vec4 oColor;

vec4 shown(vec3 value, float coverage) {
    vec3 color =
        shownColor(value, display.scale.rgb, display.shift.rgb, display.encode != 0, display.isHeat != 0);
    return vec4(color * coverage, coverage);
}

#ifdef SCALED
// Between the middles of four texels as they are shown: a highlight is no brighter than white before it is spread.
void main() {
    vec2 at = gl_FragCoord.xy * display.texels - 0.5, part = fract(at);
    ivec2 corner = ivec2(floor(at)), last = textureSize(uSum, 0) - 1;
    oColor = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1);
        vec4 value = texelFetch(uSum, clamp(corner + step, ivec2(0), last), 0);
        vec2 share = mix(1.0 - part, part, vec2(step));
        if (value.a > 0.0) oColor += share.x * share.y * shown(value.rgb, value.a);
    }
}
#else
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
    oColor = shown(value, coverage);
#endif
}
#endif
