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

// A surface in a pixel, and where the ray of the eye pierces the mesh that it shows.
struct Seen {
    vec4 texel;     // with the triangle that is pierced, and its depth: the rasteriser moves corners by parts of a pixel
    Piercing found; // by a ray that begins at the depth that the layer holds
};

Seen seenAt(ivec2 pixel, vec4 texel, vec3 eye) {
    vec3 place = placeFrom(layers.view, vec2(pixel) + 0.5, texel.x);
    Piercing found = kNowhere;
    if (texel.w > 0.0)
        found = pierce(layers.view.eye.xyz, place, axesOf(eye), triangleOf(texel), facesView(texel) ? -1.0 : 1.0);
    if (found.triangle == kNoTriangle) return Seen(texel, found);
    float depth = texel.x + found.t * dot(eye, layers.view.forward.xyz);
    return Seen(vec4(depth, float(found.triangle), texel.zw), found);
}

// The first surface of a pixel.
Seen firstSeen(ivec2 pixel, vec3 eye) { return seenAt(pixel, texelFetch(uLayers, ivec3(pixel, 0), 0), eye); }

// The crossing of the ray from the eye with a surface that it sees.
Crossing firstCrossing(ivec2 pixel, Seen seen, vec3 eye) {
    bool entered = facesView(seen.texel);
    float side = entered ? -1.0 : 1.0;
    standing = Standing(triangleOf(seen.texel), objectOf(seen.texel));
    vec3 n = seen.found.triangle == kNoTriangle ? normalOf(seen.texel) : bendingNormal(seen.found, eye, side);
    // A triangle that the pixel shows and its ray passes by may turn away from the eye: light cannot come from there.
    if (side * dot(n, eye) <= 0.0) n = normalize(n - (dot(n, eye) - side * 1e-4) * eye);
    return Crossing(kGlass, 0.0, objectOf(seen.texel), entered, n, pixel);
}
