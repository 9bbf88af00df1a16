// light/occlusion.glsl: visibility of a light sample at each pixel of a view.
//
// in    uOcclusion  1 - visibility of four samples a texel, in copies of the view side by side (light/occlusion.frag);
//                   USE_OCCLUSION: without it nothing stands in the way of any
#ifdef USE_OCCLUSION
uniform sampler2D uOcclusion;

// @param number   of the sample in its slice
// @param size     of the view, pixels
// @param columns  copies of the view in a row
float visibilityOf(int number, ivec2 size, int columns) {
    int copy = number >> 2;
    ivec2 corner = ivec2(copy % columns, copy / columns) * size;
    return 1.0 - texelFetch(uOcclusion, ivec2(gl_FragCoord.xy) + corner, 0)[number & 3];
}
#else
float visibilityOf(int number, ivec2 size, int columns) { return 1.0; }
#endif
