// gl/imgui.frag: colour of a panel pixel.
//
// in    vColor   encoded colour (sRGB), straight alpha
//       uFont    font atlas: coverage, 1 on plain surfaces
// out   oColor   straight alpha; blending makes it premultiplied
uniform sampler2D uFont;
in vec2 vTexel;
in vec4 vColor;
layout(location = 0) out vec4 oColor;

void main() { oColor = vec4(vColor.rgb, vColor.a * texture(uFont, vTexel).r); }
