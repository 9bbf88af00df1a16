// caustics/beam.frag: light that one triangle of the grid leaves on a texel of the map; drawn with addition, so that
// folded sheets of light add up.
#pragma variants - PARABOLOIDS ONE_VIEW
#pragma variants - SEVERAL_VIEWS
#include "caustics/deposit_block.glsl"
in vec3 vFlux;
flat in int vLayer;
layout(location = 0) out vec4 oFlux;

void main() {
    if (isBesideFace(gl_FragCoord.xy, vLayer)) discard;
    oFlux = vec4(vFlux, 1.0);
}
