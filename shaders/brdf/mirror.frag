// brdf/mirror.frag: what mirrors send to the eye.
//
// in    uSurface      the visible points (views/surface_pixel.glsl)
//       uEnvironment  USE_SKY: views/environment.glsl
//       uMirrored     USE_FLAT: pictures of flat mirrors, left and right exchanged; a: coverage
//       USE_AROUND    views/surroundings.glsl
//       uShown        USE_VIEW, USE_AROUND: what the camera sees but for mirrors; uSolid: views/geometry.frag
// out   oColor        linear Rec. 709; a: 1
// model reflectance times what lies in the mirrored direction
#pragma variants - USE_SKY
#pragma variants - USE_AROUND USE_VIEW
#pragma variants - USE_FLAT unless USE_VIEW
#include "views/view.glsl"
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
#include "views/surroundings_block.glsl"
#ifdef USE_SKY
#include "views/environment.glsl"
#endif
layout(std140) uniform MirrorBlock {
    View view;
    Around around;
    mat4 mapFromWorld;
    vec4 reflectance;
    vec4 flats[kMostFlat]; // normals [world] of flat sides; a: their layers of uMirrored
    int object;
    int cube;        // of the object; -1: none
    int flatCount;
    float intensity; // of the environment
} mirror;
layout(location = 0) out vec4 oColor;

vec4 environmentAt(vec3 direction) {
#ifdef USE_SKY
    return vec4(mirror.intensity * mapRadiance(mat3(mirror.mapFromWorld) * direction), 1.0);
#else
    return vec4(0.0);
#endif
}

#if defined(USE_AROUND) || defined(USE_VIEW)
uniform sampler2D uShown;
uniform sampler2D uSolid;
#include "views/pictured.glsl"
#endif
#ifdef USE_AROUND
#define AROUND mirror.around
#define RADIANCE_OF radianceInView
#include "views/surroundings.glsl"

// What a ray meets as the camera sees it, whose pixels are finer than a cube's, and show what lies on a surface that the
// cube sees edge-on; as the cube does where it is hidden from the camera.
vec3 radianceInView(Met met, vec3 place) {
    return picturedAt(mirror.view, place - mirror.view.eye.xyz, met.normal, met.radiance);
}
#endif
#ifdef USE_FLAT
uniform sampler2DArray uMirrored;
#endif
#ifdef USE_VIEW
#include "brdf/in_view.glsl"
#endif

vec3 lightAlong(vec3 place, vec3 normal, vec3 direction) {
#ifdef USE_FLAT
    for (int i = 0; i < mirror.flatCount; ++i) {
        if (dot(mirror.flats[i].xyz, normal) < 0.9999) continue;
        ivec2 pixel = ivec2(gl_FragCoord.xy);
        pixel.x = textureSize(uMirrored, 0).x - 1 - pixel.x;
        vec4 seen = texelFetch(uMirrored, ivec3(pixel, int(mirror.flats[i].w)), 0);
        return mix(environmentAt(direction).rgb, seen.rgb, seen.a);
    }
#endif
#ifdef USE_AROUND
    float way;
    if (mirror.cube >= 0) return lightAround(mirror.cube, mirror.view.eye.xyz + place, direction, way).rgb;
#endif
#ifdef USE_VIEW
    return lightInView(mirror.view, place, direction).rgb;
#else
    return environmentAt(direction).rgb;
#endif
}

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.object != mirror.object) discard;
    vec3 place = placeFrom(mirror.view, gl_FragCoord.xy, pixel.z), normal = fromOctahedral(pixel.g);
    vec3 direction = reflect(eyeRay(mirror.view, gl_FragCoord.xy), normal);
    oColor = vec4(mirror.reflectance.rgb * lightAlong(place, normal, direction), 1.0);
}
