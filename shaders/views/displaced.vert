// views/displaced.vert: the 6 corners of the hull of each prism (views/prism.glsl), floor first, a little too large:
// sides are bent, and drivers round corners.
//
// out   vPrism  its number
#include "views/displaced_block.glsl"
#include "views/prism.glsl"
flat out int vPrism;

const float kMargin = 1.05;

void main() {
    vPrism = gl_VertexID / 6;
    Prism prism = prismOf(vPrism);
    int vertex = gl_VertexID % 6, corner = vertex % 3;
    float middle = 0.5 * (displaced.span.x + displaced.span.y);
    vec3 centre = middle * (prism.direction[0] + prism.direction[1] + prism.direction[2]) / 3.0;
    vec3 place = prism.place[corner] + (vertex < 3 ? displaced.span.x : displaced.span.y) * prism.direction[corner];
    gl_Position = displaced.clipFromObject * vec4(prism.middle + centre + kMargin * (place - centre), 1.0);
}
