// views/shadow.frag: how far from a light the nearest surface is that stands in its way.
//
// in    uFirst  BEHIND: depths of the nearest ones; what is drawn are the nearest behind those that face the light, or
//               BACK: that are turned away from it, at which solid things end
//       uColor  HOLES: views/holes.glsl
//       CUT: without what the view's plane cuts off
// out   oDepth  [m]  along the view's forward: evenly spaced, which a depth buffer of a perspective view is not
#pragma variants - BEHIND
#pragma variants - BACK if BEHIND
#pragma variants - HOLES
#pragma variants - CUT unless BEHIND
#include "views/mesh_block.glsl"
#ifdef HOLES
#include "views/holes.glsl"
#endif
in float vDepth;
layout(location = 0) out float oDepth;
#ifdef BEHIND
uniform sampler2D uFirst;
const float kSame = 1e-5; // of a depth: what rounding may part
#endif

void main() {
#ifdef CUT
    if (isCut(mesh.view, placeFrom(mesh.view, gl_FragCoord.xy, vDepth))) discard;
#endif
#ifdef HOLES
    if (isHole(vDepth)) discard;
#endif
#ifdef BEHIND
#ifdef BACK
    bool counts = !gl_FrontFacing;
#else
    bool counts = gl_FrontFacing;
#endif
    if (!counts || vDepth <= (1.0 + kSame) * texelFetch(uFirst, ivec2(gl_FragCoord.xy), 0).r) discard;
#endif
    oDepth = vDepth;
    gl_FragDepth = bufferDepth(mesh.view, vDepth);
}
