// caustics/beam.frag: light that one triangle of the grid leaves on a texel of the map; drawn with addition, so that
// folded sheets of light add up.
//
// in    uShadow, uBehind  USE_BEHIND: as for caustics/lookup.frag. Of a triangle that lies in both layers a texel takes
//                         what falls on the surface that is nearest there: each texel of one layer
#pragma variants - PARABOLOIDS ONE_VIEW
#pragma variants - SEVERAL_VIEWS
#pragma variants - USE_BEHIND
#include "caustics/deposit_block.glsl"
in vec4 vFlux;
flat in int vLayer;
layout(location = 0) out vec4 oFlux;
#ifdef USE_BEHIND
in float vDepth;
flat in int vMixed;
uniform sampler2D uBehind;

int layerHere() {
    ivec2 texel = ivec2(gl_FragCoord.xy - mapCorner(vLayer) + mapCorner(0));
    float first = abs(texelFetch(uShadow, texel, 0).r - vDepth);
    return abs(texelFetch(uBehind, texel, 0).r - vDepth) < first ? 1 : 0;
}
#endif

void main() {
    if (isBesideFace(gl_FragCoord.xy, vLayer)) discard;
#ifdef USE_BEHIND
    if (vMixed == 1 && layerHere() != vLayer) discard;
#endif
    oFlux = vFlux;
}
