// subsurface/volume_cells.frag: how much of each cell lies in the body, and how much surface it holds.
//
// out   oCell   r: volume inside [cells], 0: none; g: surface [faces]; b: depth of the middle below it, mean [widths];
//               a: 1 where the surface looks one way, 0 where as much looks back, as in a sheet
//       oFaces  rgb: open part of the faces towards +x, +y, +z
// model cut cells: nine lines a cell along each axis, on its edges and through its middle, as the trapezoidal rule
//       weighs them. A line stands for |n_axis| of the surface that it meets: over the axes the squares add up to 1. Axes
//       count by how much surface their lines meet, since lines along a sheet miss it; without any the majority says
//       whether the cell is inside: an open or flipped triangle spoils one line, not a cell
#include "subsurface/volume_columns.glsl"
layout(location = 0) out vec4 oCell;
layout(location = 1) out vec4 oFaces;

const float kLeast = 1e-3; // of a cell: less is left out

float weightOf(int corner) { return corner == 1 ? 0.5 : 0.25; }

void main() {
    ivec3 cell = cellAt(ivec2(gl_FragCoord.xy));
    oCell = vec4(0.0);
    oFaces = vec4(0.0);
    if (cell.z >= volume.cells.z) return;
    vec3 inside = vec3(0.0); // by axis
    vec3 facing = vec3(0.0);
    vec3 across = vec3(0.0);
    float depth = 0.0;
    vec3 open = vec3(0.0); // by face, of lines that met surface, and of all
    vec3 met = vec3(0.0);
    vec3 openOfAll = vec3(0.0);
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < 9; ++i) {
            ivec2 corner = ivec2(i % 3, i / 3);
            vec2 weights = vec2(weightOf(corner.x), weightOf(corner.y));
            float weight = weights.x * weights.y;
            Crossing found = crossingAlong(axis, cell, corner);
            inside[axis] += weight * found.inside;
            facing[axis] += weight * found.facing;
            across[axis] += weight * found.across;
            depth += weight * found.depth;
            for (int side = 0; side < 2; ++side) { // lines in a face
                if (corner[side] != 2) continue;
                int face = (axis + 1 + side) % 3;
                openOfAll[face] += 0.5 * weights[1 - side] * found.inside;
                open[face] += weights[1 - side] * found.facing * found.inside;
                met[face] += weights[1 - side] * found.facing;
            }
        }
    float surface = facing.x + facing.y + facing.z;
    float volumeInside = surface > 0.0 ? dot(facing, inside) / surface
                                       : max(min(inside.x, inside.y), min(max(inside.x, inside.y), inside.z));
    vec3 faces;
    for (int face = 0; face < 3; ++face)
        faces[face] = met[face] > 0.0 ? open[face] / met[face] : openOfAll[face];
    oFaces.rgb = faces;
    if (volumeInside < kLeast) return;
    oCell = vec4(volumeInside, surface, surface > 0.0 ? depth / surface : 0.0,
                 surface > 0.0 ? min(length(across) / surface, 1.0) : 1.0);
}
