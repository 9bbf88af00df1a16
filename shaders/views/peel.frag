// views/peel.frag: the nearest surface behind the layer before (depth peeling, Everitt 2001).
//
// in    uBefore  depth and code of the layer before; PEEL_FIRST: none
// out   oLayer   views/layer_texel.glsl
//       oDone    its depth and code, for the next layer: an array that is drawn into cannot be read
// model surfaces in one place are told apart by their codes, so that touching objects keep both faces
#pragma variants - PEEL_FIRST
#pragma variants - CUT
#include "views/mesh_block.glsl"
#include "views/layer_texel.glsl"
in float vDepth;
flat in vec2 vTriangle;
#ifndef PEEL_FIRST
uniform sampler2D uBefore;
#endif
layout(location = 0) out vec4 oLayer;
layout(location = 1) out vec2 oDone;

void main() {
#ifdef CUT
    if (isCut(mesh.view, placeFrom(mesh.view, gl_FragCoord.xy, vDepth))) discard;
#endif
    vec4 texel = vec4(vDepth, vTriangle, float(2 * mesh.object + (gl_FrontFacing ? 1 : 2)));
#ifndef PEEL_FIRST
    vec2 before = texelFetch(uBefore, ivec2(gl_FragCoord.xy), 0).xy;
    if (before.y == 0.0 || vDepth < before.x || (vDepth == before.x && texel.w <= before.y)) discard;
#endif
    oLayer = texel;
    oDone = texel.xw;
    gl_FragDepth = bufferDepth(mesh.view, vDepth);
}
