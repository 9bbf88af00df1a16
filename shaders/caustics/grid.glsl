// caustics/grid.glsl: the rays of a light as the vertices of a grid of triangles.
//
// Square (i, j) of rays (i, j) ... (i + 1, j + 1) is cut from its right lower to its left upper corner: triangle 0 is
// the one at its lowest ray, triangle 1 the other.
// A texel of the shares (caustics/share.frag) says which of the two are there.
uniform sampler2D uLanding;

ivec2 cornerOf(ivec2 square, int triangle, int corner) {
    ivec2 low = corner == 0 ? ivec2(triangle, 0) : corner == 1 ? ivec2(1, triangle) : ivec2(0, 1);
    return square + low;
}
