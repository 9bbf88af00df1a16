// frame/copy.frag: a picture as it is.
uniform sampler2D uShown;
layout(location = 0) out vec4 oColor;

void main() { oColor = texelFetch(uShown, ivec2(gl_FragCoord.xy), 0); }
