// views/water.frag: the vertices of water as its heights have them.
//
// out   oPosition, oNormal  object space
#include "views/water_state.glsl"
layout(location = 0) out vec4 oPosition;
layout(location = 1) out vec4 oNormal;

float heightAt(ivec2 texel) {
    vec2 state = stateAt(texel);
    return state.x + water.rest * state.y;
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec2 place = placeOf(at);
    vec2 rise = vec2(heightAt(at + ivec2(1, 0)) - heightAt(at - ivec2(1, 0)),
                     heightAt(at + ivec2(0, 1)) - heightAt(at - ivec2(0, 1)));
    vec2 slope = rise / (2.0 * water.cell);
    oPosition = vec4(place.x, heightAt(at), place.y, 0.0);
    oNormal = vec4(normalize(vec3(-slope.x, 1.0, -slope.y)), 0.0);
}
