// lib/ggx.glsl: mirror facets of a rough surface (Walter et al. 2007; sampled as seen: Heitz 2018). Compiles as GLSL and,
// with GLM, as C++ (hence the f of the constants).
//
// alpha  squared roughness, > 0

// Share of facets at a cosine to the normal that are seen from a cosine, without those that other facets hide.
float shadowedOne(float cosine, float alpha) {
    return 2.0f * cosine / (cosine + sqrt(alpha * alpha + (1.0f - alpha * alpha) * cosine * cosine));
}

// Area of facets in a direction, of each area of the surface, 1/sr: by cosine and sine to the normal, as one of them
// would lose digits.
float facetDensity(float cosine, float sine, float alpha) {
    float square = alpha * alpha;
    float spread = square * cosine * cosine + sine * sine;
    return square / (3.14159265f * spread * spread);
}

// D G / (4 cos cos) of light and eye directions, both above the surface: Fresnel is left to the caller.
float facetShare(vec3 normal, vec3 toLight, vec3 toEye, float alpha) {
    vec3 middle = normalize(toLight + toEye);
    float c = clamp(dot(normal, middle), 0.0f, 1.0f);
    float light = dot(normal, toLight);
    float eye = dot(normal, toEye);
    float density = facetDensity(c, length(cross(normal, middle)), alpha);
    return density * shadowedOne(light, alpha) * shadowedOne(eye, alpha) / (4.0f * light * eye);
}

// A facet's normal as often as the eye sees it; u in [0, 1)². z of the space is the surface's normal.
vec3 seenFacet(vec3 toEye, float alpha, vec2 u) {
    float turn = 6.2831853f * u.y;
    vec3 v = normalize(vec3(alpha * toEye.x, alpha * toEye.y, toEye.z));
    float aside = v.x * v.x + v.y * v.y;
    vec3 x = aside > 0.0f ? vec3(-v.y, v.x, 0.0f) / sqrt(aside) : vec3(1.0f, 0.0f, 0.0f);
    vec3 y = cross(v, x);
    float r = sqrt(u.x);
    float p = r * cos(turn);
    float q = r * sin(turn);
    float s = 0.5f * (1.0f + v.z);
    q = (1.0f - s) * sqrt(max(1.0f - p * p, 0.0f)) + s * q;
    vec3 h = p * x + q * y + sqrt(max(1.0f - p * p - q * q, 0.0f)) * v;
    return normalize(vec3(alpha * h.x, alpha * h.y, max(h.z, 1e-6f)));
}

// How densely directions are chosen that such facets mirror, 1/sr.
//
// cosine, sine  between the normal and the direction halfway between light and eye
float seenDensity(float cosine, float sine, float eye, float alpha) {
    return facetDensity(cosine, sine, alpha) * shadowedOne(eye, alpha) / (4.0f * eye);
}

// Points of a square that a rank-1 lattice of the golden ratio spreads evenly, [0, 1)².
vec2 latticePoint(int i, int count) {
    return vec2((float(i) + 0.5f) / float(count), fract((float(i) + 0.5f) * 0.61803399f));
}
