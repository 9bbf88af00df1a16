// views/water_drop.frag: a drop falls: a hollow with a rim that holds what was in the hollow.
//
// model -depth (1 - q) e^(-q) with q = distance^2 / radius^2, whose integral over the plane is 0; the walls
//       mirror it, so that none is lost behind them
#include "views/water_state.glsl"
layout(location = 0) out vec4 oState;

// -1, 0 or 1: behind which wall the drop is seen in the mirror.
vec2 mirrored(vec2 place, vec2 side) { return side * water.size + (1.0 - 2.0 * abs(side)) * place; }

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float change = 0.0;
    for (int i = 0; i < 9; ++i) {
        vec2 side = vec2(i % 3, i / 3) - 1.0;
        vec2 from = (placeOf(at) - mirrored(water.drop.xy, side)) / water.drop.z;
        float q = dot(from, from);
        change -= water.drop.w * (1.0 - q) * exp(-q);
    }
    oState = vec4(stateAt(at) + vec2(change, 0.0), 0.0, 0.0);
}
