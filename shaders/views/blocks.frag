// views/blocks.frag: depth ranges in blocks of 4, 16 and 64 pixels a side, one size above the other in one picture.
//
// in    uRanges  views/ranges.frag: blocks of 4
// out   oBlocks  the same of blocks of 4 `side`
layout(std140) uniform BlocksBlock {
    ivec2 size; // of uRanges
    int side;   // blocks of 4 along one of these: 1, 4, 16
    int row;    // that these begin at
} level;
uniform sampler2D uRanges;
layout(location = 0) out vec4 oBlocks;

void main() {
    ivec2 first = level.side * ivec2(gl_FragCoord.x, int(gl_FragCoord.y) - level.row);
    ivec2 last = min(first + level.side, level.size);
    vec4 ranges = vec4(1e30, -1e30, 1e30, -1e30);
    for (int y = first.y; y < last.y; ++y)
        for (int x = first.x; x < last.x; ++x) {
            vec4 fine = texelFetch(uRanges, ivec2(x, y), 0);
            ranges.xz = min(ranges.xz, fine.xz);
            ranges.yw = max(ranges.yw, fine.yw);
        }
    oBlocks = ranges;
}
