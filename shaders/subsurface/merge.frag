// subsurface/merge.frag: four blocks of points as one.
//
// in    uPlace, uFlux, uNormal  the finer level (subsurface/points.glsl)
// out   the coarser level
// model a block is as wide as its pixels are apart, along the view and across: where surfaces lie behind each other
//       in one block it is wide and is not used, as where the surface is steep. PAINTED: nor where M_d differs
#pragma variants - PAINTED
layout(std140) uniform MergeBlock {
    float width; // of a coarse block across the view [m], of a perspective view a metre deep
    int perspective;
} level;
uniform sampler2D uPlace;
uniform sampler2D uFlux;
uniform sampler2D uNormal;
#ifdef PAINTED
uniform sampler2D uSharpness;
#endif
#include "subsurface/points.glsl"

#ifdef PAINTED
// Within a tenth, the mean of M² R(M r) over M is that of the mean M but for 0.4 %, in the middle and far out.
const float kAlike = 1.1;
#endif

void main() {
    ivec2 last = textureSize(uPlace, 0) - 1;
    vec3 first = vec3(0.0);
    vec3 place = vec3(0.0);
    vec3 flux = vec3(0.0);
    vec3 normal = vec3(0.0);
    vec2 depths = vec2(kNowhere, -kNowhere);
    float sum = 0.0;
#ifdef PAINTED
    float firstSharpness = 0.0;
    float sharpness = 0.0;
    vec2 range = vec2(kNowhere, 0.0);
    bool differs = false;
#endif
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = 2 * ivec2(gl_FragCoord.xy) + ivec2(i & 1, i >> 1);
        if (any(greaterThan(texel, last))) continue;
        vec4 fineFlux = texelFetch(uFlux, texel, 0);
        float weight = fineFlux.r + fineFlux.g + fineFlux.b;
        if (weight <= 0.0) continue;
        vec4 finePlace = texelFetch(uPlace, texel, 0);
        if (sum == 0.0) first = finePlace.xyz; // means of differences keep more digits
        place += weight * (finePlace.xyz - first);
        normal += weight * texelFetch(uNormal, texel, 0).xyz;
        flux += fineFlux.rgb;
        depths = vec2(min(depths.x, finePlace.w), max(depths.y, fineFlux.w));
#ifdef PAINTED
        float fine = texelFetch(uSharpness, texel, 0).r;
        if (sum == 0.0) firstSharpness = fine;
        sharpness += weight * (fine - firstSharpness);
        range = vec2(min(range.x, fine), max(range.y, fine));
        if (texelFetch(uNormal, texel, 0).w == kNowhere) differs = true;
#endif
        sum += weight;
    }
    noPoint();
    if (sum == 0.0) return;
    float width = level.width * (level.perspective != 0 ? depths.x : 1.0);
    float size = length(normal);
    oPlace = vec4(first + place / sum, depths.x);
    oFlux = vec4(flux, depths.y);
    oNormal = vec4(size > 0.0 ? normal / size : vec3(0.0), length(vec2(width, depths.y - depths.x)));
#ifdef PAINTED
    oSharpness = firstSharpness + sharpness / sum;
    oNormal.w = differs || range.y > kAlike * range.x ? kNowhere : oNormal.w * oSharpness;
#endif
}
