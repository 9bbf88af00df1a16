// caustics/footprint.frag: light of one ray on a texel of its parallelogram.
#include "caustics/deposit_block.glsl"
flat in vec3 vFlux;
flat in vec2 vMiddle;
flat in vec4 vInverse;
layout(location = 0) out vec4 oFlux;

void main() {
    vec2 corner = vec2(light.face % 3, light.face / 3) * light.faces[light.face].size;
    vec2 pixel = gl_FragCoord.xy - corner;
    if (any(lessThan(pixel, vec2(0.0))) || any(greaterThan(pixel, light.faces[light.face].size))) discard;
    vec2 beside = gl_FragCoord.xy - vMiddle;
    if (vInverse != vec4(0.0) && max(abs(dot(vInverse.xy, beside)), abs(dot(vInverse.zw, beside))) > 0.5) discard;
    oFlux = vec4(vFlux, 1.0);
}
