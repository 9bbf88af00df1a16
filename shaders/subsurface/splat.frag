// subsurface/splat.frag: light of one point that leaves the object at a place that the camera shows (dissertation 2007,
// 6.4.1, pass 3).
//
// in    uReceivers  subsurface/receivers.frag
// out   oRadiosity.rgb [W/m²]  added up
// not   light for other objects: they have other numbers
#pragma variants - OFFSET
#pragma variants - PAINTED
#include "subsurface/splat_block.glsl"
#include "subsurface/leaving.glsl"
flat in vec4 vPlace;
flat in vec3 vNormal;
flat in vec3 vFlux;
uniform sampler2D uReceivers;
layout(location = 0) out vec4 oRadiosity;

void main() {
    vec4 receiver = texelFetch(uReceivers, ivec2(gl_FragCoord.xy), 0);
    if (int(receiver.w) != splat.object + 1) discard;
    oRadiosity = vec4(vFlux * leaving(vPlace.w * (receiver.xyz - vPlace.xyz), vNormal), 1.0);
}
