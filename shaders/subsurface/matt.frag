// subsurface/matt.frag: painted objects as if they were opaque.
uniform sampler2D uShown;
layout(location = 0) out vec4 oColor;

void main() { oColor = texelFetch(uShown, ivec2(gl_FragCoord.xy), 0); }
