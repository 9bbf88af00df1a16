// subsurface/layer.frag: a painted map on one object, in place of its light.
//
// in    uPaint      what is painted on these pixels (views/paint.frag): what leaves, or the map of what enters
// out   oColor.rgb  linear Rec. 709; a: 1. Layers of src/subsurface/Subsurface.h:
//                   1 translucency  grey, 0 black
//                   2 blur          grey: black a 16th as far as the material says, 0.5 as far, white 16 times
//                   3 glow          its colour
//                   4 outgoing      its colour
#include "views/surface_pixel.glsl"
layout(std140) uniform PaintLayerBlock {
    int object, layer;
} shown;
uniform sampler2D uPaint;
layout(location = 0) out vec4 oColor;

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.face != kMeshFace || pixel.object != shown.object) discard;
    vec4 paint = texelFetch(uPaint, ivec2(gl_FragCoord.xy), 0);
    vec3 color = paint.rgb;
    if (shown.layer == 1) color = vec3(paint.a);
    if (shown.layer == 2) color = vec3(0.5 - log2(paint.a) / 8.0);
    oColor = vec4(color, 1.0);
}
