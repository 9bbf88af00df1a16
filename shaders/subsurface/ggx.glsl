// subsurface/ggx.glsl: mirror facets of a rough surface (Walter et al. 2007; sampled as seen: Heitz 2018).
//
// alpha  squared roughness, > 0

// Share of facets at a cosine to the normal that are seen from a cosine, without those that other facets hide.
float shadowedOne(float cosine, float alpha) {
    return 2.0 * cosine / (cosine + sqrt(alpha * alpha + (1.0 - alpha * alpha) * cosine * cosine));
}

// D G / (4 cos cos) of light and eye directions, both above the surface: Fresnel is left to the caller.
float facetShare(vec3 normal, vec3 toLight, vec3 toEye, float alpha) {
    const float kPi = 3.14159265;
    vec3 middle = normalize(toLight + toEye);
    float c = clamp(dot(normal, middle), 0.0, 1.0);
    float square = alpha * alpha;
    vec3 aside = cross(normal, middle); // 1 - c² would lose its digits
    float spread = square * c * c + dot(aside, aside);
    float light = dot(normal, toLight);
    float eye = dot(normal, toEye);
    float density = square / (kPi * spread * spread);
    return density * shadowedOne(light, alpha) * shadowedOne(eye, alpha) / (4.0 * light * eye);
}

// A facet's normal as often as the eye sees it; u in [0, 1)². z of the space is the surface's normal.
vec3 seenFacet(vec3 toEye, float alpha, vec2 u) {
    const float kPi = 3.14159265;
    vec3 v = normalize(vec3(alpha * toEye.xy, toEye.z));
    float aside = dot(v.xy, v.xy);
    vec3 x = aside > 0.0 ? vec3(-v.y, v.x, 0.0) * inversesqrt(aside) : vec3(1.0, 0.0, 0.0);
    vec3 y = cross(v, x);
    float r = sqrt(u.x);
    float p = r * cos(2.0 * kPi * u.y);
    float q = r * sin(2.0 * kPi * u.y);
    float s = 0.5 * (1.0 + v.z);
    q = (1.0 - s) * sqrt(max(1.0 - p * p, 0.0)) + s * q;
    vec3 h = p * x + q * y + sqrt(max(1.0 - p * p - q * q, 0.0)) * v;
    return normalize(vec3(alpha * h.xy, max(h.z, 1e-6)));
}
