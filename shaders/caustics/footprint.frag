// caustics/footprint.frag: light of one ray on a texel of its parallelogram, or of the four around it.
#pragma variants - PARABOLOIDS ONE_VIEW
#pragma variants - ON_ONE_TEXEL
#pragma variants - AS_QUADS
#include "caustics/deposit_block.glsl"
#include "caustics/spread.glsl"
#include "caustics/tent.glsl"
flat in vec4 vFlux;
flat in vec2 vMiddle;
flat in vec4 vInverse;
flat in int vLayer;
layout(location = 0) out vec4 oFlux;

void main() {
    if (isBesideFace(gl_FragCoord.xy, vLayer)) discard;
    vec2 beside = gl_FragCoord.xy - vMiddle;
    float weight = 1.0;
    if (vInverse == vec4(0.0)) weight = tentWeight(beside);
    else if (!isOnParallelogram(vInverse, beside)) discard;
    oFlux = weight * vFlux;
}
