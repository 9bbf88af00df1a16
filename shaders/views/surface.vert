// views/surface.vert: the 36 vertices of the box around a height field.
//
// out   vPosition [m]  point of the box, object space
#include "views/surface_block.glsl"
out vec3 vPosition;

const int kCorners[36] = int[36](0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5);

void main() {
    int corner = kCorners[gl_VertexID];
    vec3 unit = vec3(float(corner & 1), float((corner >> 1) & 1), float(corner >> 2));
    vec2 half_ = 0.5 * surface.field.texels * surface.field.texelSize;
    float low = surface.field.bottom;
    float high = surface.field.highest * surface.field.heightScale;
    // A flat field's box has no height: it needs some to be seen from above.
    float margin = 1e-3 * (half_.x + half_.y) + 1e-3 * (high - low);
    vPosition = mix(vec3(-half_, low - margin), vec3(half_, high + margin), unit);
    gl_Position = surface.clipFromObject * vec4(vPosition, 1.0);
}
