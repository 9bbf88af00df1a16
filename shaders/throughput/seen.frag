// throughput/seen.frag: what an atlas holds where a view shows it.
//
// in    uLeaving   an image of the atlas; a: 0 where it shows nothing
// out   oSeen      bilinear of those that show something
//       with PLACES instead
//       oPosition  object's space times its scale [m] | 1
//       oFar       [W/m²] that leave of far light
//       oPlace     in the atlas [texels]
#pragma variants - PLACES
in vec2 vPlace;
#ifdef PLACES
in vec3 vPosition;
in vec3 vFar;
layout(location = 0) out vec4 oPosition;
layout(location = 1) out vec4 oFar;
layout(location = 2) out vec4 oPlace;

void main() {
    oPosition = vec4(vPosition, 1.0);
    oFar = vec4(vFar, 1.0);
    oPlace = vec4(vPlace, 0.0, 1.0);
}
#else
#include "throughput/between.glsl"
uniform sampler2D uLeaving;
layout(location = 0) out vec4 oSeen;

void main() { oSeen = betweenTexels(uLeaving, vPlace); }
#endif
