// throughput/product.frag: rows of a matrix of which most is 0, times a vector. A pixel is a row.
//
// in    uStarts   where each row starts among the entries, and the next one
//       uEntries  column's texel in the vector, y in the upper half; bits of its factors of red, green and blue
//       uVector
//       uSum      USE_SUM: a vector that is added
// out   oSum.rgb
#pragma variants - USE_SUM
#include "throughput/vector.glsl"
layout(std140) uniform ProductBlock {
    int rows;
} product;
uniform highp usampler2D uStarts;
uniform highp usampler2D uEntries;
uniform sampler2D uVector;
#ifdef USE_SUM
uniform sampler2D uSum;
#endif
layout(location = 0) out vec4 oSum;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    int row = (at.y << kVectorBits) + at.x;
    if (row >= product.rows) discard;
    int first = int(texelFetch(uStarts, inList(row), 0).r);
    int end = int(texelFetch(uStarts, inList(row + 1), 0).r);
    vec3 sum = vec3(0.0);
    for (int k = first; k < end; ++k) {
        uvec4 entry = texelFetch(uEntries, inList(k), 0);
        ivec2 column = ivec2(entry.x & 0xffffu, entry.x >> 16);
        sum += uintBitsToFloat(entry.yzw) * texelFetch(uVector, column, 0).rgb;
    }
#ifdef USE_SUM
    sum += texelFetch(uSum, at, 0).rgb;
#endif
    oSum = vec4(sum, 1.0);
}
