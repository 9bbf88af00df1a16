// caustics/alone.frag: of rays that begin on water, the light of the triangles around them that are no beams.
//
// in    uFlux [W], uLanding, uPlace   of the rays
// out   oFlux [W], oLanding, oPlace   packed (caustics/lone_cells.glsl); oFlux.a: share of the ray's cell
#include "caustics/beams.glsl"
#include "caustics/lone_cells.glsl"
uniform sampler2D uFlux;
uniform sampler2D uLanding;
uniform sampler2D uPlace;
layout(location = 0) out vec4 oFlux;
layout(location = 1) out vec4 oLanding;
layout(location = 2) out vec4 oPlace;

// 1 where a triangle lies on the sheet and is no beam.
float lies(ivec2 square, int triangle, ivec2 grid) {
    bool isThere = all(greaterThanEqual(square, ivec2(0))) && all(lessThan(square, grid - 1));
    return isThere ? isAlone(square, triangle, grid) : 0.0;
}

void main() {
    ivec2 place = ivec2(gl_FragCoord.xy);
    ivec2 grid = textureSize(uFlux, 0);
    oFlux = oLanding = oPlace = vec4(0.0);
    if (place.y * grid.x + place.x >= loneCells()) return;
    ivec2 ray = packedAt(place);
    float share = (lies(ray, 0, grid) + lies(ray - ivec2(1, 0), 0, grid) + lies(ray - ivec2(1, 0), 1, grid) +
                   lies(ray - ivec2(0, 1), 0, grid) + lies(ray - ivec2(0, 1), 1, grid) + lies(ray - 1, 1, grid)) / 6.0;
    vec4 flux = texelFetch(uFlux, ray, 0);
    oFlux = vec4(share * flux.rgb, flux.a > 0.0 ? share : 0.0);
    oLanding = texelFetch(uLanding, ray, 0);
    oPlace = texelFetch(uPlace, ray, 0);
}
