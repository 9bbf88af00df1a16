// throughput/spread_seen.frag: what leaves where a view shows a baked object, without what leaves at texels that it does
// not show.
//
// in    uPosition, uFar, uAt  throughput/seen.frag, PLACES
//       throughput/near.glsl
// out   oLeaving  [W/m²] | 1: shows the object
#include "throughput/spread_block.glsl"
#include "throughput/between.glsl"
#include "throughput/near.glsl"
uniform sampler2D uPosition;
uniform sampler2D uFar;
uniform sampler2D uAt;
layout(location = 0) out vec4 oLeaving;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 position = texelFetch(uPosition, pixel, 0);
    if (position.w == 0.0) discard;
    vec2 at = texelFetch(uAt, pixel, 0).xy;
    vec3 near = nearLight(ivec2(at), position.xyz, betweenTexels(uReach, at).rgb, spread.radius, spread.cut);
    oLeaving = vec4(spread.local * near + spread.global * texelFetch(uFar, pixel, 0).rgb, 1.0);
}
