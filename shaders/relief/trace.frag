// relief/trace.frag: d of texels of one height field for many directions, four a pixel: what the transfer is made of.
//
// in    uLights   the directions, in object space, as lights of kind 0 (relief/model.glsl)
// out   oTraced   d for directions 4j to 4j + 3
//
// SCATTERED: a row for each of a low-discrepancy set of texels, column j. Else: a tile of texels, tile.zw wide and high
// from tile.xy on, once for each j, 16 tiles a row.
#pragma variants - SCATTERED
#include "relief/model.glsl"
layout(location = 0) out vec4 oTraced;

// Shading point of a texel of the transfer, whose texels may be fewer than the field's: at its centre.
Shading shadingAt(vec2 uv) {
    Shading p;
    p.g = 0.5 + uv * relief.field.texels;
    p.reference = heightAt(p.g, relief.field);
    p.z = p.reference * relief.field.heightScale;
    p.normal = normalAt(p.g, relief.field);
    p.position = vec3(objectFromGrid(p.g, relief.field), p.z);
    p.offset = 0.0;
    return p;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
#ifdef SCATTERED
    // The R2 sequence (Roberts 2018): powers of the plastic number fill the square evenly for any count.
    vec2 place = fract(0.5 + float(pixel.y) * vec2(0.75487767, 0.56984029));
    Shading p = shadingAt((floor(place * relief.field.texels) + 0.5) / relief.field.texels);
    int first = 4 * pixel.x;
#else
    ivec2 block = pixel / relief.tile.zw;
    vec2 texel = vec2(relief.tile.xy + pixel % relief.tile.zw) + 0.5;
    Shading p = shadingAt(min(texel / relief.grid, vec2(1.0)));
    int first = 4 * (block.x + 16 * block.y);
#endif
    int steps;
    vec4 d;
    for (int i = 0; i < 4; ++i)
        d[i] = illumination(p, lightAt(relief.firstLight + first + i, p), steps);
    oTraced = d;
}
