// caustics/receivers.glsl: what light can fall on, by the depths of the light's view of it.
//
// The file that includes this declares `light` as views/shadow.glsl wants it.
#include "views/shadow.glsl"
#ifdef USE_BEHIND
uniform sampler2D uBehind; // depths of the receivers behind those
uniform sampler2D uBack;   // and where the first ones end, if they are solid: before the second ones
#endif

const float kFar = 1e29; // beyond it there is nothing

ivec2 texelOn(int face, vec2 texel) {
    ivec2 corner = ivec2(face % 3, face / 3) * ivec2(light.faces[face].size);
    return corner + ivec2(clamp(texel, vec2(0.0), light.faces[face].size - 1.0));
}

// @param layer  0: of what the light sees; 1: of the receivers behind, which go on as the first where none lies behind,
//               as a floor does beside a table; 2: of the first ones' backs
float depthAt(int face, vec2 texel, int layer) {
    ivec2 at = texelOn(face, texel);
    float first = texelFetch(uShadow, at, 0).r;
#ifdef USE_BEHIND
    float behind = texelFetch(uBehind, at, 0).r;
    if (layer == 1 && behind < kFar) return behind;
    if (layer == 2) return texelFetch(uBack, at, 0).r;
#endif
    return first;
}

#ifdef USE_BEHIND
// Whether a receiver lies behind another one at a place.
bool isBehind(vec3 place) {
    int number = faceOf(place);
    View face = light.faces[number];
    return texelFetch(uBehind, texelOn(number, floor(pixelOf(face, inView(face, place - face.eye.xyz)))), 0).r < kFar;
}
#endif

// Depths that differ by more widths of a texel are not of one surface: it would be 7 degrees from edge-on, and neither
// show nor light up. Chosen by eye.
const float kMostSteep = 8.0;

// Depth of the surface in a pixel of a face: between four texels such that planes stay planes; 1e30: nothing.
float surfaceDepth(int face, vec2 pixel, int layer) {
    bool perspective = light.faces[face].eye.w > 0.5;
    vec2 low = floor(pixel - 0.5);
    vec2 f = pixel - 0.5 - low;
    vec4 d = vec4(depthAt(face, low, layer), depthAt(face, low + vec2(1.0, 0.0), layer),
                  depthAt(face, low + vec2(0.0, 1.0), layer), depthAt(face, low + 1.0, layer));
    float nearest = min(min(d.x, d.y), min(d.z, d.w));
    float width = length(light.faces[face].right.xyz) * (perspective ? nearest : 1.0);
    if (max(max(d.x, d.y), max(d.z, d.w)) > nearest + kMostSteep * width) return depthAt(face, floor(pixel), layer);
    if (!perspective) return mix(mix(d.x, d.y, f.x), mix(d.z, d.w, f.x), f.y);
    d = 1.0 / d;
    return 1.0 / mix(mix(d.x, d.y, f.x), mix(d.z, d.w, f.x), f.y);
}

struct Glance {
    float gap;      // [m] by which a place lies before the surface there, along the view; 1e30: nothing there
    vec3 surface;   // world: that surface on the light's line through the place
};

Glance lookFrom(vec3 place, int layer) {
    int number = faceOf(place);
    View face = light.faces[number];
    vec3 seen = inView(face, place - face.eye.xyz);
    Glance nothing = Glance(1e30, place);
    if (face.eye.w > 0.5 && seen.z <= 0.0) return nothing;
    vec2 pixel = pixelOf(face, seen);
    if (any(lessThan(pixel, vec2(0.0))) || any(greaterThan(pixel, face.size))) return nothing;
    float depth = surfaceDepth(number, pixel, layer);
    if (depth > kFar) return nothing;
    return Glance(depth - seen.z, face.eye.xyz + placeFrom(face, pixel, depth));
}

// Width of a texel of the view at a place [m].
float texelAt(vec3 place) {
    View face = light.faces[faceOf(place)];
    float depth = dot(place - face.eye.xyz, face.forward.xyz);
    return length(face.right.xyz) * (face.eye.w > 0.5 ? max(depth, face.right.w) : 1.0);
}
