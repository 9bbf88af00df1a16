// subsurface/volume_column.frag: the surfaces of one object behind each other along an axis (depth peeling, Everitt
// 2001).
//
// in    uBefore  depth of the surface before; PEEL_FIRST: none
// out   oColumn  xy: octahedral normal, outward; z: depth [m]; w: 1 where there is a surface
//       oDone    x: the depth, y: 1, for the next surface
#pragma variants - PEEL_FIRST
#include "views/mesh_block.glsl"
#include "lib/octahedral.glsl"
in vec3 vNormal;
in float vDepth;
#ifndef PEEL_FIRST
uniform sampler2D uBefore;
#endif
layout(location = 0) out vec4 oColumn;
layout(location = 1) out vec2 oDone;

void main() {
#ifndef PEEL_FIRST
    vec2 before = texelFetch(uBefore, ivec2(gl_FragCoord.xy), 0).xy;
    if (before.y == 0.0 || vDepth <= before.x) discard;
#endif
    oColumn = vec4(octahedralFrom(normalize(vNormal)), vDepth, 1.0);
    oDone = vec2(vDepth, 1.0);
    gl_FragDepth = bufferDepth(mesh.view, vDepth);
}
