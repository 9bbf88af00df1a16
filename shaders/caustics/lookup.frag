// caustics/lookup.frag: light of the caustic map on what each pixel shows of opaque objects.
//
// in    uMap     [light.unit] flux on each texel
//       uShadow  depths of the receivers, seen from the light
//       uBehind  USE_BEHIND: of those behind them, whose light lies above that on the first ones
//       uSolid   FROM_SOLID: what each pixel shows, height fields too (views/geometry.frag)
//       uPlaces  OF_PLACES: world places of the pixels, of what is unfolded
//       uBefore  USE_BEFORE: the sum so far
// out   oSum.rgb [W/m²]
// model mean flux of the texels that a sample of the pixel covers, each by how much of it, over the area that a texel
//       covers on the surface: a focus may be smaller than a pixel. Where the sample's part of a pixel is smaller than a
//       texel that is bilinear
// not   light on the side that is turned away from the lamp
#pragma variants - PARABOLOIDS ONE_VIEW
#pragma variants - USE_BEFORE
#pragma variants - USE_BEHIND
#pragma variants - FROM_SOLID OF_PLACES
#include "views/view.glsl"
layout(std140) uniform LookupBlock {
    View view; // of the camera
    View faces[6];
    int faceCount;
    float unit; // [W] that the map counts as 1
    float extent; // OF_PLACES: [m] that a pixel covers along a side
    float part;   // of a pixel's side that one of its samples covers
} light;
#include "lib/octahedral.glsl"
#ifdef FROM_SOLID
uniform sampler2D uSolid;
#else
#include "views/surface_pixel.glsl"
#endif
#include "caustics/map_view.glsl"
uniform sampler2D uMap;
#ifdef OF_PLACES
uniform sampler2D uPlaces;
#endif
#ifdef USE_BEHIND
uniform sampler2D uBehind;
#endif
#ifdef USE_BEFORE
uniform sampler2D uBefore;
#endif
layout(location = 0) out vec4 oSum;

// How far from a pixel's own plane its surface may lie, in texels: for a height field's smooth normals, which hide what
// its cells do, more than half a texel.
#ifdef FROM_SOLID
const float kMargin = 2.0;
#else
const float kMargin = 0.5;
#endif

struct Shown {
    vec3 normal;
    float depth; // m; 1e30: nothing that receives
};

Shown shownHere() {
#ifdef FROM_SOLID
    vec4 solid = texelFetch(uSolid, ivec2(gl_FragCoord.xy), 0);
    return Shown(fromOctahedral(solid.yz), solid.a > 0.0 ? solid.x : 1e30);
#else
    SurfacePixel pixel = readSurface();
    return Shown(fromOctahedral(pixel.g), pixel.face == kMeshFace ? pixel.z : 1e30);
#endif
}

// Point of the surface's tangent plane beside the middle of the pixel, in pixels.
vec3 besides(vec3 place, vec3 normal, vec2 offset) {
#ifdef OF_PLACES
    vec3 aside = normalize(cross(normal, abs(normal.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
    return place + light.extent * (offset.x * aside + offset.y * cross(normal, aside));
#else
    View view = light.view;
    vec2 pixel = gl_FragCoord.xy + offset;
    vec3 across = placeFrom(view, pixel, 1.0) - (view.eye.w > 0.5 ? vec3(0.0) : view.forward.xyz);
    vec3 origin = view.eye.w > 0.5 ? vec3(0.0) : across;
    vec3 ray = view.eye.w > 0.5 ? across : view.forward.xyz;
    float slope = dot(normal, ray);
    if (abs(slope) <= 1e-3 * length(ray)) return place;
    return view.eye.xyz + origin + dot(normal, place - view.eye.xyz - origin) / slope * ray;
#endif
}

// How far a step to both sides of the pixel's middle leads on the map, in texels.
vec2 acrossMap(int number, vec3 place, vec3 normal, vec2 step_) {
    vec3 low = onMap(number, besides(place, normal, -step_));
    vec3 high = onMap(number, besides(place, normal, step_));
    bool perspective = light.faces[number].eye.w > 0.5;
    return perspective && min(low.z, high.z) <= 0.0 ? vec2(0.0) : high.xy - low.xy;
}

// The rectangle that a pixel covers on the map.
struct Patch {
    vec2 along;  // unit: of its sides of length size.x
    vec2 size;   // texels
};

const float kMostTexels = 32.0; // that are looked at along a side: of more every second, third ...

// Around the parallelogram of a pixel; at least a texel wide, so that between texels light is interpolated. Of one that is
// so long that looks would miss it, the middle.
Patch patchOf(vec2 u, vec2 v) {
    vec2 longer = dot(u, u) >= dot(v, v) ? u : v;
    vec2 other = dot(u, u) >= dot(v, v) ? v : u;
    float reach = length(longer);
    if (reach <= 1.0) return Patch(vec2(1.0, 0.0), vec2(1.0));
    vec2 along = longer / reach;
    float width = max(abs(along.x * other.y - along.y * other.x), 1.0);
    return Patch(along, vec2(min(reach + abs(dot(other, along)), kMostTexels * floor(width)), width));
}

// Flux on a texel of the surface that a plane through v touches; a: 1. Zeros where the map shows another surface there.
vec4 fluxOn(View face, ivec2 corner, vec2 at, vec3 v, vec3 normal, float margin) {
    ivec2 texel = corner + ivec2(at);
    float depth = depthOnPlane(face, at + 0.5, v, normal);
    if (abs(texelFetch(uShadow, texel, 0).r - depth) > margin) {
#ifdef USE_BEHIND
        if (abs(texelFetch(uBehind, texel, 0).r - depth) > margin) return vec4(0.0);
        texel.y += textureSize(uBehind, 0).y;
#else
        return vec4(0.0);
#endif
    }
    return vec4(texelFetch(uMap, texel, 0).rgb, 1.0);
}

vec3 irradianceAt(vec3 place, vec3 normal) {
    int number = faceOf(place);
    View face = light.faces[number];
    vec3 v = place - face.eye.xyz;
    vec3 seen = onMap(number, place);
    bool perspective = face.eye.w > 0.5;
    if (perspective && seen.z <= 0.0) return vec3(0.0);
    vec2 middle = seen.xy;
    if (any(lessThan(middle, vec2(0.0))) || any(greaterThan(middle, face.size))) return vec3(0.0);
    vec3 along = perspective ? normalize(v) : face.forward.xyz;
    float cosine = -dot(normal, along);
    if (cosine <= 0.0) return vec3(0.0);

    float margin = texelWidth(face, middle, v) * (kMargin + kSteepMargin * sqrt(1.0 - cosine * cosine) / max(cosine, 1e-6));
    ivec2 corner = ivec2(number % 3, number / 3) * ivec2(face.size);
    float half_ = 0.5 * light.part;
    Patch patch_ = patchOf(acrossMap(number, place, normal, vec2(half_, 0.0)), acrossMap(number, place, normal, vec2(0.0, half_)));
    vec2 across = vec2(-patch_.along.y, patch_.along.x);
    vec2 most = 0.5 * (patch_.size + 1.0); // from the middle of a texel that it touches
    vec2 reach = most.x * abs(patch_.along) + most.y * abs(across);
    vec2 low = max(ceil(middle - reach - 0.5), 0.0);
    vec2 high = min(floor(middle + reach - 0.5), face.size - 1.0);
    float stride = ceil(max(patch_.size.x, patch_.size.y) / kMostTexels);
    vec4 sum = vec4(0.0); // a: weights
    for (float y = low.y; y <= high.y; y += stride)
        for (float x = low.x; x <= high.x; x += stride) {
            vec2 beside = vec2(x, y) + 0.5 - middle;
            vec2 share = clamp(most - abs(vec2(dot(beside, patch_.along), dot(beside, across))), 0.0, 1.0);
            sum += share.x * share.y * fluxOn(face, corner, vec2(x, y), v, normal, margin);
        }
    if (sum.a == 0.0) return vec3(0.0);
    return sum.rgb / sum.a * light.unit * cosine / texelArea(face, middle, v);
}

void main() {
#ifdef USE_BEFORE
    oSum = texelFetch(uBefore, ivec2(gl_FragCoord.xy), 0);
#else
    oSum = vec4(0.0);
#endif
    Shown shown = shownHere();
    if (shown.depth == 1e30) return;
#ifdef OF_PLACES
    vec3 place = texelFetch(uPlaces, ivec2(gl_FragCoord.xy), 0).xyz;
#else
    vec3 place = light.view.eye.xyz + placeFrom(light.view, gl_FragCoord.xy, shown.depth);
#endif
    oSum.rgb += irradianceAt(place, shown.normal);
}
