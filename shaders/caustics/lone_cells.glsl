// caustics/lone_cells.glsl: the cells of the grid of rays with triangles that are no beams, packed: in these alone rays of
// their own begin, one for each or for each of its pixels.
//
// Images of these rays are as large as the grid or the light's view. Cell number n of them lies in column n % grid.x and
// row n / grid.x, so that what is drawn of them is dense: from the lowest row up to the last one that any is in.
uniform sampler2D uIndex; // rg: the cell packed here; b: number of the cell that is here unpacked, -1: of none; a: of all

int loneCells() { return int(texelFetch(uIndex, ivec2(0), 0).a); }

// The cell that is packed at a place; only of places before loneCells().
ivec2 packedAt(ivec2 place) { return ivec2(texelFetch(uIndex, place, 0).rg); }

int numberOf(ivec2 cell) {
    bool isThere = all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, textureSize(uIndex, 0)));
    return isThere ? int(texelFetch(uIndex, cell, 0).b) : -1;
}
