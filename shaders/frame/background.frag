// frame/background.frag: the environment behind everything else.
//
// in    uShown    light on what is seen
// out   oColor    linear Rec. 709; a: coverage
#include "views/view.glsl"
#include "views/environment.glsl"
#include "views/surface_pixel.glsl"
layout(std140) uniform BackgroundBlock {
    View view;
    mat4 mapFromWorld;
    float intensity;
} background;
uniform sampler2D uShown;
layout(location = 0) out vec4 oColor;

void main() {
    SurfacePixel pixel = readSurface();
    float coverage = pixel.object < 0 ? 0.0 : pixel.coverage;
    vec3 direction = mat3(background.mapFromWorld) * eyeRay(background.view, gl_FragCoord.xy);
    vec3 behind = background.intensity * mapRadiance(direction);
    oColor = vec4(mix(behind, texelFetch(uShown, ivec2(gl_FragCoord.xy), 0).rgb, coverage), 1.0);
}
