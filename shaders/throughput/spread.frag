// throughput/spread.frag: what leaves at the texels of an atlas: of texels around, and of what vertices carry.
//
// in    uEntered   [W/m²] throughput/enter.frag
//       uFrame     z, w: weights of the second and third corner of the texel's triangle
//       uCorners   numbers of its vertices | 1: is shown
//       uVertices  [W/m²] that leave at the vertices of far light
//       uFilters   STORED: a layer for each of 7 x 7 texels around: factors
//       LIVE       throughput/near.glsl
// out   oLeaving.rgb [W/m²]
#pragma variants LIVE STORED
#include "throughput/vector.glsl"
#include "throughput/spread_block.glsl"
uniform sampler2D uFrame;
uniform sampler2D uCorners;
uniform sampler2D uVertices;
#ifdef LIVE
#include "throughput/near.glsl"
#else
uniform sampler2D uEntered;
uniform highp sampler2DArray uFilters;
#endif
layout(location = 0) out vec4 oLeaving;

vec3 vertexAt(float number) { return texelFetch(uVertices, inVector(int(number)), 0).rgb; }

vec3 ofTexels(ivec2 at) {
#ifdef LIVE
    return nearLight(at, texelFetch(uPlace, at, 0).xyz, texelFetch(uReach, at, 0).rgb, spread.radius, spread.cut);
#else
    vec3 sum = vec3(0.0);
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
