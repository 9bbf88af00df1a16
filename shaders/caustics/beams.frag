// caustics/beams.frag: which triangles between rays carry the light between them, and how they are drawn.
//
// in    uPlace, uFlux  caustics/photon.frag, VERTICES
//       uLanding       caustics/land.frag
// out   oBeams  of both triangles of the square that begins at the ray: its area on the map in texels, or below 0 their
//               number, over which its flux is spread; 0 where it is no beam; the share of its flux that points get
// model flux over area (beams after Watt 1990), so that triangles that lie side by side are evenly bright. Of small ones
//       a few hold texels' middles and most do not: part of their flux, at last all of it, is drawn as points. Thin
//       ones, as at folds, which lie on each other rather than side by side: flux over the number of texels that they
//       cover, so that it is kept; those that cover none are points. The light of triangles that are no beams is carried
//       by rays of their own
#pragma variants - PARABOLOIDS ONE_VIEW
#pragma variants - REFINE
#include "caustics/deposit_block.glsl"
#include "caustics/grid.glsl"
#include "caustics/sixths.glsl"
uniform sampler2D uPlace;
uniform sampler2D uFlux;
layout(location = 0) out vec4 oBeams;

// Between neighbouring rays surfaces go on where their places are no further apart than so many times the rays, as on
// a surface 2 degrees from edge-on; else one lies behind the other. Chosen by eye.
const float kMostStretch = 30.0;

// Rays that part by more than so many times what they would without glass bend so differently that light between them
// does not land evenly between them: finer rays carry it. Chosen such that the total light of a glass ball on a floor
// is the same to a percent from 32 rays a side on.
const float kMostSpread = 8.0;

// Unless they part evenly, as off a mirror: the next ones go on by a step that differs by no more than this part of it.
// Chosen by eye.
const float kMostBend = 0.25;

const float kMostCounted = 16.0; // texels a side of the box around a thin triangle
const float kThin = 0.5;         // texels across a thin triangle, and ...
const float kLong = 2.0;         // ... along it
const vec2 kSmall = vec2(0.25, 1.0); // texels, of what is all and not at all points
const float kLeastArea = 1e-6;          // texels: what is a beam has more than 0

float crossOf(vec2 u, vec2 v) { return u.x * v.y - u.y * v.x; }

// How many texels a triangle covers.
float covered(vec2 a, vec2 b, vec2 c, vec2 low, vec2 size) {
    float side = sign(crossOf(b - a, c - a));
    float count = 0.0;
    for (float y = 0.0; y < size.y; ++y)
        for (float x = 0.0; x < size.x; ++x) {
            vec2 p = low + vec2(x, y);
            vec3 inside = side * vec3(crossOf(b - a, p - a), crossOf(c - b, p - b), crossOf(a - c, p - c));
            if (all(greaterThan(inside, vec3(0.0)))) ++count;
        }
    return count;
}

// What oBeams holds of a triangle.
vec2 spreadOf(vec2 a, vec2 b, vec2 c) {
    float area = 0.5 * abs(crossOf(b - a, c - a));
    float longest = max(dot(b - a, b - a), max(dot(c - b, c - b), dot(a - c, a - c)));
    vec2 low = ceil(min(a, min(b, c)) - 0.5) + 0.5; // the lowest texel's middle
    vec2 size = floor(max(a, max(b, c)) - low) + 1.0;
    bool thin = longest > kLong * kLong && 4.0 * area * area < kThin * kThin * longest;
    if (!thin || max(size.x, size.y) > kMostCounted)
        return vec2(max(area, kLeastArea), clamp((kSmall.y - area) / (kSmall.y - kSmall.x), 0.0, 1.0));
    float count = covered(a, b, c, low, size);
    return count == 0.0 ? vec2(kLeastArea, 1.0) : vec2(-count, 0.0);
}

// Where a ray of the same way lands, on a receiver behind another one or not; w 0: there is none.
vec4 landingLike(ivec2 ray, float way) {
    if (any(lessThan(ray, ivec2(0))) || any(greaterThanEqual(ray, light.grid))) return vec4(0.0);
    vec4 landing = texelFetch(uLanding, ray, 0);
    return wayOf(landing.w) == wayOf(way) ? landing : vec4(0.0);
}

// Whether rays part evenly before two neighbours and behind them.
bool partEvenly(ivec2 ray, ivec2 next, vec4 a, vec4 b) {
    vec4 before = landingLike(2 * ray - next, a.w);
    vec4 after = landingLike(2 * next - ray, a.w);
    if (before.w == 0.0 || after.w == 0.0) return false;
    float most = kMostBend * distance(a.xyz, b.xyz);
    return distance(before.xyz + b.xyz, 2.0 * a.xyz) <= most && distance(a.xyz + after.xyz, 2.0 * b.xyz) <= most;
}

// Whether all three rays land on one surface and took the same way, so that light between them lands between them. In
// a part of it another receiver may hide it from the light, as a pool's wall hides the edge of its floor.
bool isBeam(ivec2 square, int triangle, vec4 places[3], vec4 landings[3]) {
    View face = light.faces[0]; // all look from the same point
    bool perspective = face.eye.w > 0.5;
    vec3 along = perspective ? normalize(landings[0].xyz - face.eye.xyz) : face.forward.xyz;
    float depth = perspective ? distance(places[0].xyz, face.eye.xyz) : 1.0;
    float reach = perspective ? distance(landings[0].xyz, face.eye.xyz) : 1.0; // where rays lie so far apart unbent
    for (int i = 0; i < 3; ++i) {
        int next = (i + 1) % 3;
        if (wayOf(landings[i].w) != wayOf(landings[0].w) || !isNear(landings[i].xyz, landings[next].xyz, along)) return false;
        if (distance(places[i].xyz, places[next].xyz) >= kMostStretch * light.size * depth) return false;
#ifdef REFINE
        bool isWide = distance(landings[i].xyz, landings[next].xyz) >= kMostSpread * light.size * reach;
        ivec2 ray = cornerOf(square, triangle, i);
        if (isWide && !partEvenly(ray, cornerOf(square, triangle, next), landings[i], landings[next])) return false;
#endif
    }
    return true;
}

vec2 beamOf(ivec2 square, int triangle) {
    if (any(greaterThanEqual(square, light.grid - 1))) return vec2(0.0);
    vec4 places[3];
    vec4 landings[3];
    vec3 sum = vec3(0.0);
    for (int corner = 0; corner < 3; ++corner) {
        ivec2 ray = cornerOf(square, triangle, corner);
        int full = int(texelFetch(uFlux, ray, 0).a) - 1;
        landings[corner] = texelFetch(uLanding, ray, 0);
        if (full < 0 || (full & sixthOf(triangle, corner)) == 0 || landings[corner].w == 0.0) return vec2(0.0);
        places[corner] = texelFetch(uPlace, ray, 0);
        sum += landings[corner].xyz / 3.0;
    }
    if (!isBeam(square, triangle, places, landings)) return vec2(0.0);
    int face = faceOf(sum);
    vec3 a = onMap(face, landings[0].xyz);
    vec3 b = onMap(face, landings[1].xyz);
    vec3 c = onMap(face, landings[2].xyz);
    if (light.faces[face].eye.w > 0.5 && min(a.z, min(b.z, c.z)) <= 0.0) return vec2(0.0);
    return spreadOf(a.xy, b.xy, c.xy);
}

void main() {
    ivec2 square = ivec2(gl_FragCoord.xy);
    oBeams = vec4(beamOf(square, 0), beamOf(square, 1));
}
