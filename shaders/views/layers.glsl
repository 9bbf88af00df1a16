// views/layers.glsl: a ray through layered images.
//
// The image finds, the mesh finishes. Surfaces stand in pixels as small planes, each with the number of its triangle. A
// ray steps through blocks of pixels whose depth ranges say that nothing can be met in them (Uludag 2014 for one
// layer). Where it comes near a plane it goes from that triangle over the mesh to the one that it pierces: what it
// costs depends on pixels, what it finds does not. Pixels that are too coarse for a mesh, or see it edge-on, need only
// show something near by. Which objects a ray is inside of decides what it can meet: their surfaces from behind, those
// of others from the front. It therefore needs no distance to keep from where it starts. What it went through between
// two pixels shows in the next ones, which have other objects around it than it is inside of.
//
// What a ray does as a rule and what it does seldom stand in loops of their own, the seldom ones far out: many rays run
// in step, and where one is busy the others wait. Some drivers run both sides of every `if`, and every loop once.
//
// The file that includes this declares `layers`: a struct or block with View view, int count; USE_BOX: vec4 low, high
// around all that there is, from the eye. TWO_SIDED: of surfaces that rays meet from both sides and are never inside of.
#include "views/layer_texel.glsl"
#include "views/triangles.glsl"
uniform sampler2DArray uLayers;
uniform sampler2DArray uBlocks; // views/blocks.frag
#ifdef USE_SOLID
uniform sampler2D uSolid; // r: depth [m]; gb: octahedral normal towards the eye; a: 0 where there is nothing
#endif

const int kNothing = 0; // it leaves the picture, or all that is in it
const int kGlass = 1;
const int kSolid = 2;
const int kLost = 3;    // it takes too many steps

const int kMostSteps = 4096;
const int kCoarsest = 3;
const float kBeside = 0.7; // pixels from a plane, within which its surface may be met
const float kSolidDepth = 8.0; // widths of a pixel that an opaque surface goes deeper in it: the plane of an outline's
                               // pixel would reach as far back as anybody looks
const int kMostEmpty = 3;  // pixels that show nothing, after which a ray inside of something must have left it

struct Ray {
    vec3 origin;    // from the eye [m], axes of the world
    vec3 direction; // unit
    vec3 from;      // both in the view's measures (inView)
    vec3 along;
    mat3 axes;      // axesOf() its direction
};

struct Crossing {
    int kind;
    float t;      // m along the ray
    int object;   // of kGlass
    bool entered; // of kGlass; of kNothing: whether it left the picture, which may not show all that lies ahead
    vec3 normal;  // of kGlass: outward, as it bends light
    ivec2 pixel;  // of kSolid
};

Ray rayOf(View view, vec3 origin, vec3 direction) {
    return Ray(origin, direction, inView(view, origin), inView(view, direction), axesOf(direction));
}

vec2 pixelAt(View view, Ray ray, float t) { return pixelOf(view, ray.from + t * ray.along); }

// Which way the ray moves on the picture; the same all along. Unit, or 0 for one that stays in one place.
vec2 movement(View view, Ray ray) {
    vec2 m = view.eye.w > 0.5 ? ray.along.xy * ray.from.z - ray.from.xy * ray.along.z : ray.along.xy;
    float size = length(m);
    return size > 0.0 ? m / size : m;
}

// Where the ray leaves a rectangle of pixels that it is in.
float exitOf(View view, Ray ray, vec2 moves, vec2 low, vec2 high) {
    vec2 border = mix(low, high, step(0.0, moves)) - view.middle;
    float depth0 = view.eye.w > 0.5 ? ray.from.z : 1.0;
    float depth1 = view.eye.w > 0.5 ? ray.along.z : 0.0;
    vec2 t = (border * depth0 - ray.from.xy) / (ray.along.xy - border * depth1);
    if (moves.x == 0.0 || !(t.x >= 0.0)) t.x = 1e30;
    if (moves.y == 0.0 || !(t.y >= 0.0)) t.y = 1e30;
    return min(t.x, t.y);
}

// Row at which a level's blocks begin (views/blocks.frag).
int rowOf(View view, int level) {
    int rows4 = (int(view.size.y) + 3) >> 2;
    return level == 1 ? 0 : level == 2 ? rows4 : rows4 + ((rows4 + 3) >> 2);
}

bool overlaps(vec2 range, vec2 depths) { return range.x <= depths.y && range.y >= depths.x; }

// x: whether a surface of the block lies within these depths; y: whether the block has any layer.
bvec2 lookAt(ivec2 texel, vec2 depths) {
    bvec2 found = bvec2(false);
#ifdef USE_SOLID
    int pairs = (layers.count + 2) >> 1; // what is opaque, then layers from the front
#else
    int pairs = (layers.count + 1) >> 1;
#endif
    for (int pair = 0; pair < pairs; ++pair) {
        vec4 ranges = texelFetch(uBlocks, ivec3(texel, pair), 0);
        bool second = ranges.z <= ranges.w;
        found.x = overlaps(ranges.xy, depths) || overlaps(ranges.zw, depths);
#ifdef USE_SOLID
        found.y = found.y || second || (pair > 0 && ranges.x <= ranges.y);
#else
        found.y = found.y || ranges.x <= ranges.y;
#endif
        if (found.x || !second) break;
    }
    return found;
}

bool isInside(int inside, int object) { return ((inside >> object) & 1) == 1; }

// Whether a ray may meet the surface of a texel on this part of its way: it comes near the triangle's plane there, and
// from the side from which it can meet it.
bool mayMeet(View view, Ray ray, ivec2 pixel, vec4 texel, int inside, float from, float to) {
    vec3 n = normalOf(texel);
    float slope = dot(ray.direction, n);
    vec3 place = placeFrom(view, vec2(pixel) + 0.5, texel.x);
    float apart = dot(place - ray.origin, n) - 0.5 * (from + to) * slope;
    float beside = kBeside * length(view.right.xyz) * (view.eye.w > 0.5 ? texel.x : 1.0);
#ifdef TWO_SIDED
    bool turned = true;
#else
    bool turned = isInside(inside, objectOf(texel)) == (slope > 0.0);
#endif
    return slope != 0.0 && turned &&
           abs(apart) <= 0.5 * (to - from) * abs(slope) + beside;
}

// What a pixel shows to a ray that runs through it.
struct Look {
    uint candidates; // layers that it may meet there, bits
    int around;      // objects that stand around a place in it
    bool any;        // whether it shows anything
};

// Around a place stands of what has its last surface before it turn the outside to the view; of what the ray is inside
// of also what begins before the picture does (around the eye) and ends behind the place.
//
// depth  of the place
Look lookIn(View view, Ray ray, ivec2 pixel, int inside, float from, float to, float depth) {
    Look look = Look(0u, 0, false);
    int seen = 0;
    for (int layer = 0; layer < layers.count; ++layer) {
        vec4 texel = texelFetch(uLayers, ivec3(pixel, layer), 0);
        if (texel.w == 0.0) break;
        look.any = true;
        if (mayMeet(view, ray, pixel, texel, inside, from, to)) look.candidates |= 1u << layer;
        int bit = 1 << objectOf(texel);
        bool faces = facesView(texel);
        if (texel.x <= depth) look.around = faces ? look.around | bit : look.around & ~bit;
        else if ((seen & bit) == 0 && !faces) look.around |= inside & bit;
        seen |= bit;
    }
#ifdef TWO_SIDED
    look.around = 0;
#endif
    return look;
}

// Where the ray stands: what it crossed last. It begins there, and does not meet it again.
struct Standing {
    int triangle;
    int object;
} standing = Standing(kNoTriangle, -1);

// The nearest surface that a ray has met up to now.
struct Nearest {
    float t; // a rounding less where the ray enters: of two objects that touch the next is entered before one is left
    int object;
    Piercing piercing;
};

// Which side of an object the ray can meet.
float sideOf(int inside, int object) { return isInside(inside, object) ? 1.0 : -1.0; }

// Which side of one of its triangles.
float sideOf(int inside, int object, vec3 outward, vec3 direction) {
#ifdef TWO_SIDED
    return dot(outward, direction) > 0.0 ? 1.0 : -1.0;
#else
    return sideOf(inside, object);
#endif
}

// Follows a ray over an object's mesh from a triangle on, and keeps what it pierces there where it is met before
// `nearest` and in front of the ray.
void pierceFrom(View view, Ray ray, int triangle, int object, float side, inout Nearest nearest) {
    Piercing found = pierce(view.eye.xyz, ray.origin, ray.axes, triangle, side);
    float rounding = 1e-6 * view.forward.w;
    float order = found.t - (side < 0.0 ? rounding : 0.0);
    if (found.triangle == kNoTriangle || order >= nearest.t) return;
#ifdef TWO_SIDED
    if (found.t < 0.5 * length(view.right.xyz) * (view.eye.w > 0.5 ? ray.from.z : 1.0)) return; // it begins there
#else
    // Surfaces of two objects may lie in one place.
    if (found.t < (object == standing.object ? 0.0 : -rounding)) return;
    if (found.triangle == standing.triangle && found.t < rounding) return;
#endif
    nearest = Nearest(order, object, found);
}

int lowestBit(uint bits) { return (floatBitsToInt(float(bits & (~bits + 1u))) >> 23) - 127; }

// The same from the triangles of a pixel's candidates.
void pierceCandidates(View view, Ray ray, ivec2 pixel, uint candidates, int inside, inout Nearest nearest) {
    while (candidates != 0u) {
        vec4 texel = texelFetch(uLayers, ivec3(pixel, lowestBit(candidates)), 0);
        candidates &= candidates - 1u;
        float side = sideOf(inside, objectOf(texel), normalOf(texel), ray.direction);
        pierceFrom(view, ray, triangleOf(texel), objectOf(texel), side, nearest);
    }
}

Crossing crossingAt(Ray ray, Nearest nearest, int inside) {
    standing = Standing(nearest.piercing.triangle, nearest.object);
    vec3 outward = nearest.piercing.outward;
    float side = sideOf(inside, nearest.object, outward, ray.direction);
    vec3 normal = bendingNormal(nearest.piercing, ray.direction, side);
#ifdef TWO_SIDED
    // What it would mirror through the triangle is mirrored as the triangle does.
    if (side * dot(reflect(ray.direction, normal), outward) > 0.0) normal = normalize(outward);
#endif
    return Crossing(kGlass, max(nearest.piercing.t, 0.0), nearest.object, !isInside(inside, nearest.object), normal,
                    ivec2(0));
}

#ifdef USE_SOLID
// Where a ray meets the plane of the opaque surface in a pixel, which it does from the front only; below 0: it does
// not.
float meetSolid(View view, Ray ray, ivec2 pixel) {
    vec4 solid = texelFetch(uSolid, pixel, 0);
    vec3 n = fromOctahedral(solid.yz);
    float slope = dot(ray.direction, n);
    if (solid.a == 0.0 || slope >= 0.0) return -1.0;
    float t = dot(placeFrom(view, vec2(pixel) + 0.5, solid.x) - ray.origin, n) / slope;
    float width = length(view.right.xyz) * (view.eye.w > 0.5 ? solid.x : 1.0);
    return abs(ray.from.z + t * ray.along.z - solid.x) > kSolidDepth * width ? -1.0 : t;
}

// Whether what a pixel's plane is met at beside the pixel is there: beside an outline there is nothing of the plane.
bool isSolidBeside(View view, Ray ray, ivec2 pixel, float t) {
    ivec2 there = clamp(ivec2(floor(pixelAt(view, ray, t))), ivec2(0), ivec2(view.size) - 1);
    if (there == pixel) return true;
    vec4 solid = texelFetch(uSolid, there, 0);
    vec3 v = ray.origin + t * ray.direction - placeFrom(view, vec2(there) + 0.5, solid.x);
    float width = length(view.right.xyz) * (view.eye.w > 0.5 ? solid.x : 1.0);
    float over = dot(v, fromOctahedral(solid.yz));
    return solid.a > 0.0 && over <= width && over >= -0.1 * width;
}
#endif

// What the ray crossed of these objects on the mesh around the pixel that it comes from, whatever planes say: from the
// nearest triangle on that turns the right side to it, and from the neighbours of the nearest one that turns the other
// side, for at outlines a triangle may be too narrow for any pixel. First what it entered, then what it left.
void meetUnseen(View view, Ray ray, float t, vec2 towards, int inside, int unseen, inout Nearest nearest) {
    vec3 here = ray.origin + t * ray.direction;
    ivec2 middle = ivec2(floor(pixelAt(view, ray, t) - 0.5 * towards));
    while (unseen != 0) {
        int objects = (unseen & ~inside) != 0 ? unseen & ~inside : unseen;
        unseen &= ~objects;
        vec2 apart = vec2(1e30); // of a triangle that turns the right side, and the other one
        ivec2 start = ivec2(kNoTriangle, 0), beside = start; // their numbers and objects
        for (int i = 0, layer = 0; i < 9;) {
            ivec2 pixel = clamp(middle + ivec2(i % 3, i / 3) - 1, ivec2(0), ivec2(view.size) - 1);
            vec4 texel = texelFetch(uLayers, ivec3(pixel, layer), 0);
            int object = objectOf(texel);
            if (texel.w > 0.0 && isInside(objects, object)) {
                float far = distance(placeFrom(view, vec2(pixel) + 0.5, texel.x), here);
                bool turned = sideOf(inside, object) * dot(normalOf(texel), ray.direction) > 0.0;
                if (turned && far < apart.x) {
                    apart.x = far;
                    start = ivec2(triangleOf(texel), object);
                } else if (!turned && far < apart.y) {
                    apart.y = far;
                    beside = ivec2(triangleOf(texel), object);
                }
            }
            bool last = texel.w == 0.0 || layer + 1 == layers.count;
            layer = last ? 0 : layer + 1;
            i += last ? 1 : 0;
        }
        ivec3 across = ivec3(kNoTriangle);
        if (beside.x != kNoTriangle) across = linksFrom(texelFetch(uLinks, tableTexel(beside.x), 0)).across;
        ivec4 starts = ivec4(start.x, across);
        for (int i = 0; i < 4; ++i)
            pierceFrom(view, ray, starts[i], i == 0 ? start.y : beside.y,
                       sideOf(inside, i == 0 ? start.y : beside.y), nearest);
    }
}

// A guess, where the mesh around did not say how the ray left one of these objects: by the surface that is nearest in
// depth in the last pixel that has one.
Crossing leaveAt(View view, Ray ray, float t, vec2 towards, int left) {
    vec2 p = pixelAt(view, ray, t);
    float z = ray.from.z + t * ray.along.z;
    float best = 1e30;
    vec4 bestTexel = vec4(0.0);
    ivec2 bestPixel = ivec2(p);
    for (int back = 1, layer = 0; back <= kMostEmpty + 3;) {
        ivec2 pixel = ivec2(floor(p - (float(back) - 0.5) * towards));
        vec4 texel = texelFetch(uLayers, ivec3(pixel, layer), 0);
        if (texel.w > 0.0 && isInside(left, objectOf(texel)) && dot(normalOf(texel), ray.direction) > 0.0 &&
            abs(texel.x - z) < best) {
            best = abs(texel.x - z);
            bestTexel = texel;
            bestPixel = pixel;
        }
        bool last = texel.w == 0.0 || layer + 1 == layers.count;
        if (last && bestTexel.w > 0.0) break;
        layer = last ? 0 : layer + 1;
        back += last ? 1 : 0;
    }
    if (bestTexel.w > 0.0) return Crossing(kGlass, t, objectOf(bestTexel), false, normalOf(bestTexel), bestPixel);
    // Nothing turns towards it: it is inside still, as below water behind a wall, or is taken to be.
    return Crossing(kNothing, 0.0, 0, true, vec3(0.0), bestPixel);
}

#ifdef USE_BOX
// Where a ray that is in nothing has left everything, and a little farther.
float leavesAll(View view, Ray ray) {
    vec3 slow = mix(ray.direction, vec3(1e-20), lessThan(abs(ray.direction), vec3(1e-20)));
    vec3 t = (mix(layers.low.xyz, layers.high.xyz, step(0.0, slow)) - ray.origin) / slow;
    return max(0.0, min(t.x, min(t.y, t.z))) + 1e-3 * view.forward.w;
}
#endif

// What a ray meets next.
//
// inside  a bit for each object that the ray's origin is inside of
Crossing march(View view, Ray ray, int inside) {
    vec2 towards = movement(view, ray), moves = sign(towards);
    // Everything lies between the near and the far depth, but for what a perspective view has before it.
    bool away = ray.along.z >= 0.0;
    float farthest = ray.along.z == 0.0 ? 1e30 : ((away ? view.forward.w : view.right.w) - ray.from.z) / ray.along.z;
#ifdef USE_BOX
    if (inside == 0) farthest = min(farthest, leavesAll(view, ray));
#endif
    float rounding = 1e-6 * view.forward.w;
    Crossing crossing = Crossing(kNothing, 0.0, 0, !away && view.eye.w > 0.5, vec3(0.0), ivec2(0));
    Nearest nearest = Nearest(0.0, 0, kNowhere);
    float t = 0.0, end = 0.0; // of the way through a pixel or block
    ivec2 pixel = ivec2(floor(pixelAt(view, ray, 0.0) + 1e-3 * moves));
    int level = 0, empty = 0, steps = 0; // it starts on a surface; pixels without anything, one after the other
    bool goesOn = true, meets = false, leaves = false, climbs = true;
    while (goesOn && !meets) {
        int unseen = 0;
        while (goesOn && !meets && unseen == 0) {
            uint candidates = 0u;
            bool stops = false;
            float slack = 0.0; // what is met so far beyond the pixel counts
#ifdef USE_SOLID
            float there = -1.0;
#endif
            while (goesOn && !stops) {
                // Over blocks without anything to a pixel.
                float z0 = 0.0, z1 = 0.0;
                while (goesOn) {
                    vec2 p = pixelAt(view, ray, t) + 1e-3 * moves;
                    bool shown = all(greaterThanEqual(p, vec2(0.0))) && all(lessThan(p, view.size));
                    if (t >= farthest || !shown || ++steps > kMostSteps) {
                        crossing.kind = steps > kMostSteps ? kLost : kNothing;
                        crossing.entered = crossing.entered || t < farthest;
                        goesOn = false;
                        break;
                    }
                    ivec2 last = pixel;
                    pixel = ivec2(floor(p));
                    if (level == 0 && climbs && (pixel >> 2) != (last >> 2)) level = 1;
                    climbs = true;
                    int shift = 2 * level;
                    ivec2 block = pixel >> shift;
                    end = max(t, exitOf(view, ray, moves, vec2(block << shift), vec2((block + 1) << shift)));
                    z0 = ray.from.z + t * ray.along.z;
                    z1 = ray.from.z + min(end, farthest) * ray.along.z;
                    if (level == 0) break;
                    bvec2 found = lookAt(ivec2(block.x, block.y + rowOf(view, level)), vec2(min(z0, z1), max(z0, z1)));
                    if (found.x || (inside != 0 && !found.y)) {
                        --level;
                    } else {
                        goesOn = end < 1e29;
                        t = end;
                        level = min(level + 1, kCoarsest);
                    }
                }
                if (!goesOn) break;
                slack = 0.5 * (end - t) + rounding;
                float until = end;
#ifdef USE_SOLID
                // Of glass that all but touches what is opaque the ray meets the glass first, beyond the pixel as well.
                there = meetSolid(view, ray, pixel);
                if (there > end && there <= end + slack) until = there;
#endif
                // Where it starts it stands on a surface: there the end of its way through the pixel counts.
                Look look = lookIn(view, ray, pixel, inside, t, until, t > 0.0 ? 0.5 * (z0 + z1) : z1);
                candidates = look.candidates;
                // What stands around the ray without being met was entered unseen between pixels, as at an outline
                // that the view sees edge-on, or only seems to; what no longer does was left. The mesh knows.
                unseen = look.around ^ inside;
                empty = look.any ? 0 : empty + 1;
                stops = candidates != 0u || unseen != 0;
#ifdef USE_SOLID
                stops = stops || there >= 0.0;
#endif
                if (!stops) {
                    goesOn = end < 1e29;
                    t = end;
                }
            }
            if (!goesOn) break;
            // What is met far beyond the pixel does not count yet: something else may be met before.
            nearest = Nearest(end + 2.0 * slack, 0, kNowhere);
            pierceCandidates(view, ray, pixel, candidates, inside, nearest);
            meets = nearest.piercing.triangle != kNoTriangle;
#ifdef USE_SOLID
            if (there >= max(0.0, t - slack) && there <= end + slack && there < nearest.t &&
                isSolidBeside(view, ray, pixel, there)) {
                crossing = Crossing(kSolid, there, 0, false, vec3(0.0), pixel);
                goesOn = meets = false;
                break;
            }
#endif
            if (!meets && unseen == 0) {
                goesOn = end < 1e29;
                t = end;
            }
        }
        if (!goesOn || meets) break;
        meetUnseen(view, ray, t, towards, inside, unseen, nearest);
        meets = nearest.piercing.triangle != kNoTriangle;
        leaves = !meets && empty == kMostEmpty;
        if (leaves) break;
        climbs = false;
        goesOn = end < 1e29;
        t = end;
    }
    if (meets) return crossingAt(ray, nearest, inside);
    if (!leaves) return crossing;
    standing.triangle = kNoTriangle;
    return leaveAt(view, ray, t, towards, inside);
}
