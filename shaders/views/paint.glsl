// views/paint.glsl: what is painted on an object at a place of its atlas (src/scene/Painting.h).
//
// in    vPaint     place [texels]; the middle of the first texel is (0.5, 0.5)
//       uEntering  rgb: M_i; a: M_d
//       uLeaving   rgb: factor of what leaves; a: translucency
// model bilinear, by hand: 32-bit floats need not be filtered
in vec2 vPaint;
uniform sampler2D uEntering;
uniform sampler2D uLeaving;

vec4 paintAt(sampler2D map) {
    ivec2 last = textureSize(map, 0) - 1;
    vec2 at = clamp(vPaint - 0.5, vec2(0.0), vec2(last));
    ivec2 low = ivec2(at);
    ivec2 high = min(low + 1, last);
    vec2 share = at - vec2(low);
    vec4 a = texelFetch(map, low, 0);
    vec4 b = texelFetch(map, ivec2(high.x, low.y), 0);
    vec4 c = texelFetch(map, ivec2(low.x, high.y), 0);
    vec4 d = texelFetch(map, high, 0);
    // By differences: four equal values stay what they are.
    vec4 upper = a + share.x * (b - a);
    vec4 lower = c + share.x * (d - c);
    return upper + share.y * (lower - upper);
}

// rgb: factor of the light that enters; a: M_d
vec4 paintEntering() {
    vec4 entering = paintAt(uEntering);
    return vec4(entering.rgb * paintAt(uLeaving).a, entering.a);
}

// rgb: factor of the light that leaves; a: translucency
vec4 paintLeaving() { return paintAt(uLeaving); }
