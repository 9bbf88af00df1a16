// caustics/absorb.frag: what water leaves of the light of rays that land in it.
//
// in    uPlace, uDirection, uFlux, uLanding  of the rays: where they were last bent, into what, with what; where they
//                                            landed
// out   oFlux    as uFlux
// not   before a mirror in water
#include "views/glass_block.glsl"
layout(std140) uniform SoakBlock {
    vec4 absorption[kMostGlass]; // 1/m
} waters;
uniform sampler2D uPlace;
uniform sampler2D uDirection;
uniform sampler2D uFlux;
uniform sampler2D uLanding;
layout(location = 0) out vec4 oFlux;

void main() {
    ivec2 ray = ivec2(gl_FragCoord.xy);
    oFlux = texelFetch(uFlux, ray, 0);
    vec4 landing = texelFetch(uLanding, ray, 0);
    float medium = -1.0 - texelFetch(uDirection, ray, 0).w;
    if (landing.w == 0.0 || medium < 0.0) return;
    float way = distance(landing.xyz, texelFetch(uPlace, ray, 0).xyz);
    oFlux.rgb *= exp(-waters.absorption[int(medium)].rgb * way);
}
