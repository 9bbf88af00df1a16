// views/second.glsl: which object a pixel of a view meets first, where the view shows what lies behind that.
uniform sampler2D uFirst; // views/surface_pixel.glsl

bool isFirst(int object) {
    int code = int(floor(texelFetch(uFirst, ivec2(gl_FragCoord.xy), 0).w));
    return code != 0 && code >> 3 == object;
}
