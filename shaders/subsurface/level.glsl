// subsurface/level.glsl: the points of one level (subsurface/points.glsl).
//
// in    uPlace, uFlux, uNormal  of the level
//       uCoarser                normals of the next coarser level
//       uSharpness              PAINTED
// model of the blocks on each other the widest is used that is narrow enough for the lattice's sum
#include "subsurface/splat_block.glsl"
uniform sampler2D uPlace;
uniform sampler2D uFlux;
uniform sampler2D uNormal;
uniform sampler2D uCoarser;
#ifdef PAINTED
uniform sampler2D uSharpness;
#endif

// What leaves at a distance r is M_d² flux R_d(M_d r); M_d² is in the flux already.
struct Point {
    vec3 place, normal, flux;
    float sharpness; // M_d
};

// Whether a point is used.
bool findPoint(int number, out Point point) {
    ivec2 texel = ivec2(number % splat.columns, number / splat.columns);
    point = Point(vec3(0.0), vec3(0.0), texelFetch(uFlux, texel, 0).rgb, 1.0);
    if (point.flux == vec3(0.0)) return false;
    vec4 normal = texelFetch(uNormal, texel, 0);
    if (splat.isFinest == 0 && normal.w > splat.widest) return false;
    if (splat.isCoarsest == 0 && texelFetch(uCoarser, texel >> 1, 0).w <= splat.widest) return false;
#ifdef PAINTED
    point.sharpness = texelFetch(uSharpness, texel, 0).r;
    if (point.sharpness <= splat.bluntest || point.sharpness > splat.sharpest) return false;
    point.flux *= point.sharpness * point.sharpness;
#endif
    point.place = texelFetch(uPlace, texel, 0).xyz;
    point.normal = normal.xyz;
    return true;
}
