// caustics/splat.vert: the rays of the grid as points on the receivers (dissertation 2007, 5.3.2).
//
// in    gl_VertexID  one a ray
//       uShare       caustics/share.frag
// out   vFlux flat   [light.unit] of the whole point
// model LONE: only those that no triangle carries
#include "caustics/deposit_block.glsl"
#include "caustics/grid.glsl"
uniform sampler2D uShare;
flat out vec3 vFlux;

void main() {
    ivec2 ray = ivec2(gl_VertexID % light.grid.x, gl_VertexID / light.grid.x);
    vec4 landing = texelFetch(uLanding, ray, 0);
    vec4 share = texelFetch(uShare, ray, 0);
    gl_PointSize = light.size;
    gl_Position = kAway;
    int triangles = int(share.a) & 7;
    vFlux = share.rgb * float(max(triangles, 1)) / light.unit;
    if (landing.w == 0.0 || faceOf(landing.xyz) != light.face) return;
#ifdef LONE
    if (triangles > 0) return;
#endif
    gl_Position = clipFromMap(onMap(landing.xyz).xy);
}
