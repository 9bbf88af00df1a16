// lib/surface_frame.glsl: a surface's own space. GLSL and C++.

// From the space whose z is the normal; x is horizontal, or where the normal is nearly vertical, across the world's x.
mat3 surfaceFrame(vec3 normal) {
    vec3 aside = abs(normal.y) < 0.9f ? vec3(0.0f, 1.0f, 0.0f) : vec3(1.0f, 0.0f, 0.0f);
    vec3 x = normalize(cross(aside, normal));
    return mat3(x, cross(normal, x), normal);
}
