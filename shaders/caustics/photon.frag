// caustics/photon.frag: one ray of light through refractive objects, to where it leaves them.
//
// in    views/glass.glsl  all their surfaces, seen from the light
//       uSolid            USE_SOLID: what is opaque, seen from there
// out   caustics/photon.glsl
// model as refract/refract.frag: Snell's law at every interface, total reflection followed, Fresnel's reflections and
//       absorption taken off
// not   the mirrored light
#pragma variants - VERTICES RESTS PIXELS
#pragma variants PACKED if RESTS PIXELS
#pragma variants - WITH_BOOK
#pragma variants - USE_SOLID
#pragma variants - USE_BLENDED
#include "caustics/lamp.glsl"
#include "views/glass_block.glsl"
layout(std140) uniform PhotonBlock {
    View view; // of the light
    Lamp lamp;
    Glass glass[kMostGlass];
    vec4 tint;   // of the light, as part of white
    int count;   // layers
    int channel; // whose index of refraction counts
    int border;  // pixels at each side that belong to the lamp's next view
} layers;
#include "views/glass.glsl"

bool isMet(ivec2 pixel) {
    if (isBeside(layers.view, layers.border, pixel)) return false;
    vec4 texel = texelFetch(uLayers, ivec3(pixel, 0), 0);
#ifdef USE_SOLID
    vec4 solid = texelFetch(uSolid, pixel, 0);
    if (solid.a > 0.0 && solid.r <= texel.x) return false;
#endif
    return texel.w > 0.0;
}
#include "caustics/photon.glsl"

// Whether a place inside glass is one on something opaque too: glass that stands on it.
bool isOnSolid(vec3 origin, vec3 direction) {
#ifdef USE_SOLID
    Ray ray = rayOf(layers.view, origin, direction);
    vec2 at = pixelAt(layers.view, ray, 0.0);
    if (any(lessThan(at, vec2(0.0))) || any(greaterThanEqual(at, layers.view.size))) return false;
    vec4 solid = texelFetch(uSolid, ivec2(at), 0);
    if (solid.a == 0.0) return false;
    vec3 place = placeFrom(layers.view, floor(at) + 0.5, solid.x);
    float pixel = length(layers.view.right.xyz) * (layers.view.eye.w > 0.5 ? ray.from.z : 1.0);
    return abs(dot(place - origin, fromOctahedral(solid.yz))) < 0.02 * pixel;
#else
    return false;
#endif
}

struct Book {
    vec3 absorbed, reflected;
};

// Crosses an interface and books what does not.
bool bend(inout Beam beam, inout Book book, Crossing crossing, int channel) {
    vec3 before = beam.weight;
    vec2 mirrored = cross_(beam, crossing, channel);
    book.reflected += before * mirrored.y;
    book.absorbed += before * (1.0 - mirrored.y) - beam.weight;
    return mirrored.x > 0.0;
}

int after(int way, Crossing crossing, bool mirrored) {
    return (way * 31 + 4 * crossing.object + (crossing.entered ? 2 : 0) + (mirrored ? 1 : 0)) & 0xffff;
}

void main() {
    Start start = startOf(layers.view, layers.lamp.grid);
    leave(start);
    if (start.coverage == 0.0) return;
    vec2 at = vec2(start.pixel) + 0.5;
    vec3 eye = eyeRay(layers.view, at);
    Seen seen = firstSeen(start.pixel, eye);
    Beam beam = Beam(placeFrom(layers.view, at, seen.texel.x), eye, 0, vec3(1.0));
    Book book = Book(vec3(0.0), vec3(0.0));
    Crossing crossing = firstCrossing(start.pixel, seen, eye);
    vec3 flux = start.coverage * transmittanceAt(start.pixel) * fluxOf(layers.view, layers.lamp, eye, length(beam.origin));
    flux *= layers.tint.rgb;
    int way = 1;
    int reflections = 0;
    bool inGlass = false; // it ended on something opaque
    for (int i = 1;; ++i) {
        bool mirrored = bend(beam, book, crossing, layers.channel);
        way = after(way, crossing, mirrored);
        if (mirrored) ++reflections;
        if (reflections > kMostTotalReflections || i == kMostInterfaces) {
            crossing.kind = kLost;
            break;
        }
        crossing = march(layers.view, rayOf(layers.view, beam.origin, beam.direction), beam.inside);
        inGlass = crossing.kind == kSolid && mediumOf(beam.inside) >= 0;
        if (crossing.kind != kGlass && !inGlass) break;
        vec3 left = leftAfter(beam, crossing.t);
        book.absorbed += beam.weight * (1.0 - left);
        beam.weight *= left;
        beam.origin += crossing.t * beam.direction;
        inGlass = inGlass || (mediumOf(beam.inside) >= 0 && isOnSolid(beam.origin, beam.direction));
        if (inGlass) break;
    }
    bool lost = crossing.kind == kLost;
#ifdef WITH_BOOK
    flux *= start.own;
    oMet = vec4(flux, start.own);
    oAbsorbed = vec4(flux * book.absorbed, 1.0);
    oReflected = vec4(flux * book.reflected, 1.0);
    if (lost) oLost = vec4(flux * beam.weight, 1.0);
#else
    if (lost) return;
    oPlace = vec4(layers.view.eye.xyz + beam.origin, float(way | 1));
    oDirection = vec4(beam.direction, inGlass ? 1.0 : -float(1 + mediumOf(beam.inside)));
    oFlux = vec4(flux * beam.weight, markOf(start.coverage, start.sixths));
#endif
}
