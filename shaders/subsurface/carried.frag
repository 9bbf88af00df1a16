// subsurface/carried.frag: what left in the picture before at the places of one object that this one shows.
//
// in    uPlaces    subsurface/receivers.frag, of each pixel
//       uThen      the same of the picture before
//       uLight     [W/m²] that left there
// out   oCarried   rgb: [W/m²]; a: 1, or 0 where the picture before did not show the place
#include "views/view.glsl"
layout(std140) uniform CarriedBlock {
    View view;        // of the picture before
    mat4 thenFromNow; // of the object, world
    int object;
} carried;
uniform sampler2D uPlaces;
uniform sampler2D uThen;
uniform sampler2D uLight;
layout(location = 0) out vec4 oCarried;

const float kNear = 4.0; // pixels: a surface 14 degrees from edge-on. Chosen by eye

void main() {
    vec4 place = texelFetch(uPlaces, ivec2(gl_FragCoord.xy), 0);
    if (int(place.w) != carried.object + 1) discard;
    vec3 then = (carried.thenFromNow * vec4(place.xyz, 1.0)).xyz;
    vec3 seen = inView(carried.view, then - carried.view.eye.xyz);
    if (carried.view.eye.w > 0.5 && seen.z <= 0.0) discard;
    float pixel = max(length(carried.view.right.xyz), length(carried.view.up.xyz)) *
                  (carried.view.eye.w > 0.5 ? seen.z : 1.0);
    vec2 at = pixelOf(carried.view, seen) - 0.5;
    ivec2 base = ivec2(floor(at));
    ivec2 last = textureSize(uThen, 0) - 1;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = base + ivec2(i & 1, i >> 1);
        if (any(lessThan(texel, ivec2(0))) || any(greaterThan(texel, last))) continue;
        vec4 other = texelFetch(uThen, texel, 0);
        if (other.w != place.w || distance(other.xyz, then) > kNear * pixel) continue;
        vec2 share = 1.0 - abs(vec2(texel) - at);
        sum += share.x * share.y * vec4(texelFetch(uLight, texel, 0).rgb, 1.0);
    }
    if (sum.a < 1e-3) discard;
    oCarried = vec4(sum.rgb / sum.a, 1.0);
}
