// throughput/spread.frag: what leaves at the texels of an atlas: of texels around, and of what vertices carry.
//
// in    uEntered   [W/m²] throughput/enter.frag
//       uPlace     throughput/place.frag
//       uFrame     z, w: weights of the second and third corner of the texel's triangle
//       uCorners   numbers of its vertices | 1: is shown
//       uVertices  [W/m²] that leave at the vertices of far light
//       uNear      LIVE: near part of R_d at r = cut (i / (n - 1))² [1/m²]
//       uEvened    LIVE: factor of their sum
//       uFilters   STORED: a layer for each of 7 x 7 texels around: factors
// out   oLeaving.rgb [W/m²]
#pragma variants LIVE STORED
#include "throughput/vector.glsl"
layout(std140) uniform SpreadBlock {
    int radius; // texels
    float cut;  // [m]
    float local, global; // 1: are shown
} spread;
uniform sampler2D uEntered;
uniform sampler2D uPlace;
uniform sampler2D uFrame;
uniform sampler2D uCorners;
uniform sampler2D uVertices;
#ifdef LIVE
uniform sampler2D uNear;
uniform sampler2D uEvened;
#else
uniform highp sampler2DArray uFilters;
#endif
layout(location = 0) out vec4 oLeaving;

vec3 vertexAt(float number) {
    int i = int(number);
    return texelFetch(uVertices, ivec2(i % kVectorWidth, i / kVectorWidth), 0).rgb;
}

vec3 ofTexels(ivec2 at) {
    vec3 sum = vec3(0.0);
#ifdef LIVE
    ivec2 last = textureSize(uPlace, 0) - 1;
    ivec2 low = max(at - spread.radius, ivec2(0));
    ivec2 high = min(at + spread.radius, last);
    vec3 place = texelFetch(uPlace, at, 0).xyz;
    float entries = float(textureSize(uNear, 0).x - 1);
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
            vec4 other = texelFetch(uPlace, ivec2(x, y), 0);
            float r = distance(other.xyz, place) / spread.cut;
            if (other.w == 0.0 || r >= 1.0) continue;
            vec3 near = texelFetch(uNear, ivec2(int(sqrt(r) * entries + 0.5), 0), 0).rgb;
            sum += other.w * near * texelFetch(uEntered, ivec2(x, y), 0).rgb;
        }
    return sum * texelFetch(uEvened, at, 0).rgb;
#else
    for (int y = -3; y <= 3; ++y)
        for (int x = -3; x <= 3; ++x)
            sum += texelFetch(uFilters, ivec3(at, 7 * (y + 3) + x + 3), 0).rgb *
                   texelFetch(uEntered, clamp(at + ivec2(x, y), ivec2(0), textureSize(uEntered, 0) - 1), 0).rgb;
    return sum;
#endif
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 corners = texelFetch(uCorners, at, 0);
    if (corners.w == 0.0) discard;
    vec2 weights = texelFetch(uFrame, at, 0).zw;
    vec3 far = (1.0 - weights.x - weights.y) * vertexAt(corners.x) + weights.x * vertexAt(corners.y) +
               weights.y * vertexAt(corners.z);
    oLeaving = vec4(spread.local * ofTexels(at) + spread.global * far, 1.0);
}
