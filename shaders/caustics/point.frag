// caustics/point.frag: light of one point on a texel of the map.
#pragma variants - PARABOLOIDS ONE_VIEW
#pragma variants - ON_ONE_TEXEL
#include "caustics/deposit_block.glsl"
#include "caustics/tent.glsl"
flat in vec4 vFlux;
flat in vec2 vMiddle;
flat in int vLayer;
layout(location = 0) out vec4 oFlux;

void main() {
    if (isBesideFace(gl_FragCoord.xy, vLayer)) discard;
    oFlux = vFlux * tentWeight(gl_FragCoord.xy - vMiddle);
}
