// subsurface/volume_columns.glsl: where lines along the axes through the middles of cells meet the body's surface
// (subsurface/volume_column.frag).
//
// uAlongX has a column for each (y, z), uAlongY for (z, x), uAlongZ for (x, y).
#include "subsurface/volume.glsl"
#include "lib/octahedral.glsl"
uniform sampler2DArray uAlongX;
uniform sampler2DArray uAlongY;
uniform sampler2DArray uAlongZ;

// Whether so deep along a line an odd number of surfaces has been met.
bool isOdd(sampler2DArray along, ivec2 column, int layers, float depth) {
    bool odd = false;
    for (int layer = 0; layer < layers; ++layer) {
        vec4 surface = texelFetch(along, ivec3(column, layer), 0);
        if (surface.w == 0.0 || surface.z >= depth) break;
        odd = !odd;
    }
    return odd;
}

// x: how far the nearest surface lies beyond (side 1) or before (side -1) this depth [m]; y: how much it faces the
// line, |cos|. Lines that miss what another axis has seen: half a cell, at a mean angle.
vec2 nearest(sampler2DArray along, ivec2 column, int layers, float depth, float side, int axis) {
    float width = volume.low.w;
    vec2 found = vec2(0.5 * width, 0.577);
    float best = 1.5 * width;
    for (int layer = 0; layer < layers; ++layer) {
        vec4 surface = texelFetch(along, ivec3(column, layer), 0);
        if (surface.w == 0.0) break;
        float away = side * (surface.z - depth);
        if (away < 0.0 || away > best) continue;
        best = away;
        found = vec2(away, abs(fromOctahedral(surface.xy)[axis]));
    }
    return found;
}
