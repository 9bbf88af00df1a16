// caustics/box.glsl: the part of a ray that lies in a box; empty where x > y.
vec2 insideBox(vec3 v, vec3 r, vec3 low, vec3 high) {
    vec3 inverse = 1.0 / mix(r, vec3(1e-20), lessThan(abs(r), vec3(1e-20)));
    vec3 a = (low - v) * inverse;
    vec3 b = (high - v) * inverse;
    vec3 near = min(a, b);
    vec3 far = max(a, b);
    return vec2(max(max(near.x, near.y), max(near.z, 0.0)), min(far.x, min(far.y, far.z)));
}
