// caustics/point.vert: light of triangles too small to be drawn, as points where rays of the grid land.
//
// in    gl_VertexID   one a ray
//       uPoint        caustics/density.frag
// out   vFlux flat    [light.unit] of the whole point (caustics/blurred.glsl)
//       vMiddle flat  [texels] of the whole map
//       vLayer flat   of the map
#include "caustics/deposit_block.glsl"
#include "caustics/blurred.glsl"
#include "caustics/grid.glsl"
#include "caustics/tent.glsl"
uniform sampler2D uPoint;
flat out vec4 vFlux;
flat out vec2 vMiddle;
flat out int vLayer;

void main() {
    ivec2 ray = ivec2(gl_VertexID % light.grid.x, gl_VertexID / light.grid.x);
    vec4 landing = texelFetch(uLanding, ray, 0);
    vec3 flux = texelFetch(uPoint, ray, 0).rgb;
    vFlux = vec4(0.0);
    vMiddle = vec2(0.0);
    vLayer = layerOf(landing.w);
    gl_PointSize = kTentSize;
    gl_Position = kAway;
    if (landing.w == 0.0 || flux == vec3(0.0) || faceOf(landing.xyz) != drawnFace()) return;
    vFlux = blurred(flux, ray, landing.xyz);
    vMiddle = mapCorner(vLayer) + onMap(drawnFace(), landing.xyz).xy;
    gl_Position = clipFromMap(tentMiddle(vMiddle));
}
