// caustics/absorbed.frag: what water or mirrors have absorbed of rays on their way.
//
// in    uBefore, uAfter  flux of the rays
//       uIncident        a: the share of it that is a ray's own to carry
// out   oAbsorbed [W]
uniform sampler2D uBefore;
uniform sampler2D uAfter;
uniform sampler2D uIncident;
layout(location = 0) out vec4 oAbsorbed;

void main() {
    ivec2 ray = ivec2(gl_FragCoord.xy);
    vec3 lost = texelFetch(uBefore, ray, 0).rgb - texelFetch(uAfter, ray, 0).rgb;
    oAbsorbed = vec4(texelFetch(uIncident, ray, 0).a * lost, 1.0);
}
