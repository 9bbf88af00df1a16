// frame/depth.frag: how far what a pixel shows lies from the eye, by which it is reprojected.
//
// in    uSolid   r: depth of its first opaque surface [m], a: 0 where there is none (views/geometry.frag)
//       uLayers  OF_LAYERS: what is clear and seen before it (views/layer_texel.glsl)
// out   oDepth   depth of the nearest of both [m]; 0: nothing
#pragma variants - OF_LAYERS
uniform sampler2D uSolid;
#ifdef OF_LAYERS
uniform sampler2DArray uLayers;
#endif
layout(location = 0) out float oDepth;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 solid = texelFetch(uSolid, pixel, 0);
    oDepth = solid.a > 0.0 ? solid.r : 0.0;
#ifdef OF_LAYERS
    vec4 clear = texelFetch(uLayers, ivec3(pixel, 0), 0);
    if (clear.w > 0.0 && (oDepth == 0.0 || clear.x < oDepth)) oDepth = clear.x;
#endif
}
