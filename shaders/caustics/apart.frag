// caustics/apart.frag: how far receivers lie behind those that a lamp sees, to be read back. 0: there are none.
//
// in    uShadow, uBehind   depths of both
// out   oApart             m; of a lamp at a place: of the nearer one's depth
#pragma variants - PERSPECTIVE
uniform sampler2D uShadow;
uniform sampler2D uBehind;
layout(location = 0) out vec4 oApart;

const float kNothing = 1e29;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(uShadow, texel, 0).r, next = texelFetch(uBehind, texel, 0).r;
    float apart = next < kNothing ? next - depth : 0.0;
#ifdef PERSPECTIVE
    apart /= depth;
#endif
    oApart = vec4(apart);
}
