// views/solid.frag: the first point of an opaque or mirroring object that is no height field.
//
// in    uFirst    SECOND: views/second.glsl
//       uColor    HOLES: views/holes.glsl
// out   oSurface  see surface_pixel.glsl; normals face the eye; SECOND: of what the first object hides
#pragma variants - SECOND
#pragma variants - CUT
#pragma variants - HOLES
#include "views/mesh_block.glsl"
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
#ifdef SECOND
#include "views/second.glsl"
#endif
#ifdef HOLES
#include "views/holes.glsl"
#endif
in vec3 vNormal;
in float vDepth;
layout(location = 0) out vec4 oSurface;

void main() {
#ifdef HOLES
    if (isHole(vDepth)) discard;
#endif
#ifdef SECOND
    if (isFirst(mesh.object)) discard;
#endif
#ifdef CUT
    if (isCut(mesh.view, placeFrom(mesh.view, gl_FragCoord.xy, vDepth))) discard;
#endif
    vec3 n = gl_FrontFacing ? vNormal : -vNormal;
    oSurface = vec4(octahedralFrom(normalize(n)), vDepth, packSurface(mesh.object, kMeshFace, 1.0));
}
