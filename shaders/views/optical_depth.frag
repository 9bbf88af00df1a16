// views/optical_depth.frag: what blended meshes take of the light on its way to the first surface behind them.
//
// in    uColor         views/holes.glsl
//       uFirst         that surface: OF_LAYERS the first layer (views/layer_texel.glsl), else views/solid.frag
// out   oOpticalDepth  -ln(1 - opacity) of each of their surfaces, which add up
#pragma variants HOLES
#pragma variants - OF_LAYERS
#include "views/mesh_block.glsl"
#include "views/holes.glsl"
in float vDepth;
layout(location = 0) out float oOpticalDepth;
#ifdef OF_LAYERS
uniform highp sampler2DArray uFirst;
float firstDepth(ivec2 pixel) { return texelFetch(uFirst, ivec3(pixel, 0), 0).x; }
#else
uniform sampler2D uFirst;
float firstDepth(ivec2 pixel) { return texelFetch(uFirst, pixel, 0).z; }
#endif
const float kLeast = 1e-5; // that is let through: half floats add up what is left of it

void main() {
    if (vDepth >= firstDepth(ivec2(gl_FragCoord.xy))) discard;
    oOpticalDepth = -log(max(1.0 - opacityHere(), kLeast));
}
