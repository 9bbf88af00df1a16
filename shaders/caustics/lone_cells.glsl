// caustics/lone_cells.glsl: a point as large as a cell of the grid of rays for each of them with triangles that are no
// beams, of the light's view of what bends light: rays through its pixels are begun there alone.
#include "caustics/beams.glsl"

// @param view  pixels a side
void drawLoneCell(int view) {
    ivec2 grid = textureSize(uBeams, 0);
    ivec2 cell = ivec2(gl_VertexID % grid.x, gl_VertexID / grid.x);
    float alone = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 square = cell - ivec2(i & 1, i >> 1);
        alone += isAlone(square, 0, grid) + isAlone(square, 1, grid);
    }
    gl_PointSize = float(view / grid.x);
    gl_Position = alone > 0.0 ? vec4(2.0 * (vec2(cell) + 0.5) / vec2(grid) - 1.0, 0.0, 1.0) : vec4(2.0, 2.0, 0.0, 1.0);
}
