// views/paint.frag: what is painted on the nearest surface.
//
// out   oPaint  of views/paint.glsl: what leaves; ENTERING: what enters
#include "views/paint.glsl"
layout(location = 0) out vec4 oPaint;

void main() {
#ifdef ENTERING
    oPaint = paintEntering();
#else
    oPaint = paintLeaving();
#endif
}
