// subsurface/gather.frag: light of many points that leaves the object at a place that the camera shows. What
// subsurface/splat.frag adds up, where 32-bit floats cannot be added to: few sums of many points each.
//
// in    uReceivers  subsurface/receivers.frag
// out   oRadiosity.rgb [splat.unit]  added up
#pragma variants - OFFSET
#pragma variants - PAINTED
#include "subsurface/level.glsl"
#include "subsurface/leaving.glsl"
uniform sampler2D uReceivers;
layout(location = 0) out vec4 oRadiosity;

void main() {
    vec4 receiver = texelFetch(uReceivers, ivec2(gl_FragCoord.xy), 0);
    if (int(receiver.w) != splat.object + 1) discard;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < splat.count; ++i) {
        Point point;
        if (findPoint(splat.first + i, point))
            sum += point.flux * leaving(point.sharpness * (receiver.xyz - point.place), point.normal);
    }
    oRadiosity = vec4(sum / splat.unit, 1.0);
}
