// caustics/sixths.glsl: the parts of a ray's cell that lie in the six triangles around the ray (caustics/grid.glsl).
//
// Bits of a number: 0: triangle 0 of the ray's own square; 1, 2: triangles 0 and 1 of the square to the left; 3, 4: of
// the one below; 5: triangle 1 of the one to the left below.

// Those on which a pixel beside the cell's middle lies, borders included.
int sixthsOf(ivec2 beside) {
    bool left = beside.x <= 0;
    bool right = beside.x >= 0;
    bool below = beside.y <= 0;
    bool above = beside.y >= 0;
    int sum = beside.x + beside.y;
    return (right && above ? 1 : 0) + (left && above && sum <= 0 ? 2 : 0) + (left && above && sum >= 0 ? 4 : 0) +
           (right && below && sum <= 0 ? 8 : 0) + (right && below && sum >= 0 ? 16 : 0) + (left && below ? 32 : 0);
}

// The one in which a triangle's corner lies (cornerOf).
int sixthOf(int triangle, int corner) {
    if (triangle == 0) return corner == 0 ? 1 : corner == 1 ? 2 : 8;
    return corner == 0 ? 4 : corner == 1 ? 32 : 16;
}
