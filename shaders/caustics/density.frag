// caustics/density.frag: what the triangles around a ray of the grid bring to where it lands.
//
// in    uBeams, uFlux  caustics/beams.frag, caustics/photon.frag
//       uDensity       SHARPEN: what this pass has found before
// out   oDensity.rgb   [light.unit] of a texel: flux of those that are drawn by their area, over that area. Between the
//                      corners it is interpolated: each triangle's light then adds up to a third of its corners'
//                      densities times its area, so that of all triangles nothing is lost, and sheets are smooth.
//                      SHARPEN: and what the triangles have beyond that, over their area. Where rays draw together, as
//                      before a focus, the mean of six triangles lies outwards of a ray; this brings the light back
//       oPoint.rgb     [light.unit] a third of the flux of those that are too small to be drawn: a point's
#pragma variants - SHARPEN
#include "caustics/deposit_block.glsl"
#include "caustics/grid.glsl"
uniform sampler2D uFlux;
uniform sampler2D uBeams;
layout(location = 0) out vec4 oDensity;
#ifdef SHARPEN
uniform sampler2D uDensity;
#else
layout(location = 1) out vec4 oPoint;
#endif

struct Around {
    vec3 flux, point;
    float area; // texels
};
Around around = Around(vec3(0.0), vec3(0.0), 0.0);

// Flux that interpolation gives a triangle.
vec3 interpolated(ivec2 square, int triangle, float area) {
    vec3 sum = vec3(0.0);
#ifdef SHARPEN
    for (int corner = 0; corner < 3; ++corner) sum += texelFetch(uDensity, cornerOf(square, triangle, corner), 0).rgb;
#endif
    return sum * area / 3.0;
}

void add(ivec2 square, int triangle) {
    if (any(lessThan(square, ivec2(0)))) return;
    vec4 both = texelFetch(uBeams, square, 0);
    vec2 spread = triangle == 0 ? both.xy : both.zw;
    if (spread.x == 0.0) return;
    vec3 flux = triangleFlux(uFlux, square, triangle) / light.unit;
    around.point += spread.y * flux / 3.0;
    if (spread.x < 0.0) return;
    around.flux += (1.0 - spread.y) * (flux - interpolated(square, triangle, spread.x));
    around.area += (1.0 - spread.y) * spread.x;
}

void main() {
    ivec2 ray = ivec2(gl_FragCoord.xy);
    add(ray, 0);
    add(ray - ivec2(1, 0), 0);
    add(ray - ivec2(1, 0), 1);
    add(ray - ivec2(0, 1), 0);
    add(ray - ivec2(0, 1), 1);
    add(ray - 1, 1);
    oDensity = vec4(around.area > 0.0 ? around.flux / around.area : vec3(0.0), 0.0);
#ifdef SHARPEN
    // Beside a shadow this would take more than there is. Some wavelengths are less than nothing of a colour.
    vec3 before = texelFetch(uDensity, ray, 0).rgb;
    oDensity.rgb = mix(oDensity.rgb + before, vec3(0.0), lessThanEqual((oDensity.rgb + before) * before, vec3(0.0)));
#else
    oPoint = vec4(around.point, 0.0);
#endif
}
