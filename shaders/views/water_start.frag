// views/water_start.frag: water before its first step: a sine that travels.
//
// model h = a e^(-damping t / 2) sin(k . p - w t) at t = 0, its derivative by t half a step earlier
#include "views/water.glsl"
layout(location = 0) out vec4 oState;

void main() {
    float turn = dot(water.sine.xy, placeOf(ivec2(gl_FragCoord.xy)));
    float early = -0.5 * water.step, angle = turn - water.sine.w * early;
    float rise = -0.5 * water.damping * sin(angle) - water.sine.w * cos(angle);
    oState = vec4(water.sine.z * sin(turn), water.sine.z * exp(-0.5 * water.damping * early) * rise, 0.0, 0.0);
}
