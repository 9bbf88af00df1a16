// caustics/splat.frag: light of one ray, spread by a Gaussian over its point.
//
// model weights exp(-r²/2) over the disc of radius kRadius, whose integral is 2 pi (1 - exp(-kRadius²/2))
#pragma variants - PARABOLOIDS ONE_VIEW
#include "caustics/deposit_block.glsl"
flat in vec4 vFlux;
flat in int vLayer;
layout(location = 0) out vec4 oFlux;
const float kRadius = 2.5; // standard deviations
const float kPi = 3.14159265;

void main() {
    if (isBesideFace(gl_FragCoord.xy, vLayer)) discard;
    vec2 r = kRadius * (2.0 * gl_PointCoord - 1.0);
    float square = dot(r, r);
    if (square > kRadius * kRadius) discard;
    float deviation = 0.5 * light.size / kRadius; // texels
    float whole = 2.0 * kPi * deviation * deviation * (1.0 - exp(-0.5 * kRadius * kRadius));
    oFlux = vFlux * exp(-0.5 * square) / whole;
}
