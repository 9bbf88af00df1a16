// caustics/share.frag: what each ray gives to each of the triangles around it.
//
// in    uPlace, uFlux [W]  caustics/photon.frag
//       uLanding           caustics/land.frag
// out   oShare.rgb [W]  the ray's flux over the number of its triangles; a: their number, at most 6, and of the square
//                       that begins at the ray + 8 for triangle 0, + 16 for triangle 1
// model the flux of all triangles is that of all rays, at the border of the glass too; a ray without triangles keeps
//       its own
#include "caustics/grid.glsl"
#include "views/view.glsl"
layout(std140) uniform ShareBlock {
    View view;  // of the light, of what bends it
    vec2 grid;  // rays a side
    vec2 padding;
} share;
uniform sampler2D uPlace;
uniform sampler2D uFlux;
layout(location = 0) out vec4 oShare;

// Between neighbouring rays surfaces go on where their places are no further apart than so many times the rays, as on
// a surface 2 degrees from edge-on; else one lies behind the other. Chosen by eye.
const float kMostStretch = 30.0;

vec4 texelOf(sampler2D image, ivec2 ray) {
    if (any(lessThan(ray, ivec2(0))) || any(greaterThanEqual(ray, ivec2(share.grid)))) return vec4(0.0);
    return texelFetch(image, ray, 0);
}

// Receivers that are steeper against the light are two, of which one lies behind the other.
const float kMostSteep = 8.0;

// Whether two rays land on one surface.
bool isNear(vec3 a, vec3 b) {
    vec3 along = share.view.eye.w > 0.5 ? normalize(a - share.view.eye.xyz) : share.view.forward.xyz;
    float deeper = abs(dot(b - a, along));
    return deeper * deeper * (1.0 + 1.0 / (kMostSteep * kMostSteep)) <= dot(b - a, b - a) + 1e-12;
}

// Whether all three rays land on one surface and took the same way, so that light between them lands between them.
bool isBeam(ivec2 square, int triangle) {
    ivec2 rays[3];
    vec4 places[3];
    vec3 landings[3];
    float way = 0.0;
    for (int i = 0; i < 3; ++i) {
        rays[i] = cornerOf(square, triangle, i);
        vec4 landed = texelOf(uLanding, rays[i]);
        if (landed.w == 0.0 || (i > 0 && landed.w != way)) return false;
        way = landed.w;
        landings[i] = landed.xyz;
        places[i] = texelOf(uPlace, rays[i]);
    }
    float depth = dot(places[0].xyz - share.view.eye.xyz, share.view.forward.xyz);
    float apart = length(share.view.right.xyz) * share.view.size.x / share.grid.x *
                  (share.view.eye.w > 0.5 ? depth : 1.0) * kMostStretch;
    return distance(places[0], places[1]) < apart && distance(places[0], places[2]) < apart &&
           distance(places[1], places[2]) < apart && isNear(landings[0], landings[1]) &&
           isNear(landings[0], landings[2]) && isNear(landings[1], landings[2]);
}

void main() {
    ivec2 ray = ivec2(gl_FragCoord.xy);
    oShare = vec4(0.0);
    int count = 0;
    for (int corner = 0; corner < 3; ++corner)
        for (int triangle = 0; triangle < 2; ++triangle)
            if (isBeam(ray - cornerOf(ivec2(0), triangle, corner), triangle)) ++count;
    int here = (isBeam(ray, 0) ? 8 : 0) + (isBeam(ray, 1) ? 16 : 0);
    vec3 flux = texelFetch(uLanding, ray, 0).w == 0.0 ? vec3(0.0) : texelFetch(uFlux, ray, 0).rgb;
    oShare = vec4(flux / float(max(count, 1)), float(count + here));
}
