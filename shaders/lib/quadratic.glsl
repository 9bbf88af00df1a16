// lib/quadratic.glsl: where a q^2 + b q + c is positive. Compiles as GLSL and, with GLM, as C++
// (hence the f of the constants).
//
// Between four samples the height less the ray's height is a quadratic in the ray parameter (a bilinear patch cut
// by a vertical plane), so the length inside the solid is exact. Roots after Press et al., Numerical Recipes 5.6:
// q = -(b + sign(b) sqrt(b^2 - 4 a c)) / 2 loses no digits where 4 a c is small.

// Real roots in ascending order, or both at +1e30 when there are none. Without a quadratic part one root is at
// infinity (+-1e30), without a linear part both are.
vec2 quadraticRoots(float a, float b, float c) {
    float discriminant = b * b - 4.0f * a * c;
    if (discriminant < 0.0f) return vec2(1e30f, 1e30f);
    float q = -0.5f * (b + (b < 0.0f ? -1.0f : 1.0f) * sqrt(discriminant));
    float first = a == 0.0f ? 1e30f : q / a;
    float second = q == 0.0f ? (a == 0.0f ? 1e30f : 0.0f) : c / q;
    return vec2(min(first, second), max(first, second));
}

// Part of [0, length] on which the quadratic is positive.
// x: its summed length, exact up to rounding; y: its first point, or 1e30 when there is none.
vec2 positivePart(float a, float b, float c, float length) {
    vec2 roots = clamp(quadraticRoots(a, b, c), vec2(0.0f), vec2(length));
    float between = roots.y - roots.x;
    // Between the roots the sign is that against a; a line has its second root at infinity; a constant has none.
    bool positiveBetween = a < 0.0f || (a == 0.0f && (b > 0.0f || (b == 0.0f && c <= 0.0f)));
    if (positiveBetween) return vec2(between, between > 0.0f ? roots.x : 1e30f);
    float entry = roots.x > 0.0f ? 0.0f : (roots.y < length ? roots.y : 1e30f);
    return vec2(length - between, entry);
}
