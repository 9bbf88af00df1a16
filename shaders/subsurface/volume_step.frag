// subsurface/volume_step.frag: one round of Chebyshev's iteration for the fluence in all cells.
//
// in    uLower, uUpper, uDiagonal  subsurface/volume_bind.frag
//       uSource  subsurface/volume_source.frag
//       uNow     fluence [W/m²]; STEP_FIRST: none, all is dark
//       uBefore  that of the round before; STEP_SECOND: dark
// out   oFluence
// model -div(D grad phi) + sigma_a phi = Q; through the open part of a face flows D/width times the difference
#pragma variants - STEP_FIRST STEP_SECOND
#include "subsurface/volume.glsl"
uniform sampler2D uDiagonal;
uniform sampler2D uSource;
#ifndef STEP_FIRST
uniform sampler2D uLower;
uniform sampler2D uUpper;
uniform sampler2D uNow;
#ifndef STEP_SECOND
uniform sampler2D uBefore;
#endif
#endif
layout(location = 0) out vec4 oFluence;

#ifndef STEP_FIRST
vec3 at(ivec3 cell) { return texelFetch(uNow, texelOf(cell), 0).rgb; }
#endif

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 diagonal = texelFetch(uDiagonal, texel, 0);
    oFluence = vec4(0.0);
    if (diagonal.a == 0.0) return;
    vec3 sum = texelFetch(uSource, texel, 0).rgb;
#ifndef STEP_FIRST
    ivec3 cell = cellAt(texel);
    vec3 lower = texelFetch(uLower, texel, 0).rgb;
    vec3 upper = texelFetch(uUpper, texel, 0).rgb;
    vec3 around = lower.x * at(cell - ivec3(1, 0, 0)) + upper.x * at(cell + ivec3(1, 0, 0)) +
                  lower.y * at(cell - ivec3(0, 1, 0)) + upper.y * at(cell + ivec3(0, 1, 0)) +
                  lower.z * at(cell - ivec3(0, 0, 1)) + upper.z * at(cell + ivec3(0, 0, 1));
    sum += volume.diffusion.rgb * around;
#endif
    vec3 fluence = sum / diagonal.rgb;
#ifdef STEP_SECOND
    fluence *= volume.omega.rgb;
#elif !defined(STEP_FIRST)
    fluence = mix(texelFetch(uBefore, texel, 0).rgb, fluence, volume.omega.rgb);
#endif
    oFluence = vec4(fluence, 1.0);
}
