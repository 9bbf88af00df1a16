// caustics/rows.frag: how many lone cells there are up to the end of each row, in the only column.
uniform sampler2D uRanks;
layout(location = 0) out float oCount;

void main() {
    int last = textureSize(uRanks, 0).x - 1;
    oCount = 0.0;
    for (int y = 0; y <= int(gl_FragCoord.y); ++y) oCount += texelFetch(uRanks, ivec2(last, y), 0).r;
}
