// views/glass.glsl: rays of the eye or of a light at the interfaces of refractive objects.
//
// A point lies in the medium of the last object of the list that contains it; crossing a surface that does not change
// the medium bends nothing. Objects are bits of `inside`.
//
// The file that includes this declares `layers` as views/layers.glsl wants it, and in it Glass glass[kMostGlass].
#include "lib/fresnel.glsl"
#include "views/layers.glsl"

const int kMostInterfaces = 64;
const int kMostTotalReflections = 8;

// The last object of the list whose bit is set; -1: vacuum.
int mediumOf(int inside) {
    int medium = -1;
    for (int object = 0; inside >> object != 0; ++object)
        if (((inside >> object) & 1) == 1) medium = object;
    return medium;
}

vec3 iorOf(int medium) { return medium < 0 ? vec3(1.0) : layers.glass[medium].ior.rgb; }

// A ray on its way.
struct Beam {
    vec3 origin; // from the eye
    vec3 direction;
    int inside;
    vec3 weight;
};

// Crosses an interface. @return whether light was mirrored: x all of it, y the share for the first interface
vec2 cross_(inout Beam beam, Crossing crossing, int channel) {
    int before = mediumOf(beam.inside);
    int changed = crossing.entered ? beam.inside | (1 << crossing.object) : beam.inside & ~(1 << crossing.object);
    int after = mediumOf(changed);
    if (before == after) {
        beam.inside = changed;
        return vec2(0.0);
    }
    vec3 n = crossing.entered ? crossing.normal : -crossing.normal;
    float cosine = clamp(-dot(beam.direction, n), 0.0, 1.0);
    float eta = iorOf(before)[channel] / iorOf(after)[channel];
    vec3 onwards = eta == 1.0 ? beam.direction : refract(beam.direction, n, eta);
    if (onwards == vec3(0.0)) {
        beam.direction = reflect(beam.direction, n);
        return vec2(1.0, 0.0);
    }
    int later = max(before, after);
    float mirrored = layers.glass[later].ior.a > 0.5 ? fresnelReflectance(cosine, eta) : 0.0;
    beam.weight *= 1.0 - mirrored;
    if (crossing.entered) beam.weight *= layers.glass[later].absorption.a;
    beam.direction = normalize(onwards);
    beam.inside = changed;
    return vec2(0.0, mirrored);
}

// What absorption leaves of a beam after a way of t metres.
vec3 leftAfter(Beam beam, float t) {
    int medium = mediumOf(beam.inside);
    return medium < 0 ? vec3(1.0) : exp(-layers.glass[medium].absorption.rgb * t);
}

// Where the ray of the eye through a pixel pierces the mesh that the pixel shows.
Piercing firstPiercing(ivec2 pixel, vec4 texel, vec3 eye) {
    vec3 place = placeFrom(layers.view, vec2(pixel) + 0.5, texel.x);
    return pierce(layers.view.eye.xyz, place, eye, triangleOf(texel), facesView(texel) ? -1.0 : 1.0);
}

// The first layer of a pixel, its depth where the ray of the eye pierces the mesh: the rasteriser moves corners by
// parts of a pixel.
vec4 nearestTexel(ivec2 pixel) {
    vec4 texel = texelFetch(uLayers, ivec3(pixel, 0), 0);
    if (texel.w == 0.0) return texel;
    vec3 eye = eyeRay(layers.view, vec2(pixel) + 0.5);
    Piercing found = firstPiercing(pixel, texel, eye);
    if (found.triangle == kNoTriangle) return texel;
    return vec4(texel.x + found.t * dot(eye, layers.view.forward.xyz), float(found.triangle), texel.zw);
}

// The crossing of a ray from the eye with the surface of a texel, as a rule the one that nearestTexel() has found.
Crossing firstCrossing(ivec2 pixel, vec4 texel, vec3 eye) {
    bool entered = facesView(texel);
    float side = entered ? -1.0 : 1.0;
    Piercing found = firstPiercing(pixel, texel, eye);
    standing = Standing(triangleOf(texel), objectOf(texel));
    vec3 n = found.triangle == kNoTriangle ? normalOf(texel) : bendingNormal(found, eye, side);
    // A triangle that the pixel shows and its ray passes by may turn away from the eye: light cannot come from there.
    if (side * dot(n, eye) <= 0.0) n = normalize(n - (dot(n, eye) - side * 1e-4) * eye);
    return Crossing(kGlass, 0.0, objectOf(texel), entered, n, pixel);
}
