// views/texture_at.glsl: textures of meshes, bilinear between texels. A place on them has coordinates of two sets, the
// second in zw. How one texture lies is a code: along u + 3 * along v, as scene::Wrap counts, + 9 by the second set.
ivec2 wrapOf(float code) { return ivec2(int(code) % 3, int(code) / 3 % 3); }
vec2 coordinateOf(vec4 coordinates, float code) { return int(code) < 9 ? coordinates.xy : coordinates.zw; }

// The texel that stands for one beyond the edges. Far outside floats no longer tell texels apart.
int wrapped(int at, int size, int wrap) {
    if (wrap == 1) return clamp(at, 0, size - 1);
    int period = wrap == 2 ? 2 * size : size;
    int inside = at - period * int(floor(float(at) / float(period)));
    return inside < size ? inside : 2 * size - 1 - inside;
}

vec4 textureAt(sampler2D map, vec4 coordinates, float code) {
    ivec2 size = textureSize(map, 0), wrap = wrapOf(code);
    vec2 at = coordinateOf(coordinates, code) * vec2(size) - 0.5;
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 beside = ivec2(i & 1, i >> 1);
        vec2 share = mix(1.0 - f, f, vec2(beside));
        ivec2 texel = ivec2(wrapped(base.x + beside.x, size.x, wrap.x), wrapped(base.y + beside.y, size.y, wrap.y));
        sum += share.x * share.y * texelFetch(map, texel, 0);
    }
    return sum;
}
