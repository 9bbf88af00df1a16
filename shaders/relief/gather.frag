// relief/gather.frag: an environment's light on each texel of a height field: one dot product (after precomputed
// transfer, Sloan, Kautz, Snyder 2002, with a basis made for the field).
//
// in    uCoefficients  four a texel in a column of images, one image above the other (relief/project.frag)
// out   oIrradiance    sum of d times light times forward scatter, linear Rec. 709; a: mean of d
#pragma variants - USE_NODES
const int kMostTerms = 128; // of a transfer

layout(std140) uniform GatherBlock {
    vec4 light[kMostTerms]; // the environment on the basis
    ivec2 size;      // texels
    int terms;
    int columns;     // of images
} gather;
uniform sampler2D uCoefficients;
#ifdef USE_NODES
uniform sampler2D uNodes; // in place of gather.light: a row for each of kNodes x kNodes places on the field
const int kNodes = 5;
#endif
layout(location = 0) out vec4 oIrradiance;

#ifdef USE_NODES
vec4 lightOn(int term, int node) { return texelFetch(uNodes, ivec2(term, node), 0); }
#else
vec4 lightOn(int term, int node) { return gather.light[term]; }
#endif

vec4 part(vec4 c, int k, int node) {
    return c.x * lightOn(k, node) + c.y * lightOn(k + 1, node) + c.z * lightOn(k + 2, node) + c.w * lightOn(k + 3, node);
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
#ifdef USE_NODES
    vec2 at = (vec2(texel) + 0.5) / vec2(gather.size) * float(kNodes - 1);
    ivec2 low = min(ivec2(at), kNodes - 2);
    vec2 f = at - vec2(low);
    int node = low.y * kNodes + low.x;
#endif
    vec4 sum = vec4(0.0);
    for (int k = 0; k < gather.terms; k += 4) {
        int image = k / 4;
        vec4 c = texelFetch(uCoefficients, texel + ivec2(image % gather.columns, image / gather.columns) * gather.size, 0);
#ifdef USE_NODES
        vec4 upper = mix(part(c, k, node), part(c, k, node + 1), f.x);
        vec4 lower = mix(part(c, k, node + kNodes), part(c, k, node + kNodes + 1), f.x);
        sum += mix(upper, lower, f.y);
#else
        sum += part(c, k, 0);
#endif
    }
    oIrradiance = sum;
}
