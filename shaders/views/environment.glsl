// views/environment.glsl: what a lat-long map shows in a direction.
//
// in    uEnvironment  radiance; row 0 = +y, centre column = -z, to the right = +x
uniform sampler2D uEnvironment;

vec3 mapTexel(ivec2 texel, ivec2 size) {
    texel.x = texel.x < 0 ? texel.x + size.x : texel.x >= size.x ? texel.x - size.x : texel.x;
    return texelFetch(uEnvironment, ivec2(texel.x, clamp(texel.y, 0, size.y - 1)), 0).rgb;
}

// Bilinear between the middles of the map's pixels, around its seam. The direction is the map's and unit.
vec3 mapRadiance(vec3 direction) {
    const float kPi = 3.14159265;
    ivec2 size = textureSize(uEnvironment, 0);
    float aside = length(direction.xz); // from the pole: an arc cosine would lose half the digits there
    float azimuth = aside > 0.0 ? atan(direction.x, -direction.z) : 0.0;
    vec2 at = vec2(0.5 + azimuth / (2.0 * kPi), atan(aside, direction.y) / kPi) * vec2(size) - 0.5;
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    vec3 upper = mix(mapTexel(base, size), mapTexel(base + ivec2(1, 0), size), f.x);
    vec3 lower = mix(mapTexel(base + ivec2(0, 1), size), mapTexel(base + ivec2(1, 1), size), f.x);
    return mix(upper, lower, f.y);
}
