// throughput/between.glsl: an image of an atlas between its texels.

// Bilinear of those that show something: a is 0 of others. place [texels]
vec4 betweenTexels(sampler2D image, vec2 place) {
    ivec2 last = textureSize(image, 0) - 1;
    vec2 low = floor(place - 0.5);
    vec2 part = place - 0.5 - low;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 step = ivec2(i & 1, i >> 1);
        vec4 texel = texelFetch(image, clamp(ivec2(low) + step, ivec2(0), last), 0);
        float weight = (step.x == 1 ? part.x : 1.0 - part.x) * (step.y == 1 ? part.y : 1.0 - part.y);
        sum += weight * texel.a * vec4(texel.rgb, 1.0);
    }
    return sum.a > 0.0 ? sum / sum.a : vec4(0.0);
}
