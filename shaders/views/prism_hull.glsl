// views/prism_hull.glsl: the 6 corners of the hull of each prism (views/prism.glsl), floor first, a little too large: sides
// are bent, and drivers round corners.
//
// out   vPrism  its number
#include "views/displaced_block.glsl"
#include "views/prism.glsl"
flat out int vPrism;

const float kMargin = 1.05;

// How much larger the hull must be than the prism. A side whose ends lean apart is bent: it stands up to a quarter of
// what they part at one end beyond its two triangles, which the circle inside the smaller cap is held against.
float marginOf(Prism prism) {
    float bent = 0.0, inside = 1e30;
    for (int cap = 0; cap < 2; ++cap) {
        float z = cap == 0 ? displaced.span.x : displaced.span.y;
        vec3 a = prism.place[0] + z * prism.direction[0], b = prism.place[1] + z * prism.direction[1];
        vec3 c = prism.place[2] + z * prism.direction[2];
        inside = min(inside, length(cross(b - a, c - a)) / (distance(a, b) + distance(b, c) + distance(c, a)));
    }
    for (int i = 0; i < 3; ++i) {
        int next = (i + 1) % 3;
        vec3 across = cross(prism.place[next] - prism.place[i], prism.direction[i] + prism.direction[next]);
        bent = max(bent, abs(dot(prism.direction[next] - prism.direction[i], normalize(across))));
    }
    return kMargin + 0.25 * (displaced.span.y - displaced.span.x) * bent / max(inside, 1e-6);
}

void main() {
    vPrism = gl_VertexID / 6;
    Prism prism = prismOf(vPrism);
    int vertex = gl_VertexID % 6, corner = vertex % 3;
    float middle = 0.5 * (displaced.span.x + displaced.span.y);
    vec3 centre = middle * (prism.direction[0] + prism.direction[1] + prism.direction[2]) / 3.0;
    vec3 place = prism.place[corner] + (vertex < 3 ? displaced.span.x : displaced.span.y) * prism.direction[corner];
    gl_Position = displaced.clipFromObject * vec4(prism.middle + centre + marginOf(prism) * (place - centre), 1.0);
}
