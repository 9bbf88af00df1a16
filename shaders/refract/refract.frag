// refract/refract.frag: what the eye sees through refractive objects.
//
// in    views/layers.glsl   all their surfaces; USE_BISECTION: the first one, the others by refract/bisection.glsl
//       BESIDE              where there are none
//       uShown              the shaded opaque surfaces and the background; a: coverage
//       views/environment.glsl; ENVIRONMENT_ONLY: opaque surfaces are not seen through glass
//       USE_AROUND          views/surroundings.glsl: what rays meet that leave the picture or pass behind what it shows
// out   oColor  COLOR: linear Rec. 709; DIRECTION: the last direction of green light; a: coverage, of DIRECTION 0
//               where the ray was given up or left the picture inside an object (its colour is what it shows if it
//               goes on as it does); LOST: 1 there
// model Snell's law at every interface (thesis 2008, ch. 3); total reflection followed; of Fresnel's reflections
//       the first one that the eye meets (dissertation 2007, 5); absorption along the geometric way, or
//       (USE_OPTICAL_LENGTH) that times the index of refraction (thesis 2008, 3.8)
// not   reflections inside; without USE_AROUND light from what the view does not show
#pragma variants - SHOW_DIRECTION SHOW_LAYERS SHOW_LOST USE_DISPERSION
#pragma variants USE_SOLID USE_BOX
#pragma variants - BESIDE
#pragma variants - USE_OPTICAL_LENGTH unless BESIDE
#pragma variants - USE_BISECTION unless BESIDE
#pragma variants - USE_AROUND ENVIRONMENT_ONLY unless BESIDE USE_BISECTION SHOW_DIRECTION SHOW_LAYERS SHOW_LOST
#pragma variants FROM_PEEL FROM_VOXELS FROM_BITS FROM_BOUNDS if USE_BISECTION
#pragma variants SLICES=256 SLICES=512 if FROM_BITS
#pragma variants - GLOBAL_BOUNDS if FROM_BITS
#pragma variants NORMALS_STORED NORMALS_NEIGHBOURS NORMALS_DELTA=1..2 if FROM_PEEL
#pragma variants NORMALS_NEIGHBOURS NORMALS_DELTA=1..2 if FROM_VOXELS FROM_BITS FROM_BOUNDS
// NVIDIA's compiler unrolls whatever loops it can; here that takes it three times as long, for pictures no faster.
#pragma optionNV(unroll none)
#include "views/glass_block.glsl"
#include "views/view.glsl"
#include "views/surroundings_block.glsl"
layout(std140) uniform RefractBlock {
    View view;
    mat4 mapFromWorld;
    Glass glass[kMostGlass];
    Around around;
    int count;       // layers
    int hasEnvironment;
    float intensity; // of the environment
    int atEye;       // a bit for each object whose box holds the eye
    vec4 low, high;  // USE_BOX: a box around all glass, from the eye
    vec2 depths;     // of bisection: nearest and farthest depth of all surfaces
    int depthCount;  // and how many lie behind each other
} layers;
#include "views/glass.glsl"
#include "views/environment.glsl"
#ifdef USE_SOLID
uniform sampler2D uShown;
#include "views/pictured.glsl"
#endif
layout(location = 0) out vec4 oColor;

vec4 environmentAt(vec3 direction) {
    if (layers.hasEnvironment == 0) return vec4(0.0);
    return vec4(layers.intensity * mapRadiance(mat3(layers.mapFromWorld) * direction), 1.0);
}

#ifdef USE_AROUND
#define AROUND layers.around
#include "views/surroundings.glsl"

// The cube whose middle is nearest, of those from refractive objects.
int cubeBy(vec3 place) {
    int found = -1;
    float least = 1e30;
    for (int i = 0; i < layers.around.count; ++i) {
        float apart = distance(place, layers.around.cubes[i].place.xyz);
        if (layers.around.cubes[i].place.w >= 0.0 || apart >= least) continue;
        least = apart;
        found = i;
    }
    return found;
}
#endif

// Light of a ray that has left all that the view shows.
//
// way  [m] to what it meets there; 1e30: nothing
vec4 lightBeyond(vec3 origin, vec3 direction, out float way) {
    way = 1e30;
#ifdef USE_AROUND
    vec3 place = layers.view.eye.xyz + origin;
    int cube = cubeBy(place);
    if (cube >= 0) return lightAround(cube, place, direction, way);
#endif
    return environmentAt(direction);
}

// The length that light is absorbed along.
float lengthOf(Beam beam, float way, int channel) {
#ifdef USE_OPTICAL_LENGTH
    return way * iorOf(mediumOf(beam.inside))[channel];
#else
    return way;
#endif
}

// How far a beam came through layers (refract/bisection.glsl).
struct Walk {
    int layer;    // that it met last
    int object;   // that it met first,
    bool entered; // and whether it entered it
};
#ifdef USE_BISECTION
#include "refract/bisection.glsl"
const int kMostMirrored = 0; // total reflection is not followed
#else
const int kMostMirrored = kMostTotalReflections;
Crossing advance(inout Beam beam, inout Walk walk, int channel) {
    Crossing crossing = march(layers.view, rayOf(layers.view, beam.origin, beam.direction), beam.inside);
    if (crossing.kind != kNothing) beam.weight *= leftAfter(beam, lengthOf(beam, crossing.t, channel));
    beam.origin += crossing.t * beam.direction;
    return crossing;
}
#endif

#ifdef USE_SOLID
// What a beam shows that meets the opaque surface of a pixel.
vec4 opaqueAt(Beam beam, ivec2 pixel) {
#ifdef ENVIRONMENT_ONLY
    return environmentAt(beam.direction);
#else
    vec3 normal = fromOctahedral(texelFetch(uSolid, pixel, 0).yz);
    return vec4(picturedAt(layers.view, beam.origin, normal, texelFetch(uShown, pixel, 0).rgb), 1.0);
#endif
}
#endif

// Follows a beam to its end from the crossing that it met first, which it has passed or was mirrored by. What it shows
// there is looked up once all interfaces are behind it: a search within the loop over them makes rays wait for others,
// and some compilers work on it for seconds.
//
// @return  light; a: -1 where the beam is lost
vec4 follow(inout Beam beam, Crossing first, int channel) {
    Walk walk = Walk(0, first.object, first.entered);
    int reflections = 0;
    Crossing crossing = first;
    for (int i = 0; i < kMostInterfaces; ++i) {
        crossing = advance(beam, walk, channel);
        if (crossing.kind != kGlass) break;
        if (cross_(beam, crossing, channel).x > 0.0 && ++reflections > kMostMirrored) break;
    }
#ifdef USE_SOLID
    if (crossing.kind == kSolid) return opaqueAt(beam, crossing.pixel);
#endif
    if (crossing.kind != kNothing) return vec4(0.0, 0.0, 0.0, -1.0);
    float way;
    vec4 light = lightBeyond(beam.origin, beam.direction, way);
    if (way < 1e29) light.rgb *= leftAfter(beam, lengthOf(beam, way, channel)); // as under water
    return crossing.entered && beam.inside != 0 ? vec4(light.rgb, -1.0) : light;
}

// Objects that the eye is inside of: of those around it the ones whose nearest surface in this pixel shows its
// back.
int insideAtEye(ivec2 pixel) {
    if (layers.atEye == 0) return 0;
    int seen = ~layers.atEye, inside = 0;
    for (int layer = 0; layer < layers.count; ++layer) {
        vec4 texel = texelFetch(uLayers, ivec3(pixel, layer), 0);
        if (texel.w == 0.0) break;
        int bit = 1 << objectOf(texel);
        if ((seen & bit) == 0 && !facesView(texel)) inside |= bit;
        seen |= bit;
    }
    return inside;
}

vec4 throughGlass(ivec2 pixel, Seen seen, vec3 eye, int channel) {
    Beam start = Beam(placeFrom(layers.view, vec2(pixel) + 0.5, seen.texel.x), eye, insideAtEye(pixel), vec3(1.0));
    start.weight = leftAfter(start, lengthOf(start, length(start.origin), channel));
    Crossing first = firstCrossing(pixel, seen, eye);
    Beam beam = start;
    float mirrored = cross_(beam, first, channel).y;
#if defined(SHOW_LOST)
    return vec4(vec3(follow(beam, first, channel).a < 0.0 ? 1.0 : 0.0), 1.0);
#elif defined(SHOW_DIRECTION)
    float known = follow(beam, first, channel).a < 0.0 ? 0.0 : 1.0;
    return vec4(beam.direction, known);
#else
    vec3 color = vec3(0.0);
    for (int way = 0; way < 2; ++way) {
        vec4 light = follow(beam, first, channel);
        color += beam.weight * max(light.rgb, 0.0);
        if (mirrored == 0.0) break;
        // What the first interface mirrors goes out from there, too.
        beam = start;
        beam.direction = reflect(eye, first.normal);
        beam.weight *= mirrored;
        standing = Standing(triangleOf(seen.texel), objectOf(seen.texel));
    }
    return vec4(color, 1.0);
#endif
}

// What is shown where there is no glass.
vec4 beside(vec3 eye, vec4 color) {
#if defined(SHOW_LOST)
    return vec4(0.0, 0.0, 0.0, 1.0);
#elif defined(SHOW_DIRECTION)
    return vec4(eye, 1.0);
#else
    return color;
#endif
}

float layersAt(ivec2 pixel) {
    int count = 0;
#ifdef USE_BISECTION
    count = surfacesAt(pixel, layers.depthCount, layers.depths);
#else
    while (count < layers.count && texelFetch(uLayers, ivec3(pixel, count), 0).w > 0.0) ++count;
#endif
    return float(count);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
#ifdef SHOW_LAYERS
    oColor = vec4(vec3(layersAt(pixel)), 1.0);
    return;
#endif
    vec3 eye = eyeRay(layers.view, gl_FragCoord.xy);
    Seen seen = Seen(vec4(0.0), kNowhere);
#ifndef BESIDE
    if (layers.count > 0) seen = firstSeen(pixel, eye);
#endif
#ifdef USE_SOLID
    vec4 solid = texelFetch(uSolid, pixel, 0);
    if (solid.a > 0.0 && (seen.texel.w == 0.0 || solid.r <= seen.texel.x)) {
        oColor = beside(eye, vec4(texelFetch(uShown, pixel, 0).rgb, 1.0));
        return;
    }
#endif
    if (seen.texel.w == 0.0) {
        oColor = beside(eye, environmentAt(eye));
        return;
    }
#ifndef USE_DISPERSION
    oColor = throughGlass(pixel, seen, eye, 1);
#else
    vec4 color = vec4(0.0, 0.0, 0.0, 1.0); // WebGL lets no output be indexed
    for (int channel = 0; channel < 3; ++channel) color[channel] = throughGlass(pixel, seen, eye, channel)[channel];
    oColor = color;
#endif
}
