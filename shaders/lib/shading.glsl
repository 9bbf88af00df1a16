// lib/shading.glsl: the scalar formulas of the relief model (height-field thesis 2017, ch. 3). GLSL and C++.

// A cosine remapped by its falloff range and clamped to [0, 1] (4.3.6). An empty range is a step.
float falloff(float x, float low, float high) {
    if (high <= low) return x >= low ? 1.0f : 0.0f;
    return clamp((x - low) / (high - low), 0.0f, 1.0f);
}

// Illumination d from x = r / t, the length inside the solid over the depth looked at, x >= 0.
// The thesis prints r / t (3.2.1.1); its plane argument and 3.3.1.2 need t / r. exponential: e^(1 - x), which has
// the same value and slope at x = 1 (3.3.1.2 says that t / r stands for e^(-a r)).
float attenuate(float x, bool exponential) {
    if (x <= 1.0f) return 1.0f;
    return exponential ? exp(1.0f - x) : 1.0f / x;
}

// One channel of the sRGB curve (IEC 61966-2-1), [0, 1] to [0, 1].
float srgbFromLinear(float x) { return x <= 0.0031308f ? 12.92f * x : 1.055f * pow(x, 1.0f / 2.4f) - 0.055f; }
