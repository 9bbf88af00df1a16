// frame/beside.frag: right of a divider another picture in place of the one that is there: a truth, an error, or the
// same scene drawn otherwise.
//
// in    uOther  linear values | coverage; row 0 is the top; a coverage below 0 is not known: taken for 1
// out   oColor  as the display shows it, premultiplied by the coverage; nothing beside it; left of the divider what
//               was there stays
#include "frame/shown.glsl"
layout(std140) uniform BesideBlock {
    vec4 scale, shift;    // as in frame/display.frag
    vec2 corner;          // lower left one of the other picture on the screen, pixels
    float pixelsPerTexel;
    float divider;        // pixels from the screen's left side
    float full;           // of an error: difference that gets the last colour of the scale, > 0
    int encode;           // as in frame/display.frag
    int isHeat;           // as in frame/display.frag
    int isError;          // the values are differences
} beside;
uniform sampler2D uOther;
layout(location = 0) out vec4 oColor;

vec3 shown(vec3 value) {
    if (beside.isError != 0) return encoded(heatColor(max(value.r, max(value.g, value.b)) / beside.full));
    return shownColor(value, beside.scale.rgb, beside.shift.rgb, beside.encode != 0, beside.isHeat != 0);
}

void main() {
    if (gl_FragCoord.x < beside.divider) discard;
    ivec2 size = textureSize(uOther, 0);
    ivec2 texel = ivec2(floor((gl_FragCoord.xy - beside.corner) / beside.pixelsPerTexel));
    oColor = vec4(0.0);
    if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size))) return;
    vec4 other = texelFetch(uOther, ivec2(texel.x, size.y - 1 - texel.y), 0);
    if (other.a < 0.0) other.a = 1.0;
    oColor = vec4(shown(other.rgb) * other.a, other.a);
}
