// subsurface/volume_inside.frag: which cells have their middle inside the body.
//
// out   oInside  1 or 0
// model two of three axes must say so: an open or flipped triangle spoils one line, not a cell
#include "subsurface/volume_columns.glsl"
layout(location = 0) out float oInside;

void main() {
    ivec3 cell = cellAt(ivec2(gl_FragCoord.xy));
    oInside = 0.0;
    if (cell.z >= volume.cells.z) return;
    vec3 depth = (vec3(cell) + 0.5) * volume.low.w;
    int votes = int(isOdd(uAlongX, cell.yz, volume.layers.x, depth.x)) +
                int(isOdd(uAlongY, cell.zx, volume.layers.y, depth.y)) +
                int(isOdd(uAlongZ, cell.xy, volume.layers.z, depth.z));
    oInside = votes >= 2 ? 1.0 : 0.0;
}
