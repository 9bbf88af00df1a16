// frame/background.frag: the environment behind everything else.
//
// in    uShown    light on what is seen; ALONE: not there, nothing is
// out   oColor    linear Rec. 709; a: coverage
#pragma variants - ALONE
#include "views/view.glsl"
#include "views/environment.glsl"
#ifndef ALONE
#include "views/surface_pixel.glsl"
#endif
layout(std140) uniform BackgroundBlock {
    View view;
    mat4 mapFromWorld;
    float intensity;
} background;
#ifndef ALONE
uniform sampler2D uShown;
#endif
layout(location = 0) out vec4 oColor;

void main() {
    vec3 direction = mat3(background.mapFromWorld) * eyeRay(background.view, gl_FragCoord.xy);
    vec3 behind = background.intensity * mapRadiance(direction);
#ifdef ALONE
    oColor = vec4(behind, 1.0);
#else
    SurfacePixel pixel = readSurface();
    float coverage = pixel.object < 0 ? 0.0 : pixel.coverage;
    oColor = vec4(mix(behind, texelFetch(uShown, ivec2(gl_FragCoord.xy), 0).rgb, coverage), 1.0);
#endif
}
