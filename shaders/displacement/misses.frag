// displacement/misses.frag: where the ray cast of a displaced surface finds another place than the exact one.
//
// in    uSurface, uExact  views/surface_pixel.glsl
// out   oMiss             white: missed, black: found
#include "views/surface_pixel.glsl"
layout(std140) uniform MissesBlock {
    int object;
    float apart; // m along the view: so far is another place
} misses;
uniform sampler2D uExact;
layout(location = 0) out vec4 oMiss;

void main() {
    vec4 exact = texelFetch(uExact, ivec2(gl_FragCoord.xy), 0);
    if (int(floor(exact.w)) >> 3 != misses.object || exact.w == 0.0) discard;
    SurfacePixel found = readSurface();
    bool missed = found.object != misses.object || abs(found.z - exact.z) > misses.apart;
    oMiss = vec4(vec3(missed ? 1.0 : 0.0), 1.0);
}
