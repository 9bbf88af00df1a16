// brdf/mirror.frag: what mirrors send to the eye.
//
// in    uSurface      the visible points (views/surface_pixel.glsl)
//       uEnvironment  USE_SKY: views/environment.glsl
// out   oColor        linear Rec. 709; a: 1
// model reflectance times the environment in the mirrored direction
// not   objects in a mirror
#pragma variants - USE_SKY
#include "views/view.glsl"
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
#ifdef USE_SKY
#include "views/environment.glsl"
#endif
layout(std140) uniform MirrorBlock {
    View view;
    mat4 mapFromWorld;
    vec4 reflectance;
    int object;
    float intensity; // of the environment
} mirror;
layout(location = 0) out vec4 oColor;

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.object != mirror.object) discard;
    oColor = vec4(0.0, 0.0, 0.0, 1.0);
#ifdef USE_SKY
    vec3 direction = reflect(eyeRay(mirror.view, gl_FragCoord.xy), fromOctahedral(pixel.g));
    oColor.rgb = mirror.reflectance.rgb * mirror.intensity * mapRadiance(mat3(mirror.mapFromWorld) * direction);
#endif
}
