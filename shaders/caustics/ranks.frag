// caustics/ranks.frag: how many lone cells (caustics/lone.frag) a row has up to each.
uniform sampler2D uLone;
layout(location = 0) out float oRank;

void main() {
    ivec2 cell = ivec2(gl_FragCoord.xy);
    oRank = 0.0;
    for (int x = 0; x <= cell.x; ++x) oRank += texelFetch(uLone, ivec2(x, cell.y), 0).r;
}
