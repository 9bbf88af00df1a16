// frame/beside.frag: the picture left of a divider; right of it its truth, or how far it is from that.
//
// in    uPicture  what frame/display.frag leaves with LINEAR: values | coverage
//       uTruth    the same quantity; row 0 is the top; a coverage below 0 is not known: the picture's holds
// out   oColor    as the display shows it, premultiplied by the coverage; nothing outside of the picture
#include "lib/heat.glsl"
#include "lib/shading.glsl"
layout(std140) uniform BesideBlock {
    vec4 scale, shift;    // as in frame/display.frag
    vec2 corner;          // lower left one of the picture on the screen, pixels
    float pixelsPerTexel;
    float divider;        // pixels from the screen's left side
    float full;           // difference that gets the last colour of the scale, > 0
    int encode;           // as in frame/display.frag
    int right;            // of the divider: 0 nothing, 1 truth, 2 error
} beside;
uniform sampler2D uPicture, uTruth;
layout(location = 0) out vec4 oColor;

vec3 encoded(vec3 value) {
    vec3 clamped = clamp(value, 0.0, 1.0);
    return vec3(srgbFromLinear(clamped.r), srgbFromLinear(clamped.g), srgbFromLinear(clamped.b));
}

vec4 displayed(vec4 values) {
    vec3 value = values.rgb * beside.scale.rgb + beside.shift.rgb;
    return vec4((beside.encode != 0 ? encoded(value) : clamp(value, 0.0, 1.0)) * values.a, values.a);
}

vec4 error(vec4 picture, vec4 truth) {
    float coverage = max(picture.a, truth.a);
    if (coverage <= 0.0) return vec4(0.0);
    vec3 difference = abs(picture.rgb - truth.rgb);
    float largest = max(difference.r, max(difference.g, difference.b));
    return vec4(encoded(heatColor(largest / beside.full)) * coverage, coverage);
}

void main() {
    ivec2 size = textureSize(uPicture, 0);
    ivec2 texel = ivec2(floor((gl_FragCoord.xy - beside.corner) / beside.pixelsPerTexel));
    oColor = vec4(0.0);
    if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size))) return;
    vec4 picture = texelFetch(uPicture, texel, 0);
    vec4 truth = texelFetch(uTruth, ivec2(texel.x, size.y - 1 - texel.y), 0);
    if (truth.a < 0.0) truth.a = picture.a;
    if (gl_FragCoord.x < beside.divider)
        oColor = displayed(picture);
    else if (beside.right == 1)
        oColor = displayed(truth);
    else if (beside.right == 2)
        oColor = error(picture, truth);
}
