// views/paint.frag: what is painted on the nearest surface.
//
// out   oPaint  of views/paint.glsl: what leaves; ENTERING: what enters; ENTERING_MAP: its map alone
#pragma variants PAINTED
#pragma variants - ENTERING ENTERING_MAP
#include "views/paint.glsl"
layout(location = 0) out vec4 oPaint;

void main() {
#ifdef ENTERING
    oPaint = paintEntering();
#elif defined(ENTERING_MAP)
    oPaint = paintAt(uEntering);
#else
    oPaint = paintLeaving();
#endif
}
