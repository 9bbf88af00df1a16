// caustics/alone.frag: of rays that begin on water, the light of the triangles around them that are no beams.
//
// in    uFlux  [W]
// out   oFlux  [W]; a: share of the ray's cell
#include "caustics/beams.glsl"
uniform sampler2D uFlux;
layout(location = 0) out vec4 oFlux;

// 1 where a triangle lies on the sheet and is no beam.
float lies(ivec2 square, int triangle, ivec2 grid) {
    bool isThere = all(greaterThanEqual(square, ivec2(0))) && all(lessThan(square, grid - 1));
    return isThere ? isAlone(square, triangle, grid) : 0.0;
}

void main() {
    ivec2 ray = ivec2(gl_FragCoord.xy);
    ivec2 grid = textureSize(uFlux, 0);
    float share = (lies(ray, 0, grid) + lies(ray - ivec2(1, 0), 0, grid) + lies(ray - ivec2(1, 0), 1, grid) +
                   lies(ray - ivec2(0, 1), 0, grid) + lies(ray - ivec2(0, 1), 1, grid) + lies(ray - 1, 1, grid)) / 6.0;
    vec4 flux = texelFetch(uFlux, ray, 0);
    oFlux = vec4(share * flux.rgb, flux.a > 0.0 ? share : 0.0);
}
