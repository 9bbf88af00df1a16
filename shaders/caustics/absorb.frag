// caustics/absorb.frag: what water leaves of the light of rays that land in it.
//
// in    uPlace, uFlux, uLanding  of the rays: where they entered, with what, where they landed
// out   oFlux    as uFlux
layout(std140) uniform SoakBlock {
    vec4 absorption; // 1/m
} water;
uniform sampler2D uPlace;
uniform sampler2D uFlux;
uniform sampler2D uLanding;
layout(location = 0) out vec4 oFlux;

void main() {
    ivec2 ray = ivec2(gl_FragCoord.xy);
    oFlux = texelFetch(uFlux, ray, 0);
    vec4 landing = texelFetch(uLanding, ray, 0);
    vec3 left = vec3(1.0);
    if (landing.w > 0.0) left = exp(-water.absorption.rgb * distance(landing.xyz, texelFetch(uPlace, ray, 0).xyz));
    oFlux.rgb *= left;
}
