// subsurface/receivers.frag: the places that the camera shows of scattering objects, one for a square of its pixels.
//
// out   oPlace  xyz: world; w: 1 + object, 0: no object that is no height field
// model the pixel right above the square's middle, or the first one of the square that shows anything
#include "views/view.glsl"
layout(std140) uniform ReceiversBlock {
    View view;
    int side; // of a square
} camera;
uniform sampler2D uSurface;
layout(location = 0) out vec4 oPlace;

const int kMeshFace = 6; // views/surface_pixel.glsl

void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * camera.side;
    ivec2 last = textureSize(uSurface, 0) - 1;
    oPlace = vec4(0.0);
    int count = camera.side * camera.side;
    for (int i = 0; i < count; ++i) {
        int at = (i + count / 2 + camera.side / 2) % count;
        ivec2 pixel = min(corner + ivec2(at % camera.side, at / camera.side), last);
        vec4 surface = texelFetch(uSurface, pixel, 0);
        int code = int(floor(surface.w));
        if ((code & 7) != kMeshFace) continue;
        vec3 toPlace = placeFrom(camera.view, vec2(pixel) + 0.5, surface.z);
        oPlace = vec4(camera.view.eye.xyz + toPlace, float(1 + (code >> 3)));
        return;
    }
}
