// measure/probe.frag: what this device does with numbers, one question a variant.
//
// in    uSource  FILTER, BY_HAND: a row of two texels; ADD with sums: the sum so far
// out   oValue   RAMP: values in [1, 2) with 17 binary digits, exact in 32-bit floats, one a column
//                ADD: the ramp times (term + 1) / 64, on top of uSource unless the device blends
//                FILTER, BY_HAND: between the two texels, as far along as the column is along the row
//                STEP: smallest power of two that still makes a difference to 1
//                WORK: a long sum of cosines, for timing
#pragma variants RAMP ADD FILTER BY_HAND STEP WORK
layout(std140) uniform ProbeBlock {
    float one; // 1, but no compiler knows
    int count; // terms of WORK, the term of ADD, 1 for STEP
    int readsSum;
    int columns;
} probe;
uniform sampler2D uSource;
layout(location = 0) out vec4 oValue;

float ramp() { return float(65536 + 257 * int(gl_FragCoord.x)) / 65536.0; }
float along() { return gl_FragCoord.x / float(probe.columns); }

void main() {
#if defined(RAMP)
    oValue = vec4(ramp());
#elif defined(ADD)
    vec4 sum = probe.readsSum != 0 ? texelFetch(uSource, ivec2(gl_FragCoord.xy), 0) : vec4(0.0);
    oValue = sum + vec4(ramp() * float(probe.count + 1) / 64.0);
#elif defined(FILTER)
    oValue = textureLod(uSource, vec2(0.25 + 0.5 * along(), 0.5), 0.0);
#elif defined(BY_HAND)
    oValue = mix(texelFetch(uSource, ivec2(0), 0), texelFetch(uSource, ivec2(1, 0), 0), along());
#elif defined(STEP)
    float step = 1.0;
    for (int i = 0; i < 60 && probe.one + 0.5 * step != float(probe.count); ++i) step *= 0.5;
    oValue = vec4(step);
#else
    float sum = 0.0;
    for (int i = 0; i < probe.count; ++i) sum += cos(sum + gl_FragCoord.x * probe.one);
    oValue = vec4(sum);
#endif
}
