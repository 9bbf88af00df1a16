// caustics/spread.frag: over what the light of each ray of what no beam carries is spread on the map.
//
// in    uFlux [W]      caustics/photon.glsl, PIXELS or RESTS, packed (caustics/lone_cells.glsl)
//       uGridLanding   OF_RESTS: where the rays through the middles of cells land
// out   oSides   [texels] two sides of a parallelogram around the place where the ray lands
//       oShare   [light.unit] of a texel; a: kParallelogram; kPoint: of the whole (caustics/tent.glsl); 0: there is none
// model half the way between the neighbouring rays that landed on the same surface (photon differentials after
//       Schjoth 2007), or the whole way to one of them. Flux over the number of texels that a small one covers, of
//       large ones over their area
#pragma variants - PARABOLOIDS ONE_VIEW
#pragma variants - OF_RESTS
#include "caustics/deposit_block.glsl"
#include "caustics/grid.glsl"
#include "caustics/spread.glsl"
uniform sampler2D uFlux;
layout(location = 0) out vec4 oSides;
layout(location = 1) out vec4 oShare;
#include "caustics/lone_cells.glsl"
#ifdef OF_RESTS
uniform sampler2D uGridLanding;
#endif

const float kSmall = 2.0; // texels, of what is a point

ivec2 cell = ivec2(0); // of the ray

vec4 landingBeside(ivec2 ray, ivec2 step_) {
    ivec2 grid = textureSize(uIndex, 0);
    int side = light.grid.x / grid.x;
    ivec2 within = ray - side * (ray / side) + step_;
    if (all(greaterThanEqual(within, ivec2(0))) && all(lessThan(within, ivec2(side)))) return texelFetch(uLanding, ray + step_, 0);
    int number = numberOf(cell + step_);
    vec4 landing = vec4(0.0);
    if (number >= 0) landing = texelFetch(uLanding, side * (ivec2(number % grid.x, number / grid.x) - step_) + within, 0);
#ifdef OF_RESTS
    bool isThere = all(greaterThanEqual(cell + step_, ivec2(0))) && all(lessThan(cell + step_, grid));
    if (isThere && landing.w == 0.0) landing = texelFetch(uGridLanding, cell + step_, 0);
#endif
    return landing;
}

vec4 neighbour(ivec2 ray, ivec2 step_, vec4 landing, vec3 along) {
    vec4 other = landingBeside(ray, step_);
    return other.w == landing.w && isNear(landing.xyz, other.xyz, along) ? other : vec4(0.0);
}

// How the landing moves from ray to ray, in texels.
vec2 across(int number, ivec2 ray, ivec2 step_, vec4 landing, vec3 along) {
    vec4 before = neighbour(ray, -step_, landing, along);
    vec4 after = neighbour(ray, step_, landing, along);
    vec3 here = onMap(number, landing.xyz);
    vec3 low = before.w > 0.0 ? onMap(number, before.xyz) : here;
    vec3 high = after.w > 0.0 ? onMap(number, after.xyz) : here;
    bool perspective = light.faces[number].eye.w > 0.5;
    if (perspective && min(low.z, high.z) <= 0.0) return vec2(0.0);
    return (high.xy - low.xy) / (before.w > 0.0 && after.w > 0.0 ? 2.0 : 1.0);
}

const float kMostCounted = 8.0; // texels a side of the box around a parallelogram

// How many texels one covers.
float covered(vec2 place, vec4 inverse_, float side) {
    vec2 low = floor(place - 0.5 * side) + 0.5;
    float count = 0.0;
    for (float y = 0.0; y <= side; ++y)
        for (float x = 0.0; x <= side; ++x)
            if (isOnParallelogram(inverse_, low + vec2(x, y) - place)) ++count;
    return count;
}

void main() {
    ivec2 ray = ivec2(gl_FragCoord.xy);
    vec4 landing = texelFetch(uLanding, ray, 0);
    vec4 flux = texelFetch(uFlux, ray, 0);
    oSides = vec4(0.0);
    oShare = vec4(0.0);
    if (landing.w == 0.0 || flux.a == 0.0) return;
    int number = faceOf(landing.xyz);
    View face = light.faces[number];
    vec3 along = face.eye.w > 0.5 ? normalize(landing.xyz - face.eye.xyz) : face.forward.xyz;
    vec2 place = onMap(number, landing.xyz).xy;
    cell = packedAt(ray / (light.grid.x / textureSize(uIndex, 0).x));
    vec2 u = across(number, ray, ivec2(1, 0), landing, along);
    vec2 v = across(number, ray, ivec2(0, 1), landing, along);
#ifdef OF_RESTS
    u *= sqrt(flux.a); // the part of a cell, along each side
    v *= sqrt(flux.a);
#endif
    vec2 reach = abs(u) + abs(v);
    float shrink = min(1.0, (light.size - 1.0) / max(max(reach.x, reach.y), 1e-6));
    u *= shrink;
    v *= shrink;
    oShare = vec4(flux.rgb / light.unit, kPoint);
    float area = abs(areaOf(vec4(u, v)));
    if (area < kSmall) return;
    float side = ceil(max(reach.x, reach.y));
    float count = side <= kMostCounted ? covered(place, inverseOf(vec4(u, v)), side) : area;
    if (count == 0.0) return;
    oSides = vec4(u, v);
    oShare = vec4(flux.rgb / (light.unit * count), kParallelogram);
}
