// views/layer_texel.glsl: one surface in a pixel of a layered image.
//
// x: depth [m] along the view; yz: octahedral normal, outward; w: 2 * object + 1 where the outside faces the view,
// + 2 where the inside does. 0: nothing.
#include "lib/octahedral.glsl"

vec4 layerTexel(float depth, vec3 outward, int object, bool facesView) {
    return vec4(depth, octahedralFrom(normalize(outward)), float(2 * object + (facesView ? 1 : 2)));
}

int objectOf(vec4 texel) { return (int(texel.w) - 1) >> 1; }
bool facesView(vec4 texel) { return (int(texel.w) & 1) == 1; }
vec3 normalOf(vec4 texel) { return fromOctahedral(texel.yz); }
