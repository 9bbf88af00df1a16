// caustics/beams.glsl: which triangles of the grid of rays are beams, and what is left to rays of their own.
uniform sampler2D uBeams; // caustics/beams.frag

float isAlone(ivec2 square, int triangle, ivec2 grid) {
    if (any(lessThan(square, ivec2(0))) || any(greaterThanEqual(square, grid - 1))) return 1.0;
    vec4 both = texelFetch(uBeams, square, 0);
    return (triangle == 0 ? both.x : both.z) == 0.0 ? 1.0 : 0.0;
}

// The share of a pixel that lies in triangles that are no beams.
//
// side  pixels along a cell, odd: rays of the grid run through the middle ones
float loneShare(ivec2 pixel, int side, ivec2 grid) {
    ivec2 place = pixel - side / 2 + side; // from the middle of cell (-1, -1): not below 0
    ivec2 square = place / side - 1;
    ivec2 within = place - side * (square + 1);
    ivec2 left = square - ivec2(1, 0);
    ivec2 below = square - ivec2(0, 1);
    float low = isAlone(square, 0, grid);
    if (within == ivec2(0)) // a corner of six triangles
        return (low + isAlone(left, 0, grid) + isAlone(left, 1, grid) + isAlone(below, 0, grid) +
                isAlone(below, 1, grid) + isAlone(square - 1, 1, grid)) / 6.0;
    if (within.x == 0) return 0.5 * (low + isAlone(left, 1, grid));
    if (within.y == 0) return 0.5 * (low + isAlone(below, 1, grid));
    if (within.x + within.y < side) return low;
    float high = isAlone(square, 1, grid);
    return within.x + within.y > side ? high : 0.5 * (low + high);
}
