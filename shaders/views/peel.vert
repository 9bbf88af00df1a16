// views/peel.vert: the corners of one refractive mesh's triangles (views/triangles.glsl).
//
// out   vDepth    [m]  along the view's forward
//       vTriangle flat: its number. Flat values come from a triangle's last corner, which is its own
//       vOutward  flat: its normal, packed
#include "views/mesh_block.glsl"
#include "views/triangle_links.glsl"
uniform sampler2D uCorners;
out float vDepth;
flat out float vTriangle;
flat out float vOutward;

void main() {
    int corner = mesh.firstCorner + gl_VertexID;
    vec4 place = texelFetch(uCorners, tableTexel(corner), 0);
    vDepth = dot(place.xyz - mesh.view.eye.xyz, mesh.view.forward.xyz);
    vTriangle = float(corner);
    vOutward = place.w;
    gl_Position = mesh.clipFromWorld * vec4(place.xyz, 1.0);
}
