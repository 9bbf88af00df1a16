// views/solid.frag: the first point of an opaque or mirroring object that is no height field.
//
// out   oSurface  see surface_pixel.glsl; normals face the eye
#include "views/mesh_block.glsl"
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
in vec3 vNormal;
in float vDepth;
layout(location = 0) out vec4 oSurface;

void main() {
    if (isCut(mesh.view, placeFrom(mesh.view, gl_FragCoord.xy, vDepth))) discard;
    vec3 n = gl_FrontFacing ? vNormal : -vNormal;
    oSurface = vec4(octahedralFrom(normalize(n)), vDepth, packSurface(mesh.object, kMeshFace, 1.0));
}
