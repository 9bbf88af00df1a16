// views/around.frag: one face of a cube view, or the picture of a flat mirror, from a finished picture.
//
// in    uPicture  linear; a: coverage
//       uSurface  views/surface_pixel.glsl; WITH_SOLID
//       uSolid    views/geometry.frag; WITH_SOLID
// out   oRadiance, oSolid  views/surroundings.glsl
#pragma variants - WITH_SOLID
#include "views/surface_pixel.glsl"
uniform sampler2D uPicture;
layout(location = 0) out vec4 oRadiance;
#ifdef WITH_SOLID
uniform sampler2D uSolid;
layout(location = 1) out vec4 oSolid;
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    oRadiance = texelFetch(uPicture, pixel, 0);
#ifdef WITH_SOLID
    vec4 solid = texelFetch(uSolid, pixel, 0);
    oSolid = vec4(solid.xyz, solid.a == 0.0 ? 0.0 : float(readSurface().object + 1));
#endif
}
