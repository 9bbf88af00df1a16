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
    ivec2 cells = textureSize(uState, 0) - 1;
    ivec2 at = (ivec2(gl_FragCoord.xy) * cells + water.squares / 2) / water.squares;
    ivec2 stride = max(cells / water.squares, 1); // a mesh of fewer squares shows no waves shorter than them
    vec2 place = placeOf(at);
    vec2 rise = vec2(heightAt(at + ivec2(stride.x, 0)) - heightAt(at - ivec2(stride.x, 0)),
                     heightAt(at + ivec2(0, stride.y)) - heightAt(at - ivec2(0, stride.y)));
    vec2 slope = rise / (2.0 * vec2(stride) * water.cell);
    oPosition = vec4(place.x, heightAt(at), place.y, 0.0);
    oNormal = vec4(normalize(vec3(-slope.x, 1.0, -slope.y)), 0.0);
}
