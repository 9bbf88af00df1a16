// frame/shown.glsl: a linear quantity as the display shows it.
#include "lib/heat.glsl"
#include "lib/shading.glsl"

vec3 encoded(vec3 value) {
    vec3 clamped = clamp(value, 0.0, 1.0);
    return vec3(srgbFromLinear(clamped.r), srgbFromLinear(clamped.g), srgbFromLinear(clamped.b));
}

// `scale * value + shift`, clamped; with isHeat that of the binary logarithm of the brightest channel, in false colours;
// with encode by the sRGB curve.
vec3 shownColor(vec3 value, vec3 scale, vec3 shift, bool encode, bool isHeat) {
    if (isHeat) value = vec3(log2(max(max(max(value.r, value.g), value.b), 1e-30)));
    value = value * scale + shift;
    if (isHeat) value = heatColor(value.r);
    return encode ? encoded(value) : clamp(value, 0.0, 1.0);
}
