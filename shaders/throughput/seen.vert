// throughput/seen.vert: the triangles of a baked object in a view.
//
// in    uTriangles  three texels each: places of their corners, object's space times its scale [m]
//       uCharts     the same: places in the atlas [texels]
// out   vPlace [texels]
layout(std140) uniform SeenBlock {
    mat4 clipFromBody;
} seen;
uniform sampler2D uTriangles;
uniform sampler2D uCharts;
out vec2 vPlace;

void main() {
    int width = textureSize(uTriangles, 0).x;
    ivec2 at = ivec2(gl_VertexID % width, gl_VertexID / width);
    vPlace = texelFetch(uCharts, at, 0).xy;
    gl_Position = seen.clipFromBody * vec4(texelFetch(uTriangles, at, 0).xyz, 1.0);
}
