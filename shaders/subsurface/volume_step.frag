// subsurface/volume_step.frag: one round of Chebyshev's iteration for the fluence in all cells.
//
// in    uCell    subsurface/volume_cells.frag
//       uSource  subsurface/volume_source.frag
//       uNow     fluence [W/m²]; STEP_FIRST: none, all is dark
//       uBefore  that of the round before; STEP_SECOND: dark
// out   oFluence
// model -div(D grad phi) + sigma_a phi = Q; every cell gives each neighbour inside D/width times their difference
#include "subsurface/volume.glsl"
uniform sampler2D uCell;
uniform sampler2D uSource;
#ifndef STEP_FIRST
uniform sampler2D uNow;
#ifndef STEP_SECOND
uniform sampler2D uBefore;
#endif
#endif
layout(location = 0) out vec4 oFluence;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 bound = texelFetch(uCell, texel, 0);
    oFluence = vec4(0.0);
    if (bound.a == 0.0) return;
    int mask = int(bound.a);
    vec3 sum = texelFetch(uSource, texel, 0).rgb;
    vec3 diagonal = bound.rgb + volume.absorption.rgb;
#ifndef STEP_FIRST
    ivec3 cell = cellAt(texel);
#endif
    for (int direction = 0; direction < 6; ++direction) {
        if (((mask >> direction) & 1) == 0) continue;
        diagonal += volume.diffusion.rgb;
#ifndef STEP_FIRST
        ivec3 neighbour = cell;
        neighbour[direction >> 1] += 2 * (direction & 1) - 1;
        sum += volume.diffusion.rgb * texelFetch(uNow, texelOf(neighbour), 0).rgb;
#endif
    }
    vec3 fluence = sum / diagonal;
#ifdef STEP_SECOND
    fluence *= volume.omega.rgb;
#elif !defined(STEP_FIRST)
    fluence = mix(texelFetch(uBefore, texel, 0).rgb, fluence, volume.omega.rgb);
#endif
    oFluence = vec4(fluence, 1.0);
}
