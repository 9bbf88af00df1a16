// views/layer_texel.glsl: one surface in a pixel of a layered image.
//
// x: depth [m] along the view; y: number of the triangle; z: its outward normal, packed; w: 2 * object + 1 where the
// outside faces the view, + 2 where the inside does. 0: nothing. Depth and normal lead rays to the triangle, which is
// what they meet (views/triangles.glsl).
#include "lib/octahedral.glsl"

// Twelve bits for each octahedral number: 24, which a float holds exactly. Up to 4e-4 off.
float packedNormal(vec3 n) {
    vec2 e = floor((octahedralFrom(n) * 0.5 + 0.5) * 4095.0 + 0.5);
    return e.x * 4096.0 + e.y;
}

vec3 unpackedNormal(float number) {
    float high = floor(number * (1.0 / 4096.0)); // exact
    return fromOctahedral(vec2(high, number - 4096.0 * high) * (2.0 / 4095.0) - 1.0);
}

int objectOf(vec4 texel) { return (int(texel.w) - 1) >> 1; }
bool facesView(vec4 texel) { return (int(texel.w) & 1) == 1; }
int triangleOf(vec4 texel) { return int(texel.y); }
vec3 normalOf(vec4 texel) { return unpackedNormal(texel.z); }
