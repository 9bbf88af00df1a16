// throughput/seen.vert: the triangles of a baked object in a view.
//
// in    uTriangles  three texels each: places of their corners, object's space times its scale [m] | number of the
//                   vertex
//       uCharts     the same: places in the atlas [texels]
//       uVertices   PLACES: [W/m²] that leave at the vertices of far light
// out   vPlace [texels], and with PLACES vPosition [m], object's space, and vFar [W/m²]
#pragma variants - PLACES
#include "throughput/vector.glsl"
layout(std140) uniform SeenBlock {
    mat4 clipFromBody;
} seen;
uniform sampler2D uTriangles;
uniform sampler2D uCharts;
out vec2 vPlace;
#ifdef PLACES
uniform sampler2D uVertices;
out vec3 vPosition;
out vec3 vFar;
#endif

void main() {
    ivec2 at = inList(gl_VertexID);
    vec4 corner = texelFetch(uTriangles, at, 0);
    vPlace = texelFetch(uCharts, at, 0).xy;
#ifdef PLACES
    vPosition = corner.xyz;
    vFar = texelFetch(uVertices, inVector(int(corner.w)), 0).rgb;
#endif
    gl_Position = seen.clipFromBody * vec4(corner.xyz, 1.0);
}
