// subsurface/volume_cells.frag: how each cell is bound to its neighbours and to the world outside.
//
// in    uInside  subsurface/volume_inside.frag
// out   oCell    rgb: flux through the surface over fluence, per face of a cell; a: 0 outside, else 64 + a bit for each
//                neighbour inside: -x, +x, -y, +y, -z, +z
// model flux phi / (2 A) at the surface (mixed condition; Haskell et al. 1994), a distance d along the normal from the
//       middle: 1 / (2 A + d / D). A face that looks along an axis stands for its projection, |n_axis|: over the three
//       axes their squares add up to the surface's area, which steps of cells overestimate by half
#include "subsurface/volume_columns.glsl"
uniform sampler2D uInside;
layout(location = 0) out vec4 oCell;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    oCell = vec4(0.0);
    if (texelFetch(uInside, texel, 0).r == 0.0) return;
    ivec3 cell = cellAt(texel);
    vec3 depth = (vec3(cell) + 0.5) * volume.low.w;
    vec3 leaving = vec3(0.0);
    int mask = 64;
    for (int direction = 0; direction < 6; ++direction) {
        int axis = direction >> 1;
        int way = 2 * (direction & 1) - 1;
        ivec3 neighbour = cell;
        neighbour[axis] += way;
        if (texelFetch(uInside, texelOf(neighbour), 0).r > 0.0) {
            mask |= 1 << direction;
            continue;
        }
        float side = float(way);
        vec2 surface = axis == 0   ? nearest(uAlongX, cell.yz, volume.layers.x, depth.x, side, 0)
                       : axis == 1 ? nearest(uAlongY, cell.zx, volume.layers.y, depth.y, side, 1)
                                   : nearest(uAlongZ, cell.xy, volume.layers.z, depth.z, side, 2);
        float away = surface.x * surface.y / volume.low.w;
        leaving += surface.y / (volume.diffusion.a + away / volume.diffusion.rgb);
    }
    oCell = vec4(leaving, float(mask));
}
