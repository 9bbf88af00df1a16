// frame/reproject_block.glsl: from which view of a picture to which, and the depths by which that goes.
#include "views/view.glsl"
layout(std140) uniform ReprojectBlock {
    View from;
    View to;
    vec2 cells; // into which the picture is cut along each side, with one more at each border
} views;
uniform sampler2D uDepth; // frame/depth.frag

const float kBeyond = 1e4;   // farthest depths, of what is nowhere
const float kOutline = 0.15; // part of its depth by which what stands before an outline is nearer

float nothingDepth() { return views.from.forward.w * (views.from.eye.w > 0.5 ? kBeyond : 1.0); }

float depthAt(vec2 pixel) {
    ivec2 last = textureSize(uDepth, 0) - 1;
    float depth = texelFetch(uDepth, clamp(ivec2(floor(pixel)), ivec2(0), last), 0).r;
    return depth > 0.0 ? depth : nothingDepth();
}

bool isApart(float nearest, float farthest) {
    float extent = views.from.eye.w > 0.5 ? nearest : views.from.forward.w - views.from.right.w;
    return farthest - nearest > kOutline * extent;
}
