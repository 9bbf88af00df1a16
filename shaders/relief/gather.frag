// relief/gather.frag: an environment's light on each texel of a height field: one dot product (after precomputed
// transfer, Sloan, Kautz, Snyder 2002, with a basis made for the field).
//
// in    uCoefficients  four a texel in a column of images, one image above the other (relief/project.frag)
// out   oIrradiance    sum of d times light times forward scatter, linear Rec. 709; a: mean of d
layout(std140) uniform GatherBlock {
    vec4 light[512]; // the environment on the basis; USE_NODES: as scattered to each of four corners of the field
    ivec2 size;      // texels
    int terms;
    int columns;     // of images
} gather;
uniform sampler2D uCoefficients;
layout(location = 0) out vec4 oIrradiance;

vec4 part(vec4 c, int k) {
    return c.x * gather.light[k] + c.y * gather.light[k + 1] + c.z * gather.light[k + 2] + c.w * gather.light[k + 3];
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
#ifdef USE_NODES
    vec2 f = (vec2(texel) + 0.5) / vec2(gather.size);
    vec4 weights = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
#endif
    vec4 sum = vec4(0.0);
    for (int k = 0; k < gather.terms; k += 4) {
        int image = k / 4;
        vec4 c = texelFetch(uCoefficients, texel + ivec2(image % gather.columns, image / gather.columns) * gather.size, 0);
#ifdef USE_NODES
        for (int node = 0; node < 4; ++node)
            sum += weights[node] * part(c, 128 * node + k);
#else
        sum += part(c, k);
#endif
    }
    oIrradiance = sum;
}
