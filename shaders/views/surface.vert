// views/surface.vert: the 36 vertices of the box around a height field. The box only chooses the pixels; it is a
// little too large, so that a driver that rounds its corners (SwiftShader: to 1/16 pixel) loses none.
#include "views/surface_block.glsl"

const int kCorners[36] = int[36](0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5);

void main() {
    int bits = kCorners[gl_VertexID];
    vec3 unit = vec3(float(bits & 1), float((bits >> 1) & 1), float(bits >> 2));
    vec2 half_ = 0.5 * surface.field.texels * surface.field.texelSize;
    float low = surface.field.bottom;
    float high = surface.field.highest * surface.field.heightScale;
    float margin = 2e-3 * (half_.x + half_.y + high - low);
    vec3 corner = mix(vec3(-half_, low) - margin, vec3(half_, high) + margin, unit);
    gl_Position = surface.clipFromObject * vec4(corner, 1.0);
}
