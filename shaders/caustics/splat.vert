// caustics/splat.vert: the rays of the grid as points on the receivers (dissertation 2007, 5.3.2).
//
// in    gl_VertexID  one a ray
//       uFlux [W]    caustics/photon.frag
// out   vFlux flat   [light.unit] of the whole point (caustics/blurred.glsl)
//       vLayer flat  of the map
#include "caustics/deposit_block.glsl"
#include "caustics/blurred.glsl"
#include "caustics/grid.glsl"
uniform sampler2D uFlux;
flat out vec4 vFlux;
flat out int vLayer;

void main() {
    ivec2 ray = ivec2(gl_VertexID % light.grid.x, gl_VertexID / light.grid.x);
    vec4 landing = texelFetch(uLanding, ray, 0);
    vFlux = vec4(0.0);
    vLayer = layerOf(landing.w);
    gl_PointSize = light.size;
    gl_Position = kAway;
    if (landing.w == 0.0 || faceOf(landing.xyz) != drawnFace()) return;
    vFlux = blurred(texelFetch(uFlux, ray, 0).rgb / light.unit, ray, landing.xyz);
    gl_Position = clipFromMap(mapCorner(vLayer) + onMap(drawnFace(), landing.xyz).xy);
}
