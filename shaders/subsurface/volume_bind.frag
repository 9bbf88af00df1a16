// subsurface/volume_bind.frag: how each cell is bound to its neighbours and to the world outside.
//
// in    uCell, uFaces  subsurface/volume_cells.frag
// out   oLower, oUpper  rgb: open part of the faces towards -x, -y, -z; +x, +y, +z, where a cell lies behind
//       oDiagonal       rgb: flux out of the cell over its fluence; a: 0 outside
#include "subsurface/volume.glsl"
uniform sampler2D uCell;
uniform sampler2D uFaces;
layout(location = 0) out vec4 oLower;
layout(location = 1) out vec4 oUpper;
layout(location = 2) out vec4 oDiagonal;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    oLower = vec4(0.0);
    oUpper = vec4(0.0);
    oDiagonal = vec4(0.0);
    vec4 own = texelFetch(uCell, texel, 0);
    if (own.r == 0.0) return;
    ivec3 cell = cellAt(texel);
    vec3 lowerOpen = vec3(0.0);
    vec3 upperOpen = vec3(0.0);
    vec3 faces = texelFetch(uFaces, texel, 0).rgb;
    for (int axis = 0; axis < 3; ++axis) {
        ivec3 way = ivec3(0);
        way[axis] = 1;
        ivec2 lower = texelOf(cell - way);
        if (texelFetch(uCell, lower, 0).r > 0.0) lowerOpen[axis] = texelFetch(uFaces, lower, 0)[axis];
        if (texelFetch(uCell, texelOf(cell + way), 0).r > 0.0) upperOpen[axis] = faces[axis];
    }
    oLower.rgb = lowerOpen;
    oUpper.rgb = upperOpen;
    float open = dot(lowerOpen + upperOpen, vec3(1.0));
    oDiagonal =
        vec4(open * volume.diffusion.rgb + own.g * leavingFrom(own.b) + own.r * volume.absorption.rgb, 1.0);
}
