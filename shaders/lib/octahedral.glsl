// lib/octahedral.glsl: unit vectors as two numbers in [-1, 1] (Meyer et al. 2010, "On floating-point normal vectors").
vec2 octahedralFrom(vec3 n) {
    vec3 p = n / (abs(n.x) + abs(n.y) + abs(n.z));
    if (p.z >= 0.0) return vec2(p.x, p.y);
    float x = (1.0 - abs(p.y)) * (p.x >= 0.0 ? 1.0 : -1.0);
    float y = (1.0 - abs(p.x)) * (p.y >= 0.0 ? 1.0 : -1.0);
    return vec2(x, y);
}

vec3 fromOctahedral(vec2 e) {
    float z = 1.0 - abs(e.x) - abs(e.y), folded = z >= 0.0 ? 0.0 : -z;
    return normalize(vec3(e.x >= 0.0 ? e.x - folded : e.x + folded, e.y >= 0.0 ? e.y - folded : e.y + folded, z));
}
