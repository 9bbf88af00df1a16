// subsurface/peel.frag: the nearest surface of one object behind the layer before (depth peeling, Everitt 2001).
//
// in    uBefore   the layer before; PEEL_FIRST: none
// out   oSurface  see views/surface_pixel.glsl, but with outward normals; face kOtherFace where views along the other
//                 axes show the surface so much better that they alone count it
//       oPaint    PAINTED: what enters, of views/paint.glsl
#pragma variants - PEEL_FIRST
#pragma variants - PAINTED
#include "views/mesh_block.glsl"
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
#include "subsurface/share.glsl"
in vec3 vNormal;
in float vDepth;
#ifndef PEEL_FIRST
uniform sampler2D uBefore;
#endif
layout(location = 0) out vec4 oSurface;
#ifdef PAINTED
#include "views/paint.glsl"
layout(location = 1) out vec4 oPaint;
#endif

void main() {
#ifndef PEEL_FIRST
    vec4 before = texelFetch(uBefore, ivec2(gl_FragCoord.xy), 0);
    if (before.w == 0.0 || vDepth <= before.z) discard;
#endif
    vec3 normal = normalize(vNormal);
    int face = shareOf(mesh.view, normal) < kLeastShare ? kOtherFace : kMeshFace;
    oSurface = vec4(octahedralFrom(normal), vDepth, packSurface(mesh.object, face, 1.0));
#ifdef PAINTED
    oPaint = paintEntering();
#endif
    gl_FragDepth = bufferDepth(mesh.view, vDepth);
}
