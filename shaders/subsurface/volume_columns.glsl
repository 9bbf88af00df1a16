// subsurface/volume_columns.glsl: where lines along the axes meet the body's surface (subsurface/volume_column.frag).
//
// Lines stand half a cell apart, on the edges and through the middles of cells: uAlongX has one for each (y, z), uAlongY
// for (z, x), uAlongZ for (x, y).
#include "subsurface/volume.glsl"
#include "lib/octahedral.glsl"
uniform sampler2DArray uAlongX;
uniform sampler2DArray uAlongY;
uniform sampler2DArray uAlongZ;

// What a line meets of the surface within one cell.
struct Crossing {
    float inside; // part of the line's way through the cell that lies in the body
    float facing; // how much surface the line stands for where it meets some: |n_axis|, summed
    float across; // and its projection along the axis, outward
    float depth;  // of the cell's middle below the surface, times facing [widths]
};

void meet(vec4 surface, vec3 start, int axis, inout Crossing found) {
    vec3 normal = fromOctahedral(surface.xy);
    vec3 place = start; // from the cell's middle [widths]
    place[axis] = surface.z;
    float facing = abs(normal[axis]);
    found.facing += facing;
    found.across += normal[axis] < 0.0 ? -1.0 : 1.0;
    found.depth += facing * dot(normal, place);
}

// The surfaces of a line that stands at `start` from the cell's middle come in pairs: into the body, and out of it. One
// without the other, as where a mesh is open, counts for nothing.
Crossing crossingOf(sampler2DArray along, ivec2 line, int layers, float middle, vec3 start, int axis) {
    Crossing found = Crossing(0.0, 0.0, 0.0, 0.0);
    for (int layer = 0; layer + 1 < layers; layer += 2) {
        vec4 enter = texelFetch(along, ivec3(line, layer), 0);
        vec4 leave = texelFetch(along, ivec3(line, layer + 1), 0);
        if (leave.w == 0.0) break;
        enter.z = (enter.z - middle) / volume.low.w;
        leave.z = (leave.z - middle) / volume.low.w;
        found.inside += max(min(leave.z, 0.5) - max(enter.z, -0.5), 0.0);
        if (enter.z >= -0.5 && enter.z < 0.5) meet(enter, start, axis, found);
        if (leave.z > -0.5 && leave.z <= 0.5) meet(leave, start, axis, found);
    }
    return found;
}

Crossing crossingAlong(int axis, ivec3 cell, ivec2 corner) {
    int right = (axis + 1) % 3;
    int up = (axis + 2) % 3;
    ivec2 line = 2 * ivec2(cell[right], cell[up]) + corner;
    float middle = (float(cell[axis]) + 0.5) * volume.low.w;
    vec3 start = vec3(0.0);
    start[right] = 0.5 * float(corner.x - 1);
    start[up] = 0.5 * float(corner.y - 1);
    if (axis == 0) return crossingOf(uAlongX, line, volume.layers.x, middle, start, 0);
    if (axis == 1) return crossingOf(uAlongY, line, volume.layers.y, middle, start, 1);
    return crossingOf(uAlongZ, line, volume.layers.z, middle, start, 2);
}
