// caustics/lookup.frag: light of the caustic map on what each pixel shows of opaque objects.
//
// in    uMap     [light.unit] flux on each texel
//       uShadow  depths of the receivers, seen from the light
//       uBehind  USE_BEHIND: of those behind them, whose light lies above that on the first ones
//       uSolid   FROM_SOLID: what each pixel shows, height fields too (views/geometry.frag)
//       uBefore  USE_BEFORE: the sum so far
// out   oSum.rgb [W/m²]
// model flux of the texels around over the area that a texel covers on the surface; as a mean over the pixel, of at
//       least as many places as texels lie in it, since a focus may be smaller than a pixel
// not   light on the side that is turned away from the lamp
#include "views/view.glsl"
layout(std140) uniform LookupBlock {
    View view; // of the camera
    View faces[6];
    int faceCount;
    float unit; // [W] that the map counts as 1
    int padding0, padding1;
} light;
#include "lib/octahedral.glsl"
#ifdef FROM_SOLID
uniform sampler2D uSolid;
#else
#include "views/surface_pixel.glsl"
#endif
#include "caustics/map_view.glsl"
uniform sampler2D uMap;
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

// Where a place lies on the map, in texels.
vec2 mapAt(vec3 place) {
    int number = faceOf(place);
    return onMap(number, place).xy + float(number) * 1e6;
}

vec3 fluxOnArea(vec3 place, vec3 normal) {
    int number = faceOf(place);
    View face = light.faces[number];
    vec3 v = place - face.eye.xyz;
    vec3 seen = onMap(number, place);
    bool perspective = face.eye.w > 0.5;
    if (perspective && seen.z <= 0.0) return vec3(0.0);
    vec2 pixel = seen.xy;
    if (any(lessThan(pixel, vec2(0.0))) || any(greaterThan(pixel, face.size))) return vec3(0.0);
    vec3 along = perspective ? normalize(v) : face.forward.xyz;
    float cosine = -dot(normal, along);
    if (cosine <= 0.0) return vec3(0.0);

    float margin = texelWidth(face, pixel, v) * (kMargin + kSteepMargin * sqrt(1.0 - cosine * cosine) / max(cosine, 1e-6));
    ivec2 corner = ivec2(number % 3, number / 3) * ivec2(face.size);
    vec2 low = floor(pixel - 0.5);
    vec2 f = pixel - 0.5 - low;
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        vec2 step_ = vec2(i & 1, i >> 1);
        vec2 at = clamp(low + step_, vec2(0.0), face.size - 1.0);
        ivec2 texel = corner + ivec2(at);
        float depth = depthOnPlane(face, at + 0.5, v, normal);
        if (abs(texelFetch(uShadow, texel, 0).r - depth) > margin) { // another surface
#ifdef USE_BEHIND
            if (abs(texelFetch(uBehind, texel, 0).r - depth) > margin) continue;
            texel.y += textureSize(uBehind, 0).y;
#else
            continue;
#endif
        }
        vec2 share = mix(1.0 - f, f, step_);
        weights += share.x * share.y;
        sum += share.x * share.y * texelFetch(uMap, texel, 0).rgb;
    }
    if (weights == 0.0) return vec3(0.0);
    return sum / weights * light.unit * cosine / texelArea(face, pixel, v);
}

// Point of the surface's tangent plane beside the middle of the pixel, in pixels.
vec3 besides(vec3 place, vec3 normal, vec2 offset) {
    View view = light.view;
    vec2 pixel = gl_FragCoord.xy + offset;
    vec3 across = placeFrom(view, pixel, 1.0) - (view.eye.w > 0.5 ? vec3(0.0) : view.forward.xyz);
    vec3 origin = view.eye.w > 0.5 ? vec3(0.0) : across;
    vec3 ray = view.eye.w > 0.5 ? across : view.forward.xyz;
    float slope = dot(normal, ray);
    if (slope >= -1e-3 * length(ray)) return place;
    return view.eye.xyz + origin + dot(normal, place - view.eye.xyz - origin) / slope * ray;
}

const float kMostTaps = 16.0; // along a side of a pixel

void main() {
#ifdef USE_BEFORE
    oSum = texelFetch(uBefore, ivec2(gl_FragCoord.xy), 0);
#else
    oSum = vec4(0.0);
#endif
    Shown shown = shownHere();
    if (shown.depth == 1e30) return;
    vec3 normal = shown.normal;
    vec3 place = light.view.eye.xyz + placeFrom(light.view, gl_FragCoord.xy, shown.depth);
    vec2 u = mapAt(besides(place, normal, vec2(0.5, 0.0))) - mapAt(besides(place, normal, vec2(-0.5, 0.0)));
    vec2 v = mapAt(besides(place, normal, vec2(0.0, 0.5))) - mapAt(besides(place, normal, vec2(0.0, -0.5)));
    vec2 taps = clamp(ceil(vec2(length(u), length(v)) - 0.01), 1.0, kMostTaps);
    vec3 sum = vec3(0.0);
    for (float y = 0.5; y < taps.y; ++y)
        for (float x = 0.5; x < taps.x; ++x)
            sum += fluxOnArea(besides(place, normal, vec2(x, y) / taps - 0.5), normal);
    oSum.rgb += sum / (taps.x * taps.y);
}
