// brdf/models.glsl: how surfaces that are not matt send light back (image-space dissertation 2007, 2.3.1; glTF 2.0,
// appendix B). GLSL and C++ (hence the f of the constants).
//
// Directions are unit; light and view above the surface. Shares are the BRDF times the light's cosine, 1/sr: that times
// the irradiance of a surface that faces the light is the radiance that is seen. Written so that nothing is divided by a
// cosine that may be 0.
#include "lib/fresnel.glsl"
#include "lib/ggx.glsl"

const int kMatt = 0, kGlossy = 1, kPhong = 2, kBlinn = 3, kCookTorrance = 4, kOrenNayar = 5;
const float kPi = 3.14159265f;
const float kLeastAlpha = 1e-6f; // smoother surfaces mirror no lamp

struct Reflector {
    vec4 diffuse;   // rgb: albedo; of kGlossy the base colour. a: 0 for what is not shaded here
    vec4 specular;  // rgb: colour of what is mirrored; a: index of refraction
    float alpha;    // of GGX, slope m of Beckmann, radians of Oren and Nayar
    float exponent; // of the metallic model its share of metal
    float asPrinted;
    int model;
};

// Of the angles that a share depends on.
struct Angles {
    float light, view;   // cosines to the normal
    float middle, aside; // cosine and sine between the normal and the direction halfway
    float turned;        // cosine between that and the view
    float mirrored;      // cosine between the view and the mirrored light
    float around;        // cosine between the parts of light and view along the surface
};

Angles anglesOf(vec3 normal, vec3 toLight, vec3 toEye) {
    Angles a;
    a.light = max(dot(normal, toLight), 0.0f);
    a.view = max(dot(normal, toEye), 0.0f);
    vec3 sum = toLight + toEye;
    vec3 halfway = sum / max(length(sum), 1e-30f);
    a.middle = clamp(dot(normal, halfway), 0.0f, 1.0f);
    a.aside = length(cross(normal, halfway)); // of the cosine it would lose its digits
    a.turned = clamp(dot(toEye, halfway), 0.0f, 1.0f);
    a.mirrored = clamp(2.0f * a.light * dot(normal, toEye) - dot(toLight, toEye), 0.0f, 1.0f);
    vec3 light = toLight - a.light * normal, view = toEye - a.view * normal;
    a.around = dot(light, view) / max(length(light) * length(view), 1e-30f);
    return a;
}

// Schlick 1994.
vec3 schlick(vec3 straight, float cosine) {
    float c = 1.0f - cosine;
    return straight + (vec3(1.0f) - straight) * (c * c * c * c * c);
}

// Share of light from straight above that a smooth surface of this index mirrors.
float mirroredStraight(float ior) {
    float r = (ior - 1.0f) / (ior + 1.0f);
    return r * r;
}

// D G / (4 cos view) of GGX facets, those hidden from light or eye left out together (Heitz 2014, eq. 99).
float ggxShare(Angles a, float alpha) {
    float square = alpha * alpha;
    float density = facetDensity(a.middle, a.aside, alpha);
    float seen = a.light * sqrt(square + (1.0f - square) * a.view * a.view);
    float lit = a.view * sqrt(square + (1.0f - square) * a.light * a.light);
    return a.light <= 0.0f ? 0.0f : density * a.light / (2.0f * max(seen + lit, 1e-30f));
}

// As light from a disc of that radius [radians] is seen in it, which all comes from the middle: as wide as facets whose
// slopes spread by both.
Reflector widened(Reflector r, float radius) {
    float square = radius * radius;
    if (r.model == kGlossy || r.model == kCookTorrance) r.alpha = sqrt(r.alpha * r.alpha + square);
    // a power of n of the cosine to the direction halfway is as wide as facets whose alpha² is 2 / (n + 2)
    if (r.model == kBlinn) r.exponent = max(2.0f / (2.0f / (r.exponent + 2.0f) + square) - 2.0f, 0.0f);
    if (r.model == kPhong) r.exponent = max(0.5f / (2.0f / (4.0f * r.exponent + 2.0f) + square) - 0.5f, 0.0f);
    return r;
}

// What is not mirrored.
vec3 mattShare(Reflector r, Angles a) {
    vec3 albedo = vec3(r.diffuse);
    if (r.model == kGlossy) {
        vec3 straight = min(mirroredStraight(r.specular.a) * vec3(r.specular), vec3(1.0f));
        albedo *= (1.0f - r.exponent) * (vec3(1.0f) - schlick(straight, a.turned));
    }
    if (r.model == kOrenNayar) {
        float square = r.alpha * r.alpha;
        float even = 1.0f - 0.5f * square / (square + 0.33f), back = 0.45f * square / (square + 0.09f);
        // sine of the larger angle to the normal times the tangent of the smaller
        float most = max(a.light, a.view), least = min(a.light, a.view);
        float steep = sqrt(max(1.0f - least * least, 0.0f)) * sqrt(max(1.0f - most * most, 0.0f)) / max(most, 1e-30f);
        albedo *= even + back * max(a.around, 0.0f) * steep;
    }
    float over = r.asPrinted > 0.5f && r.model != kCookTorrance ? 1.0f : kPi;
    return albedo * (a.light / over);
}

float powered(float cosine, float exponent) { return exponent == 0.0f ? 1.0f : pow(cosine, exponent); }

// Beckmann's D with its 1 / pi, and grooves: min(1, 2 middle light / turned, 2 middle view / turned).
float cookTorranceShare(Reflector r, Angles a) {
    if (a.light <= 0.0f || a.middle <= 0.0f) return 0.0f;
    float square = a.middle * a.middle, slope = r.alpha * r.alpha;
    float density = exp(-a.aside * a.aside / max(square * slope, 1e-30f)) / max(kPi * slope * square * square, 1e-30f);
    // G over the view's cosine: for the smaller cosine it goes to 0 with it
    float groove = 2.0f * a.middle / max(a.turned, 1e-30f);
    float seen = a.view <= a.light ? min(1.0f / max(a.view, 1e-30f), groove) : min(1.0f, groove * a.light) / a.view;
    return fresnelReflectance(a.turned, 1.0f / r.specular.a) * density * seen / 4.0f;
}

vec3 mirroredShare(Reflector r, Angles a) {
    float n = r.exponent;
    if (r.model == kPhong) {
        float factor = r.asPrinted > 0.5f ? 1.0f : (n + 2.0f) / (2.0f * kPi);
        return factor * powered(a.mirrored, n) * a.light * vec3(r.specular);
    }
    if (r.model == kBlinn) {
        float factor = r.asPrinted > 0.5f ? 1.0f : (n + 2.0f) * (n + 4.0f) / (8.0f * kPi * (exp2(-0.5f * n) + n));
        return factor * powered(a.middle, n) * a.light * vec3(r.specular);
    }
    if (r.alpha <= kLeastAlpha) return vec3(0.0f);
    if (r.model == kCookTorrance)
        return (r.asPrinted > 0.5f ? 4.0f : 1.0f) * cookTorranceShare(r, a) * vec3(r.specular);
    if (r.model != kGlossy) return vec3(0.0f);
    vec3 straight = min(mirroredStraight(r.specular.a) * vec3(r.specular), vec3(1.0f));
    return schlick(mix(straight, vec3(r.diffuse), r.exponent), a.turned) * ggxShare(a, r.alpha);
}
