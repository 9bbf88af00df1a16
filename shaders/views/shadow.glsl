// views/shadow.glsl: how much of a light's point reaches a place, by the depths that the light sees.
//
// in    light.faces      the light's views, of a block called `light`
//       light.faceCount
//       uShadow          [m] their depths (views/shadow.frag), three views to a row; 1e30: nothing there
// model percentage-closer filtering (Reeves, Salesin, Cook 1987) of the four nearest texels, each compared with the
//       depth of the receiver's tangent plane in the texel's middle: a plane cannot shade itself however slanted
// not   what lies nearer to the light than a thousandth of the way to the farthest thing it lights
#include "views/view.glsl"
uniform sampler2D uShadow;

// What may be between a surface and its own depths, in texels. Rasterisers round corners (SwiftShader to 1/16 of a
// texel), which counts the more the steeper the surface; the rest of both is for the curvature inside a texel and for
// normals that are not the triangles', and was chosen so that a finely cut ball shows no speckles.
const float kFlatMargin = 0.125;
const float kSteepMargin = 0.25;

// Depth at which the light's line through a pixel meets the plane through v.
float planeDepth(View face, vec2 pixel, vec3 v, vec3 normal) {
    vec2 p = pixel - 0.5 * face.size;
    vec3 across = p.x * face.right.xyz + p.y * face.up.xyz;
    bool perspective = face.eye.w > 0.5;
    float facing = dot(normal, perspective ? across + face.forward.xyz : face.forward.xyz);
    if (facing >= 0.0) return dot(v, face.forward.xyz); // the line passes above the plane's horizon
    return dot(normal, perspective ? v : v - across) / facing;
}

// The view that a place lies in.
//
// ONE_VIEW  there is no other: some drivers read blocks at places that a shader computes value by value
#ifdef ONE_VIEW
int faceOf(vec3 place) { return 0; }
#else
int faceOf(vec3 place) {
    int best = 0;
    float most = -1e30;
    for (int i = 0; i < light.faceCount; ++i) {
        float along = dot(place - light.faces[i].eye.xyz, light.faces[i].forward.xyz);
        if (along <= most) continue;
        most = along;
        best = i;
    }
    return best;
}
#endif

// @param place   world
// @param normal  unit, of the surface; faces the light
// @return        1: all, 0: nothing
float lightReaching(vec3 place, vec3 normal) {
    int number = faceOf(place);
    View face = light.faces[number];
    vec3 v = place - face.eye.xyz;
    vec3 seen = inView(face, v);
    if (seen.z <= 0.0) return 1.0;
    vec2 pixel = pixelOf(face, seen);
    if (any(lessThan(pixel, vec2(0.0))) || any(greaterThan(pixel, face.size))) return 1.0;

    bool perspective = face.eye.w > 0.5;
    float texel = max(length(face.right.xyz), length(face.up.xyz)) * (perspective ? seen.z : 1.0);
    float cosine = max(-dot(normal, perspective ? normalize(v) : face.forward.xyz), 1e-6);
    float margin = texel * (kFlatMargin + kSteepMargin * sqrt(max(1.0 - cosine * cosine, 0.0)) / cosine);
    ivec2 corner = ivec2(number % 3, number / 3) * ivec2(face.size);
    vec2 low = floor(pixel - 0.5);
    vec4 lit;
    for (int i = 0; i < 4; ++i) {
        vec2 at = clamp(low + vec2(i & 1, i >> 1), vec2(0.0), face.size - 1.0);
        float nearest = texelFetch(uShadow, corner + ivec2(at), 0).r;
        lit[i] = nearest + margin >= planeDepth(face, at + 0.5, v, normal) ? 1.0 : 0.0;
    }
    vec2 f = pixel - 0.5 - low;
    return mix(mix(lit[0], lit[1], f.x), mix(lit[2], lit[3], f.x), f.y);
}
