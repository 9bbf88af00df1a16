// views/water_state.glsl: heights of the water and what its walls mirror of them.
#include "views/water.glsl"
uniform sampler2D uState;

vec2 stateAt(ivec2 texel) {
    ivec2 last = textureSize(uState, 0) - 1;
    return texelFetch(uState, last - abs(last - abs(texel)), 0).xy;
}
