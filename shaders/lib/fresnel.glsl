// lib/fresnel.glsl: a smooth boundary between two clear media.
//
// cosine  between the normal on the side of incidence and the direction back, [0, 1]
// eta     index of refraction on the side of incidence over that beyond, > 0

// Reflected share of unpolarised light, [0, 1]; 1 past the critical angle (Walter et al. 2007, eq. 22).
float fresnelReflectance(float cosine, float eta) {
    float g2 = 1.0 / (eta * eta) - 1.0 + cosine * cosine;
    if (g2 <= 0.0) return 1.0;
    float g = sqrt(g2);
    float a = (g - cosine) / (g + cosine);
    float b = (cosine * (g + cosine) - 1.0) / (cosine * (g - cosine) + 1.0);
    return 0.5 * a * a * (1.0 + b * b);
}
