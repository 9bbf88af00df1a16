// caustics/both.frag: depths of receivers and of those behind them, to be read back.
uniform sampler2D uShadow;
uniform sampler2D uBehind;
layout(location = 0) out vec2 oDepths;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    oDepths = vec2(texelFetch(uShadow, texel, 0).r, texelFetch(uBehind, texel, 0).r);
}
