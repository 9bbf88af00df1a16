// caustics/beam.vert: the triangles of the grid, carried to the receivers.
//
// in    gl_VertexID    three a triangle; USE_BEHIND: first all for what the light sees, then all for what lies behind
//       uBeams, uFlux  caustics/beams.frag, caustics/photon.frag
//       uDensity       caustics/density.frag
// out   vFlux          [light.unit] of a texel (caustics/blurred.glsl)
//       vLayer flat    of the map
//       vDepth         USE_BEHIND: of the light's view [m]
//       vMixed flat    USE_BEHIND: 1 where not all of the triangle is in one layer
#include "caustics/deposit_block.glsl"
#include "caustics/blurred.glsl"
#include "caustics/grid.glsl"
uniform sampler2D uFlux;
uniform sampler2D uBeams;
uniform sampler2D uDensity;
out vec4 vFlux;
flat out int vLayer;
#ifdef USE_BEHIND
out float vDepth;
flat out int vMixed;
#endif

// Whether a triangle reaches behind the face's eye: it is wider than the face.
bool reachesBehind(ivec2 square, int triangle) {
    bool reaches = false;
#ifdef SEVERAL_VIEWS
    for (int corner = 0; corner < 3; ++corner)
        reaches = reaches || onMap(drawnFace(), texelFetch(uLanding, cornerOf(square, triangle, corner), 0).xyz).z <= 0.0;
#endif
    return reaches;
}

void main() {
    int number = gl_VertexID / 3;
    int columns = light.grid.x - 1;
    vLayer = 0;
#ifdef USE_BEHIND
    int count = 2 * columns * (light.grid.y - 1);
    vLayer = number / count;
    number -= vLayer * count;
    vDepth = 0.0;
    vMixed = 0;
#endif
    ivec2 square = ivec2((number >> 1) % columns, (number >> 1) / columns);
    int triangle = number & 1;
    vFlux = vec4(0.0);
    gl_Position = kAway;
    vec4 both = texelFetch(uBeams, square, 0);
    vec2 spread = triangle == 0 ? both.xy : both.zw;
    if (spread.x == 0.0 || spread.y == 1.0 || reachesBehind(square, triangle)) return;
    ivec2 ray = cornerOf(square, triangle, gl_VertexID % 3);
    vec4 landing = texelFetch(uLanding, ray, 0);
#ifdef USE_BEHIND
    int behind = 0; // corners of it
    for (int corner = 0; corner < 3; ++corner)
        behind += layerOf(texelFetch(uLanding, cornerOf(square, triangle, corner), 0).w);
    if (behind == (vLayer == 0 ? 3 : 0)) return;
    vMixed = behind == 0 || behind == 3 ? 0 : 1;
    vDepth = onMap(drawnFace(), landing.xyz).z;
#endif
    vec3 flux = (1.0 - spread.y) * texelFetch(uDensity, ray, 0).rgb;
    if (spread.x < 0.0) flux = triangleFlux(uFlux, square, triangle) / (light.unit * -spread.x);
    vFlux = blurred(flux, ray, landing.xyz);
    gl_Position = clipFromMap(mapCorner(vLayer) + onMap(drawnFace(), landing.xyz).xy);
}
