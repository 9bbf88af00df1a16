// views/peel.vert: the corners of one refractive mesh's triangles (views/triangles.glsl).
//
// out   vDepth    [m]  along the view's forward
//       vTriangle flat: its number and its normal, packed; in one, as some drivers keep each for every triangle.
//                 Flat values come from a triangle's last corner, which is its own
#include "views/mesh_block.glsl"
#include "views/triangle_links.glsl"
uniform sampler2D uCorners;
out float vDepth;
flat out vec2 vTriangle;

void main() {
    int corner = mesh.firstCorner + gl_VertexID;
    vec4 place = texelFetch(uCorners, tableTexel(corner), 0);
    vDepth = dot(place.xyz - mesh.view.eye.xyz, mesh.view.forward.xyz);
    vTriangle = vec2(float(corner), place.w);
    gl_Position = mesh.clipFromWorld * vec4(place.xyz, 1.0);
}
