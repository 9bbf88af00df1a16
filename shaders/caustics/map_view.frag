// caustics/map_view.frag: a caustic map as a picture, as large as fits.
//
// in    uMap     flux on each texel; 1: what the light leaves on one undisturbed
//       uShadow  depths of the receivers, seen from the light
// out   oValue   rgb: mean over the texels in the pixel; a: 1 where a receiver lies
layout(std140) uniform MapBlock {
    vec2 corner;  // of the map in the picture, pixels
    float texels; // along a side of a pixel
} shown;
uniform sampler2D uMap;
uniform sampler2D uShadow;
layout(location = 0) out vec4 oValue;

const float kFar = 1e29;      // beyond it there is nothing
const float kMostTaps = 16.0; // along a side of a pixel

void main() {
    oValue = vec4(0.0);
    vec2 low = (gl_FragCoord.xy - 0.5 - shown.corner) * shown.texels;
    ivec2 size = textureSize(uShadow, 0); // light on what lies behind stands above it
    float taps = clamp(ceil(shown.texels), 1.0, kMostTaps);
    float count = 0.0;
    for (float y = 0.5; y < taps; ++y)
        for (float x = 0.5; x < taps; ++x) {
            ivec2 texel = ivec2(floor(low + vec2(x, y) / taps * shown.texels));
            if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, size))) continue;
            if (texelFetch(uShadow, texel, 0).r > kFar) continue;
            oValue.rgb += texelFetch(uMap, texel, 0).rgb;
            ++count;
        }
    if (count > 0.0) oValue = vec4(oValue.rgb / count, 1.0);
}
