// subsurface/volume.glsl: a body cut into cells, their slices side by side in one image.
//
// Cell (i, j, k) has its middle at low + (i + 1/2, j + 1/2, k + 1/2) * width. The outermost cells lie outside the body.
#include "views/view.glsl"
layout(std140) uniform VolumeBlock {
    View view;       // the camera's
    vec4 low;        // world; w: width of a cell [m]
    ivec4 cells;     // along x, y, z; w: slices in a row of the image
    ivec4 layers;    // surfaces behind each other along x, y, z
    vec4 diffusion;  // rgb: D over the width; a: 2 A of phi = 2 A D dphi/dn at the surface
    vec4 absorption; // rgb: sigma_a times the width
    vec4 extinction; // rgb: sigma_t' [1/m]; a: unused
    vec4 albedo;     // rgb: alpha'; a: extinction by which the depths of sources are chosen [1/m]
    vec4 omega;      // rgb: Chebyshev's factor of this round
    int object;      // in the scene
    int columns;     // points in a row
} volume;

ivec2 texelOf(ivec3 cell) {
    return cell.xy + volume.cells.xy * ivec2(cell.z % volume.cells.w, cell.z / volume.cells.w);
}

// Texels right of the last slice belong to cells beyond the body.
ivec3 cellAt(ivec2 texel) {
    ivec2 tile = texel / volume.cells.xy;
    return ivec3(texel - tile * volume.cells.xy, tile.y * volume.cells.w + tile.x);
}

vec3 middleOf(ivec3 cell) { return volume.low.xyz + (vec3(cell) + 0.5) * volume.low.w; }

// Cells around a place, of which the one with the lowest numbers comes back, and the place between their middles.
ivec3 cellsAround(vec3 place, out vec3 between) {
    vec3 at = (place - volume.low.xyz) / volume.low.w - 0.5;
    vec3 base = clamp(floor(at), vec3(0.0), vec3(volume.cells.xyz - 2));
    between = clamp(at - base, vec3(0.0), vec3(1.0));
    return ivec3(base);
}

float shareOf(ivec3 corner, vec3 between) {
    vec3 share = mix(1.0 - between, between, vec3(corner));
    return share.x * share.y * share.z;
}

// Of light that is laid down between middles, the part of a cell that has so much volume: by distance alone, so that
// the light keeps its place.
float takes(float volumeInside) { return volumeInside > 0.0 ? 1.0 : 0.0; }

ivec3 cornerOf(int number) { return ivec3(number & 1, (number >> 1) & 1, number >> 2); }

// Flux through the surface over the fluence at a depth of so many widths below it: linear towards it, with the mixed
// condition there. A middle may lie outside of its cell's part of the body, at a depth below 0: there what is linear
// could change its sign, and only its slope at the surface is kept.
vec3 leavingFrom(float depth) {
    vec3 way = depth / volume.diffusion.rgb;
    if (depth >= 0.0) return 1.0 / (volume.diffusion.a + way);
    return (volume.diffusion.a - way) / (volume.diffusion.a * volume.diffusion.a);
}
