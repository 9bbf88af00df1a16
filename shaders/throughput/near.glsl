// throughput/near.glsl: what texels around leave at a place: their shares, by the near part of R_d, of its integral over
// the surface there.
uniform sampler2D uEntered; // [W/m²] throughput/enter.frag
uniform sampler2D uPlace;   // throughput/place.frag
uniform sampler2D uNear;    // near part of R_d at r = cut (i / (n - 1))² [1/m²]
uniform sampler2D uReach;   // that integral

// at: the texel of the place [m, object's space times its scale]; radius [texels], cut [m]: how far they do
vec3 nearLight(ivec2 at, vec3 place, vec3 reach, int radius, float cut) {
    ivec2 low = max(at - radius, ivec2(0));
    ivec2 high = min(at + radius, textureSize(uPlace, 0) - 1);
    float entries = float(textureSize(uNear, 0).x - 1);
    vec3 sum = vec3(0.0), weights = vec3(0.0);
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
            vec4 other = texelFetch(uPlace, ivec2(x, y), 0);
            float r = distance(other.xyz, place) / cut;
            if (other.w == 0.0 || r >= 1.0) continue;
            vec3 weight = other.w * texelFetch(uNear, ivec2(int(sqrt(r) * entries + 0.5), 0), 0).rgb;
            sum += weight * texelFetch(uEntered, ivec2(x, y), 0).rgb;
            weights += weight;
        }
    return reach * sum / max(weights, vec3(1e-30));
}
