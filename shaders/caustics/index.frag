// caustics/index.frag: the places into which lone cells (caustics/lone.frag) are packed, and back.
//
// in    uRanks  caustics/ranks.frag
//       uRows   caustics/rows.frag
// out   oIndex  caustics/lone_cells.glsl
uniform sampler2D uRanks;
uniform sampler2D uRows;
layout(location = 0) out vec4 oIndex;

int loneIn(ivec2 cell) { return int(texelFetch(uRanks, cell, 0).r); } // up to this one in its row
int loneUpTo(int row) { return row < 0 ? 0 : int(texelFetch(uRows, ivec2(0, row), 0).r); }

const int kMostHalvings = 10; // of a grid's side

ivec2 cellOf(int number, ivec2 grid) {
    ivec2 low = ivec2(0), high = grid - 1;
    for (int i = 0; i < kMostHalvings && low.y < high.y; ++i) {
        int middle = (low.y + high.y) >> 1;
        if (loneUpTo(middle) > number) high.y = middle;
        else low.y = middle + 1;
    }
    int within = number - loneUpTo(low.y - 1);
    for (int i = 0; i < kMostHalvings && low.x < high.x; ++i) {
        int middle = (low.x + high.x) >> 1;
        if (loneIn(ivec2(middle, low.y)) > within) high.x = middle;
        else low.x = middle + 1;
    }
    return low;
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    ivec2 grid = textureSize(uRanks, 0);
    int before = here.x == 0 ? 0 : loneIn(here - ivec2(1, 0));
    int number = loneIn(here) == before ? -1 : loneUpTo(here.y - 1) + before;
    oIndex = vec4(cellOf(here.y * grid.x + here.x, grid), number, loneUpTo(grid.y - 1));
}
