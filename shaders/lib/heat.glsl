// lib/heat.glsl: the colour scale of error maps, as measure/Metrics.h has it. GLSL and C++.

// Linear Rec. 709 of a share in [0, 1]: black, over blue, red and orange to a pale yellow. A path through Oklab
// (Ottosson 2020): lightness grows evenly, the hue turns from blue over red to yellow; chroma chosen by eye.
vec3 heatColor(float share) {
    float u = clamp(share, 0.0f, 1.0f);
    float lightness = 0.97f * u;
    float chroma = 0.16f * sin(3.14159265f * sqrt(u)) + 0.05f * u;
    float hue = (195.0f * u - 90.0f) * 0.0174532925f;
    float a = chroma * cos(hue), b = chroma * sin(hue);
    float l = lightness + 0.3963377774f * a + 0.2158037573f * b;
    float m = lightness - 0.1055613458f * a - 0.0638541728f * b;
    float s = lightness - 0.0894841775f * a - 1.2914855480f * b;
    l = l * l * l;
    m = m * m * m;
    s = s * s * s;
    vec3 linear = vec3(4.0767416621f * l - 3.3077115913f * m + 0.2309699292f * s,
                       2.6097574011f * m - 1.2684380046f * l - 0.3413193965f * s,
                       1.7076147010f * s - 0.0041960863f * l - 0.7034186147f * m);
    return clamp(linear, vec3(0.0f), vec3(1.0f));
}
