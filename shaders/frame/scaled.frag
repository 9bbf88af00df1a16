// frame/scaled.frag: a preview of fewer pixels, smoothed between them.
//
// in    uShown  as frame/display.frag shows it: a highlight is no brighter than white before it is spread
// out   oColor  the same with as many pixels as the target
layout(std140) uniform ScaledBlock {
    vec2 pixels; // of the target
} scaled;
uniform sampler2D uShown; // filtered between texels
layout(location = 0) out vec4 oColor;

void main() { oColor = texture(uShown, gl_FragCoord.xy / scaled.pixels); }
