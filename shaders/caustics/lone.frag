// caustics/lone.frag: in which cells of the grid of rays some begin of their own, for light that no beam carries.
//
// in    uBeams  caustics/beams.frag
//       uFlux   caustics/photon.glsl, VERTICES
// out   oLone   1: in this one
#include "caustics/beams.glsl"
uniform sampler2D uFlux;
layout(location = 0) out float oLone;

void main() {
    ivec2 cell = ivec2(gl_FragCoord.xy);
    ivec2 grid = textureSize(uBeams, 0);
    float alone = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 square = cell - ivec2(i & 1, i >> 1);
        alone += isAlone(square, 0, grid) + isAlone(square, 1, grid);
    }
    bool isMet = texelFetch(uFlux, cell, 0).a != 0.0;
    oLone = alone > 0.0 && isMet ? 1.0 : 0.0;
}
