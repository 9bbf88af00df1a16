// caustics/mirror.frag: one ray of light that a mirror reflects.
//
// in    uSurface  views/solid.frag: the first surface that the light meets
// out   oPlace, oDirection, oFlux, or the book: caustics/photon.glsl
// not   light that meets a mirror twice, or a mirror and glass
#pragma variants - VERTICES RESTS PIXELS
#pragma variants PACKED if RESTS PIXELS
#pragma variants - WITH_BOOK
#pragma variants - USE_BLENDED
#include "caustics/lamp.glsl"
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
#include "caustics/mirrors.glsl"

layout(std140) uniform MirrorBlock {
    View view; // of the light
    Lamp lamp;
    vec4 mirrors[kMostMirrors]; // reflectance; a: object
    int count;
    int border; // pixels at each side that belong to the lamp's next view
} light;

// The mirror of an object in the list; light.count: it is none.
int mirrorOf(vec4 texel) {
    int object = int(floor(texel.w)) >> 3;
    int found = 0;
    while (found < light.count && int(light.mirrors[found].a) != object) ++found;
    return texel.w == 0.0 ? light.count : found;
}

bool isMet(ivec2 pixel) {
    return !isBeside(light.view, light.border, pixel) && mirrorOf(texelFetch(uSurface, pixel, 0)) < light.count;
}
#include "caustics/photon.glsl"

void main() {
    Start start = startOf(light.view, light.lamp.grid);
    leave(start);
    if (start.coverage == 0.0) return;
    vec2 at = vec2(start.pixel) + 0.5;
    vec4 texel = texelFetch(uSurface, start.pixel, 0);
    int mirror = mirrorOf(texel);
    vec3 eye = eyeRay(light.view, at);
    vec3 place = placeFrom(light.view, at, texel.z);
    vec3 flux = start.coverage * transmittanceAt(start.pixel) * fluxOf(light.view, light.lamp, eye, length(place));
    vec3 reflectance = light.mirrors[mirror].rgb;
#ifdef WITH_BOOK
    flux *= start.own;
    oMet = vec4(flux, start.own);
    oAbsorbed = vec4(flux * (1.0 - reflectance), 1.0);
#else
    oPlace = vec4(light.view.eye.xyz + place, float(mirror + 1));
    oDirection = vec4(reflect(eye, fromOctahedral(texel.xy)), 0.0);
    oFlux = vec4(flux * reflectance, markOf(start.coverage, start.sixths));
#endif
}
