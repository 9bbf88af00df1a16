// throughput/seen.frag: what an atlas holds where a view shows it.
//
// in    uLeaving  an image of the atlas; a: 0 where it shows nothing
// out   oSeen     bilinear of those that show something
uniform sampler2D uLeaving;
in vec2 vPlace;
layout(location = 0) out vec4 oSeen;

void main() {
    ivec2 last = textureSize(uLeaving, 0) - 1;
    vec2 low = floor(vPlace - 0.5);
    vec2 part = vPlace - 0.5 - low;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1);
        vec4 texel = texelFetch(uLeaving, clamp(ivec2(low) + step, ivec2(0), last), 0);
        float weight = (step.x == 1 ? part.x : 1.0 - part.x) * (step.y == 1 ? part.y : 1.0 - part.y);
        sum += weight * texel.a * vec4(texel.rgb, 1.0);
    }
    oSeen = sum.a > 0.0 ? sum / sum.a : vec4(0.0);
}
