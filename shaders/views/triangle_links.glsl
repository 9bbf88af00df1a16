// views/triangle_links.glsl: two corners and three neighbours of a triangle, three bytes each, in four numbers of four.
// The third corner has the triangle's own number. Neighbours lie beyond the edges from corner 0 to 1, 1 to 2, 2 to 0.
const int kNoTriangle = 0xffffff;

// Where a number stands in images of rows of 2048 (views::kVerticesPerRow). Dividing would take longer than all else.
ivec2 tableTexel(int number) { return ivec2(number & 2047, number >> 11); }

struct Links {
    ivec2 corners;
    ivec3 across;
};

Links linksFrom(uvec4 texel) {
    uvec3 high = texel.xyz >> 24;
    ivec4 low = ivec4(texel & 0xffffffu);
    return Links(low.xy, ivec3(low.zw, int(high.x | high.y << 8 | high.z << 16)));
}

uvec4 texelFrom(Links links) {
    uint last = uint(links.across.z);
    return uvec4(uvec2(links.corners), uvec2(links.across)) |
           uvec4(last & 0xffu, (last >> 8) & 0xffu, last >> 16, 0u) << 24;
}
