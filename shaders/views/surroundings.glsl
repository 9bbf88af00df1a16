// views/surroundings.glsl: what a ray shows that has left a mirror or refractive objects, by cube views from there.
//
// A look at the cube says how far a place lies before what is seen in its direction. A crossing is looked for where that
// changes its sign, and lies on the plane of the surface that the texel shows: depths between texels need no guess.
// Where the ray passes behind an edge instead, it is looked for in what the cube shows without the first object in each
// direction. Where that hides the place too, or there is none, the ray goes on as what is seen beside the edge, as a
// table's side does that turns away.
//
// in    uAround       radiance; layer 6 * cube + face (+x, -x, +y, -y, +z, -z); behind those of all cubes the same of
//                     the second objects
//       uAroundSolid  x: depth along the face's axis [m]; yz: octahedral normal towards the middle; w: number of the
//                     object in the scene + 1, 0: nothing there
// The file that includes this defines AROUND, an Around, and environmentAt(direction); before it, where there is
// something finer than the cube, RADIANCE_OF, the name of vec3(Met met, vec3 place) [world].
#include "lib/octahedral.glsl"
uniform sampler2DArray uAround;
uniform sampler2DArray uAroundSolid;

const int kMostLooks = 256;
#ifndef TEXELS_A_LOOK
#define TEXELS_A_LOOK AROUND.texelsALook
#endif
const int kHalvings = 5;
const float kSamePlane = 2.0; // texels from the one that shows a plane, within which it may be met: normals are the
                              // texel's own, surfaces bend
const float kDeepest = 8.0; // widths of a texel that a surface goes deeper from one to the next: it would be 7 degrees
                              // from edge-on. A plane seen at an outline would reach as far back as anybody looks.
                              // Chosen by eye

struct Glance {
    float gap;   // [m] by which a place lies before the plane of the surface there; 1e30: nothing there
    ivec3 texel;
    vec4 solid;
};

struct Met {
    float t;    // m along the ray; 1e30: nothing
    vec3 place; // from the cube's middle
    vec3 normal;
    int object;
    vec3 radiance;
};
const Met kNothingMet = Met(1e30, vec3(0.0), vec3(0.0), -1, vec3(0.0));

// A vector by a face: to its right, up, and along its axis.
vec3 inFace(int face, vec3 v) {
    float side = (face & 1) == 0 ? 1.0 : -1.0;
    if (face < 2) return vec3(side * v.z, v.y, side * v.x);
    if (face < 4) return vec3(-side * v.x, -v.z, side * v.y);
    return vec3(-side * v.x, v.y, side * v.z);
}

vec3 fromFace(int face, vec3 u) {
    float side = (face & 1) == 0 ? 1.0 : -1.0;
    if (face < 2) return vec3(side * u.z, u.y, side * u.x);
    if (face < 4) return vec3(-side * u.x, side * u.z, -u.y);
    return vec3(-side * u.x, u.y, side * u.z);
}

int faceTowards(vec3 v) {
    vec3 a = abs(v);
    if (a.x >= a.y && a.x >= a.z) return v.x > 0.0 ? 0 : 1;
    if (a.y >= a.z) return v.y > 0.0 ? 2 : 3;
    return v.z > 0.0 ? 4 : 5;
}

float sizeOfFace() { return float(textureSize(uAroundSolid, 0).x); }

bool isShown(int cube, int face, int place) {
    return ((int(AROUND.cubes[cube].reflectance.a) >> (6 * place + face)) & 1) == 1;
}

vec2 pixelIn(vec3 u) { return (0.5 + 0.5 * u.xy / max(u.z, 1e-20)) * sizeOfFace(); }

// Where a texel's surface lies.
vec3 placeOf(ivec3 texel, float depth) {
    vec2 p = (2.0 * vec2(texel.xy) + 1.0) / sizeOfFace() - 1.0;
    return fromFace(texel.z % 6, vec3(depth * p, depth));
}

// @param place  0: of the first objects; 1: of those that they hide
Glance glanceAt(int cube, int place, vec3 v) {
    int face = faceTowards(v);
    int layer = 6 * (cube + place * AROUND.count) + face;
    ivec3 texel = ivec3(clamp(ivec2(pixelIn(inFace(face, v))), ivec2(0), ivec2(sizeOfFace()) - 1), layer);
    vec4 solid = isShown(cube, face, place) ? texelFetch(uAroundSolid, texel, 0) : vec4(0.0);
    float gap = solid.w == 0.0 ? 1e30 : dot(v - placeOf(texel, solid.x), fromOctahedral(solid.yz));
    return Glance(gap, texel, solid);
}

// Where a ray meets the plane of a texel's surface from the front; below 0: it does not.
float planeAlong(Glance glance, vec3 origin, vec3 direction) {
    vec3 n = fromOctahedral(glance.solid.yz);
    float slope = dot(direction, n);
    if (glance.solid.w == 0.0 || slope > -1e-4) return -1.0;
    return dot(placeOf(glance.texel, glance.solid.x) - origin, n) / slope;
}

// The same where it does so near the texel, and in a texel that shows the object, too: beside an outline there is nothing
// of the plane.
float surfaceAlong(Glance glance, vec3 origin, vec3 direction) {
    float t = planeAlong(glance, origin, direction);
    vec3 u = inFace(glance.texel.z % 6, origin + t * direction);
    vec2 apart = abs(pixelIn(u) - vec2(glance.texel.xy) - 0.5);
    bool isDeep = abs(u.z - glance.solid.x) > kDeepest * kSamePlane * 2.0 * glance.solid.x / sizeOfFace();
    if (t < 0.0 || u.z <= 0.0 || isDeep || max(apart.x, apart.y) >= kSamePlane) return -1.0;
    ivec2 there = clamp(ivec2(pixelIn(u)), ivec2(0), ivec2(sizeOfFace()) - 1);
    return texelFetch(uAroundSolid, ivec3(there, glance.texel.z), 0).w == glance.solid.w ? t : -1.0;
}

// Of the surface that a texel shows, at a place on it: between the texels around that show it too.
Met metAt(Glance glance, float t, vec3 place) {
    vec3 n = fromOctahedral(glance.solid.yz);
    ivec2 most = ivec2(sizeOfFace()) - 1;
    vec3 u = inFace(glance.texel.z % 6, place);
    vec2 at = pixelIn(u) - 0.5;
    vec2 low = floor(at), f = at - low;
    float width = 2.0 * u.z / sizeOfFace();
    vec3 radiance = vec3(0.0), normal = vec3(0.0);
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        ivec3 texel = ivec3(clamp(ivec2(low) + corner, ivec2(0), most), glance.texel.z);
        vec4 solid = texelFetch(uAroundSolid, texel, 0);
        if (solid.w != glance.solid.w || abs(dot(placeOf(texel, solid.x) - place, n)) > width) continue;
        vec2 share = mix(1.0 - f, f, vec2(corner));
        float weight = share.x * share.y + 1e-6;
        radiance += weight * texelFetch(uAround, texel, 0).rgb;
        normal += weight * fromOctahedral(solid.yz);
        sum += weight;
    }
    if (sum == 0.0) return Met(t, place, n, int(glance.solid.w) - 1, texelFetch(uAround, glance.texel, 0).rgb);
    return Met(t, place, normalize(normal), int(glance.solid.w) - 1, radiance / sum);
}

// Where a ray has left all that there is, and a little farther.
float endOf(vec3 origin, vec3 direction) {
    vec3 slow = mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    vec3 t = (mix(AROUND.low.xyz, AROUND.high.xyz, step(0.0, slow)) - origin) / slow;
    return min(t.x, min(t.y, t.z)) + 0.01 * distance(AROUND.low.xyz, AROUND.high.xyz);
}

// A part of a ray that begins before a surface and ends behind one.
struct Passage {
    float from, to;
    Glance before, after;
};

// Narrows it down around where it passes, by the first objects or what they hide.
void halve(inout Passage passage, int cube, int place, vec3 origin, vec3 direction) {
    for (int halving = 0; halving < kHalvings; ++halving) {
        float middle = 0.5 * (passage.from + passage.to);
        Glance there = glanceAt(cube, place, origin + middle * direction);
        if (there.gap < 0.0) {
            passage.to = middle;
            passage.after = there;
        } else {
            passage.from = middle;
            passage.before = there;
        }
    }
}

bool isOfItself(int cube) { return AROUND.cubes[cube].place.w < -1.5; }

// What a ray meets first, both from the cube's middle. Written so that each step stands here once: some drivers inline all
// functions, and this one's copies took SwiftShader a minute.
Met meetAround(int cube, vec3 origin, vec3 direction) {
    float end = endOf(origin + AROUND.cubes[cube].place.xyz, direction);
    if (end <= 0.0) return kNothingMet;
    // Looks are spaced evenly in the angle that the middle sees.
    float along = dot(origin, direction);
    float aside = max(length(origin - along * direction), 1e-3 * end);
    float first = atan(along, aside), last = atan(along + end, aside);
    int looks = int(clamp(ceil((last - first) * sizeOfFace() / (1.5707963 * TEXELS_A_LOOK)), 1.0, float(kMostLooks)));

    Glance before = glanceAt(cube, 0, origin);
    float from = 0.0;
    float touching = 4.0 * length(origin) / sizeOfFace();
    float least = isOfItself(cube) ? touching : 0.0; // it begins on what the cube shows
    bool isBefore = before.gap > -touching;
    Glance beside = before; // what lies beside the edge that the ray is behind of
    Glance hidden = glanceAt(cube, 1, origin);
    Glance found; // what it meets, and where
    float met = -1.0;
    bool isBeside = false; // met where the plane of what lies beside an edge goes on
    for (int i = 1; i <= looks && met < 0.0; ++i) {
        float to = i == looks ? end : aside * tan(mix(first, last, float(i) / float(looks))) - along;
        Glance after = before, next = hidden;
        bool passes = false, isBeforeHidden = false;
        // The first objects, and behind an edge of theirs what they hide.
        for (int place = 0; place < 2; ++place) {
            if (place == 1 && isBefore) break;
            Glance there = glanceAt(cube, place, origin + to * direction);
            Passage passage = Passage(from, to, before, there);
            if (place == 0) {
                after = there;
                passes = isBefore && there.gap < 0.0;
                if (!isBefore && there.gap >= 0.0) isBefore = true;
            } else {
                next = there;
                isBeforeHidden = hidden.gap > -touching;
                passes = isBeforeHidden && there.gap < 0.0;
                passage.before = hidden;
            }
            if (!passes) continue;
            halve(passage, cube, place, origin, direction);
            for (int side = 0; side < 2; ++side) {
                found = passage.after;
                if (side == 1) found = passage.before;
                met = surfaceAlong(found, origin, direction);
                if (met >= least) break;
                met = -1.0;
            }
            if (met >= 0.0) break;
            if (place == 1) continue;
            isBefore = false;
            beside = passage.before;
            from = passage.to;
            hidden = glanceAt(cube, 1, origin + from * direction);
        }
        if (met >= 0.0) break;
        if (!isBefore) {
            bool isKnown = isBeforeHidden && hidden.solid.w > 0.0;
            bool isPassed = isKnown && next.solid.w == 0.0; // what hides it is narrower than a look
            Glance plane = beside;
            if (isPassed) plane = hidden;
            float t = planeAlong(plane, origin, direction);
            if ((!isKnown || isPassed) && t >= max(from, least) && t <= to) {
                met = t;
                found = plane;
                isBeside = !isPassed;
            }
            hidden = next;
        }
        before = after;
        from = to;
    }
    if (met < 0.0) return kNothingMet;
    vec3 place = origin + met * direction, shown = place;
    if (isBeside) shown = placeOf(beside.texel, beside.solid.x);
    Met all = metAt(found, met, shown);
    all.place = place;
    return all;
}

#ifdef RADIANCE_OF
vec3 RADIANCE_OF(Met met, vec3 place);
#endif

int cubeOf(int object) {
    for (int i = 0; i < AROUND.count; ++i)
        if (int(AROUND.cubes[i].place.w) == object && AROUND.cubes[i].reflectance.rgb != vec3(0.0)) return i;
    return -1;
}

// Light along a ray that begins at a place of the world: what it meets, by way of further mirrors, or the environment.
// a: coverage.
//
// way  [m] to what it meets first; 1e30: nothing
vec4 lightAround(int cube, vec3 place, vec3 direction, out float way) {
    vec3 weight = vec3(1.0);
    way = 1e30;
    Met met = kNothingMet;
    int mirrors = 0, part = 0; // one loop over both: some compilers take seconds for loops within loops
    while (true) {
        Met one = meetAround(cube + part, place - AROUND.cubes[cube].place.xyz, direction);
        if (one.t < met.t) met = one;
        if (part == 0 && cube + 1 < AROUND.count && isOfItself(cube + 1)) { // of what the object itself shows
            part = 1;
            continue;
        }
        if (mirrors == 0) way = met.t;
        int next = met.t < 1e29 && mirrors < AROUND.further ? cubeOf(met.object) : -1;
        if (next < 0) break;
        weight *= AROUND.cubes[next].reflectance.rgb;
        place = met.place + AROUND.cubes[cube].place.xyz;
        direction = reflect(direction, met.normal);
        cube = next;
        met = kNothingMet;
        part = 0;
        ++mirrors;
    }
    if (met.t > 1e29) return vec4(weight, 1.0) * environmentAt(direction);
#ifdef RADIANCE_OF
    met.radiance = RADIANCE_OF(met, met.place + AROUND.cubes[cube].place.xyz);
#endif
    return vec4(weight * met.radiance, 1.0);
}
