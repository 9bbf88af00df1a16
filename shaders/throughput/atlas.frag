// throughput/atlas.frag: the light of an object's atlas, in a square of the picture.
//
// in    uLight  an image of the atlas [W/m²]; a: 0 where it shows nothing
// out   oColor
layout(std140) uniform AtlasBlock {
    ivec2 corner; // of the square, pixels
    int side;
} atlas;
uniform sampler2D uLight;
layout(location = 0) out vec4 oColor;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy) - atlas.corner;
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(atlas.side)))) discard;
    ivec2 size = textureSize(uLight, 0);
    vec4 light = texelFetch(uLight, (2 * at + 1) * size / (2 * atlas.side), 0);
    if (light.a == 0.0) discard;
    oColor = vec4(light.rgb, 1.0);
}
