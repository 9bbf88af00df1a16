// caustics/lone_cells.vert: over the rows of images that hold packed cells (caustics/lone_cells.glsl).
//
// in  gl_VertexID  of two triangles
#include "caustics/lone_cells.glsl"
#include "caustics/square.glsl"

void main() {
    ivec2 grid = textureSize(uIndex, 0);
    int rows = (loneCells() + grid.x - 1) / grid.x;
    vec2 corner = cornerOfSquare(gl_VertexID);
    gl_Position = vec4(2.0 * corner * vec2(1.0, float(rows) / float(grid.y)) - 1.0, 0.0, 1.0);
}
