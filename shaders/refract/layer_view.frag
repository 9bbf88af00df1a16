// refract/layer_view.frag: one layer of a view as a picture.
//
// in    uLayers  views/layer_texel.glsl
// out   oValue   SHOW_DEPTH: m along the view; SHOW_NORMAL: outward, world; else a colour for each object, darker
//                where its inside faces the eye; a: 1 where the layer has a surface
#pragma variants - SHOW_DEPTH SHOW_NORMAL
#include "views/layer_texel.glsl"
layout(std140) uniform LayerBlock {
    int layer;
} shown;
uniform sampler2DArray uLayers;
layout(location = 0) out vec4 oValue;

// Hues that lie a golden section apart: neighbours in the list differ most.
vec3 colorOf(int object) {
    float hue = fract(0.08 + 0.618034 * float(object));
    return clamp(abs(fract(hue + vec3(0.0, 2.0, 1.0) / 3.0) * 6.0 - 3.0) - 1.0, 0.1, 1.0);
}

void main() {
    oValue = vec4(0.0);
    vec4 texel = texelFetch(uLayers, ivec3(gl_FragCoord.xy, shown.layer), 0);
    if (texel.w == 0.0) return;
#if defined(SHOW_DEPTH)
    oValue = vec4(vec3(texel.x), 1.0);
#elif defined(SHOW_NORMAL)
    oValue = vec4(normalOf(texel), 1.0);
#else
    oValue = vec4(colorOf(objectOf(texel)) * (facesView(texel) ? 1.0 : 0.45), 1.0);
#endif
}
