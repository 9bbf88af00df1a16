// views/voxel_bounds.frag: depth of the first and of the last surface of a pixel (thesis 2008, 3.3).
//
// out   oNearest   -depth [m] along the view
//       oFarthest  depth
// model drawn with MAX: the larger of negated depths is the nearer one. ONLY_NEAREST, ONLY_FARTHEST: one of them by the
//       depth test, where 32-bit floats do not blend
#pragma variants - ONLY_NEAREST ONLY_FARTHEST
#include "views/mesh_block.glsl"
in float vDepth;
#if defined(ONLY_NEAREST)
layout(location = 0) out float oNearest;
void main() {
    oNearest = -vDepth;
    gl_FragDepth = bufferDepth(mesh.view, vDepth);
}
#elif defined(ONLY_FARTHEST)
layout(location = 0) out float oFarthest;
void main() {
    oFarthest = vDepth;
    gl_FragDepth = 1.0 - bufferDepth(mesh.view, vDepth);
}
#else
layout(location = 0) out float oNearest;
layout(location = 1) out float oFarthest;
void main() {
    oNearest = -vDepth;
    oFarthest = vDepth;
}
#endif
