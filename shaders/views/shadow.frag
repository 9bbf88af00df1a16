// views/shadow.frag: how far from a light the nearest surface is that stands in its way.
//
// out   oDepth  [m]  along the view's forward: evenly spaced, which a depth buffer of a perspective view is not
#include "views/mesh_block.glsl"
in float vDepth;
layout(location = 0) out float oDepth;

void main() {
    oDepth = vDepth;
    gl_FragDepth = bufferDepth(mesh.view, vDepth);
}
