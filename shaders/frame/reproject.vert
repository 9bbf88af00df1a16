// frame/reproject.vert: a picture as a mesh that stands where its surfaces are, seen by another camera (temporal
// reprojection).
//
// in    gl_VertexID     twelve a cell of the picture: its sheet, and what stands before an outline in it
//       uDepth          frame/depth.frag
// out   vPixel          of the picture
//       vNearest flat   depth of what stands before an outline [m]; else 0
//       vBehind flat    the pixel that the sheet of an outline shows; else x < 0
// model a surface keeps its colour while the camera moves; the sheet of a cell through which an outline runs shows what
//       lies behind it, and before it stands what is nearest; beside the picture its border goes on a little
#include "frame/reproject_block.glsl"
out vec2 vPixel;
flat out float vNearest;
flat out vec2 vBehind;

const vec2 kCorners[6] = vec2[6](vec2(0, 0), vec2(1, 0), vec2(0, 1), vec2(0, 1), vec2(1, 0), vec2(1, 1));

const float kBeside = 0.25; // of the picture, along each side

// The middle of a pixel; nodes at the border lie beside the picture.
vec2 pixelOfNode(vec2 node) {
    vec2 part = (node - 1.0) / views.cells;
    vec2 inside = floor(clamp(part, 0.0, 1.0) * (views.from.size - 1.0) + 0.5) + 0.5;
    return inside + kBeside * views.from.size * (step(1.0001, part) - step(part, vec2(-0.0001)));
}

void main() {
    int cell = gl_VertexID / 12, vertex = gl_VertexID % 12;
    int columns = int(views.cells.x) + 2;
    vec2 low = vec2(cell % columns, cell / columns);
    float nearest = 1e30, farthest = 0.0;
    vec2 behind = vec2(0.0);
    for (int i = 0; i < 4; ++i) {
        vec2 pixel = pixelOfNode(low + vec2(i & 1, i >> 1));
        float depth = depthAt(pixel);
        if (depth > farthest) behind = pixel;
        nearest = min(nearest, depth);
        farthest = max(farthest, depth);
    }
    bool hasOutline = isApart(nearest, farthest), isBefore = vertex >= 6;
    vPixel = pixelOfNode(low + kCorners[vertex % 6]);
    vNearest = isBefore ? nearest : 0.0;
    vBehind = hasOutline && !isBefore ? behind : vec2(-1.0);
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0); // outside
    if (isBefore && !hasOutline) return;
    float depth = isBefore ? nearest : depthAt(vPixel);
    vec3 place = views.from.eye.xyz + placeFrom(views.from, vPixel, depth);
    vec3 seen = inView(views.to, place - views.to.eye.xyz);
    bool perspective = views.to.eye.w > 0.5;
    vec2 at = 2.0 * (seen.xy + (perspective ? seen.z : 1.0) * views.to.middle) / views.to.size;
    gl_Position = perspective ? vec4(at - seen.z, seen.z - 2.0 * views.to.right.w, seen.z)
                              : vec4(at - 1.0, 2.0 * bufferDepth(views.to, seen.z) - 1.0, 1.0);
}
