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
// The file that includes this declares `layers`: a struct or block with View view, int count, int hasSolid.
#include "views/layer_texel.glsl"
#include "views/triangles.glsl"
uniform sampler2DArray uLayers;
uniform sampler2DArray uBlocks4;
uniform sampler2DArray uBlocks16;
uniform sampler2DArray uBlocks64;
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
const int kMostEmpty = 3;  // pixels that show nothing, after which a ray inside of something must have left it

struct Ray {
    vec3 origin;    // from the eye [m], axes of the world
    vec3 direction; // unit
    vec3 from;      // both in the view's measures (inView)
    vec3 along;
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
    return Ray(origin, direction, inView(view, origin), inView(view, direction));
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
    vec2 border = mix(low, high, step(0.0, moves)) - 0.5 * view.size;
    float depth0 = view.eye.w > 0.5 ? ray.from.z : 1.0;
    float depth1 = view.eye.w > 0.5 ? ray.along.z : 0.0;
    vec2 t = (border * depth0 - ray.from.xy) / (ray.along.xy - border * depth1);
    if (moves.x == 0.0 || !(t.x >= 0.0)) t.x = 1e30;
    if (moves.y == 0.0 || !(t.y >= 0.0)) t.y = 1e30;
    return min(t.x, t.y);
}

vec2 rangeOf(int level, ivec2 block, int layer) {
    if (level == 1) return texelFetch(uBlocks4, ivec3(block, layer), 0).xy;
    if (level == 2) return texelFetch(uBlocks16, ivec3(block, layer), 0).xy;
    return texelFetch(uBlocks64, ivec3(block, layer), 0).xy;
}

// x: whether a surface of the block lies within these depths; y: whether the block has any layer.
bvec2 lookAt(int level, ivec2 block, float nearest, float farthest) {
    bvec2 found = bvec2(false);
    for (int layer = 0; layer < layers.count; ++layer) {
        vec2 range = rangeOf(level, block, layer);
        if (range.x > range.y) break; // layers are filled from the front
        found.y = true;
        if (range.x <= farthest && range.y >= nearest) return bvec2(true);
    }
#ifdef USE_SOLID
    vec2 range = rangeOf(level, block, layers.count);
    found.x = range.x <= farthest && range.y >= nearest;
#endif
    return found;
}

bool isInside(int inside, int object) { return ((inside >> object) & 1) == 1; }

// Whether a ray may meet the surface of a texel on this part of its way: it comes near the triangle's plane there, and
// from the side from which it can meet it.
bool mayMeet(View view, Ray ray, ivec2 pixel, vec4 texel, int inside, float from, float to) {
    vec3 n = normalOf(texel);
    float slope = dot(ray.direction, n);
    if (slope == 0.0 || isInside(inside, objectOf(texel)) != (slope > 0.0)) return false;
    vec3 place = placeFrom(view, vec2(pixel) + 0.5, texel.x);
    float apart = dot(place - ray.origin, n) - 0.5 * (from + to) * slope;
    float beside = kBeside * length(view.right.xyz) * (view.eye.w > 0.5 ? texel.x : 1.0);
    return abs(apart) <= 0.5 * (to - from) * abs(slope) + beside;
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

// Follows a ray over an object's mesh from a triangle on, and keeps what it pierces there where it is met before
// `nearest` and in front of the ray.
void pierceFrom(View view, Ray ray, int triangle, int object, int inside, inout Nearest nearest) {
    float side = sideOf(inside, object);
    Piercing found = pierce(view.eye.xyz, ray.origin, ray.direction, triangle, side);
    float rounding = 1e-6 * view.forward.w;
    float order = found.t - (side < 0.0 ? rounding : 0.0);
    if (found.triangle == kNoTriangle || order >= nearest.t) return;
    // Surfaces of two objects may lie in one place.
    if (found.t < (object == standing.object ? 0.0 : -rounding)) return;
    if (found.triangle == standing.triangle && found.t < rounding) return;
    nearest = Nearest(order, object, found);
}

Crossing crossingAt(Ray ray, Nearest nearest, int inside) {
    standing = Standing(nearest.piercing.triangle, nearest.object);
    return Crossing(kGlass, max(nearest.piercing.t, 0.0), nearest.object, !isInside(inside, nearest.object),
                    bendingNormal(nearest.piercing, ray.direction, sideOf(inside, nearest.object)), ivec2(0));
}

#ifdef USE_SOLID
// Where a ray meets the plane of the opaque surface, which it does from the front only; below 0: it does not.
float meetSolid(View view, Ray ray, ivec2 pixel, vec4 solid) {
    vec3 n = fromOctahedral(solid.yz);
    float slope = dot(ray.direction, n);
    if (slope >= 0.0) return -1.0;
    return dot(placeFrom(view, vec2(pixel) + 0.5, solid.x) - ray.origin, n) / slope;
}
#endif

// What the ray crossed of one of these objects, all to be left or all to be entered, on the mesh around the pixel that
// it comes from, whatever planes say: from the nearest triangle on that turns the right side to it, and from the
// neighbours of the nearest one that turns the other side, for at outlines a triangle may be too narrow for any pixel.
void meetUnseen(View view, Ray ray, float t, vec2 towards, int inside, int objects, inout Nearest nearest) {
    vec3 here = ray.origin + t * ray.direction;
    ivec2 middle = ivec2(floor(pixelAt(view, ray, t) - 0.5 * towards));
    vec2 apart = vec2(1e30); // of a triangle that turns the right side, and the other one
    vec4 start = vec4(0.0), beside = vec4(0.0);
    for (int i = 0; i < 9; ++i) {
        ivec2 pixel = clamp(middle + ivec2(i % 3, i / 3) - 1, ivec2(0), ivec2(view.size) - 1);
        for (int layer = 0; layer < layers.count; ++layer) {
            vec4 texel = texelFetch(uLayers, ivec3(pixel, layer), 0);
            if (texel.w == 0.0) break;
            if (!isInside(objects, objectOf(texel))) continue;
            float far = distance(placeFrom(view, vec2(pixel) + 0.5, texel.x), here);
            bool turned = sideOf(inside, objectOf(texel)) * dot(normalOf(texel), ray.direction) > 0.0;
            if (turned && far < apart.x) {
                apart.x = far;
                start = texel;
            } else if (!turned && far < apart.y) {
                apart.y = far;
                beside = texel;
            }
        }
    }
    if (start.w > 0.0) pierceFrom(view, ray, triangleOf(start), objectOf(start), inside, nearest);
    if (beside.w == 0.0) return;
    ivec3 across = linksFrom(texelFetch(uLinks, tableTexel(triangleOf(beside)), 0)).across;
    for (int edge = 0; edge < 3; ++edge)
        pierceFrom(view, ray, across[edge], objectOf(beside), inside, nearest);
}

// A guess, where the mesh around did not say how the ray left one of these objects: by the surface that is nearest in
// depth in the last pixel that has one.
Crossing leaveAt(View view, Ray ray, float t, vec2 towards, int left) {
    vec2 p = pixelAt(view, ray, t);
    float z = ray.from.z + t * ray.along.z;
    for (int back = 1; back <= kMostEmpty + 3; ++back) {
        ivec2 pixel = ivec2(floor(p - (float(back) - 0.5) * towards));
        float best = 1e30;
        vec4 bestTexel = vec4(0.0);
        for (int layer = 0; layer < layers.count; ++layer) {
            vec4 texel = texelFetch(uLayers, ivec3(pixel, layer), 0);
            if (texel.w == 0.0) break;
            if (!isInside(left, objectOf(texel)) || dot(normalOf(texel), ray.direction) <= 0.0) continue;
            if (abs(texel.x - z) >= best) continue;
            best = abs(texel.x - z);
            bestTexel = texel;
        }
        if (bestTexel.w > 0.0) return Crossing(kGlass, t, objectOf(bestTexel), false, normalOf(bestTexel), pixel);
    }
    // Nothing turns towards it: it goes on as it came.
    int object = 0;
    while (object < 31 && !isInside(left, object)) ++object;
    return Crossing(kGlass, t, object, false, ray.direction, ivec2(p));
}

// Objects that stand around a place of a pixel: whose last surface before this depth shows its outside; of those that
// the ray is inside of also the ones that begin before the picture does (around the eye) and end behind the place.
int standingAround(ivec2 pixel, float depth, int inside) {
    int around = 0, seen = 0;
    for (int layer = 0; layer < layers.count; ++layer) {
        vec4 texel = texelFetch(uLayers, ivec3(pixel, layer), 0);
        if (texel.w == 0.0) break;
        int bit = 1 << objectOf(texel);
        if (texel.x <= depth) around = facesView(texel) ? around | bit : around & ~bit;
        else if ((seen & bit) == 0 && !facesView(texel)) around |= inside & bit;
        seen |= bit;
    }
    return around;
}

// What a ray meets next.
//
// inside  a bit for each object that the ray's origin is inside of
Crossing march(View view, Ray ray, int inside) {
    Crossing none = Crossing(kNothing, 0.0, 0, false, vec3(0.0), ivec2(0));
    vec2 towards = movement(view, ray), moves = sign(towards);
    // Everything lies between the near and the far depth, but for what a perspective view has before it.
    bool away = ray.along.z >= 0.0;
    float farthest = ray.along.z == 0.0 ? 1e30 : ((away ? view.forward.w : view.right.w) - ray.from.z) / ray.along.z;
    float t = 0.0;
    int level = 1;
    int empty = 0;    // pixels without anything, one after the other
    for (int count = 0; count < kMostSteps; ++count) {
        none.entered = !away && view.eye.w > 0.5;
        if (t >= farthest) return none;
        vec2 p = pixelAt(view, ray, t) + 1e-3 * moves;
        if (any(lessThan(p, vec2(0.0))) || any(greaterThanEqual(p, view.size))) {
            none.entered = true;
            return none;
        }
        int shift = 2 * level;
        ivec2 block = ivec2(floor(p)) >> shift;
        float exit = max(t, exitOf(view, ray, moves, vec2(block << shift), vec2((block + 1) << shift)));
        float z0 = ray.from.z + t * ray.along.z;
        float z1 = ray.from.z + min(exit, farthest) * ray.along.z;
        if (level > 0) {
            // Half a pixel of surface may lie beside the middle where its depth was taken.
            bvec2 found = lookAt(level, block, min(z0, z1), max(z0, z1));
            if (found.x || (inside != 0 && !found.y)) {
                --level;
                continue;
            }
            if (exit >= 1e29) return none;
            t = exit;
            level = min(level + 1, kCoarsest);
            continue;
        }
        bool any_ = false;
        // What is met far beyond the pixel does not count yet: something else may be met before.
        float slack = 0.5 * (exit - t) + 1e-6 * view.forward.w;
        Nearest nearest = Nearest(exit + 2.0 * slack, 0, kNowhere);
        for (int layer = 0; layer < layers.count; ++layer) {
            vec4 texel = texelFetch(uLayers, ivec3(block, layer), 0);
            if (texel.w == 0.0) break;
            any_ = true;
            if (mayMeet(view, ray, block, texel, inside, t, exit))
                pierceFrom(view, ray, triangleOf(texel), objectOf(texel), inside, nearest);
        }
#ifdef USE_SOLID
        vec4 solid = texelFetch(uSolid, block, 0);
        if (solid.a > 0.0) {
            float there = meetSolid(view, ray, block, solid);
            if (there >= max(0.0, t - slack) && there <= exit + slack && there < nearest.t)
                return Crossing(kSolid, there, 0, false, vec3(0.0), block);
        }
#endif
        if (nearest.piercing.triangle != kNoTriangle) return crossingAt(ray, nearest, inside);
        // What stands around the ray without being met was entered unseen between pixels, as at an outline that the
        // view sees edge-on, or only seems to; what no longer does was left. The mesh knows. Where the ray starts it
        // stands on a surface: there the end of its way through the pixel counts.
        int unseen = standingAround(block, t > 0.0 ? 0.5 * (z0 + z1) : z1, inside) ^ inside;
        empty = any_ ? 0 : empty + 1;
        if (unseen != 0) {
            if ((unseen & ~inside) != 0) meetUnseen(view, ray, t, towards, inside, unseen & ~inside, nearest);
            if ((unseen & inside) != 0) meetUnseen(view, ray, t, towards, inside, unseen & inside, nearest);
            if (nearest.piercing.triangle != kNoTriangle) return crossingAt(ray, nearest, inside);
            if (empty == kMostEmpty) {
                standing.triangle = kNoTriangle;
                return leaveAt(view, ray, t, towards, inside);
            }
        }
        if (exit >= 1e29) return none;
        t = exit;
        ivec2 next = ivec2(floor(pixelAt(view, ray, t) + 1e-3 * moves));
        if (unseen == 0 && (next >> 2) != (block >> 2)) level = 1;
    }
    none.kind = kLost;
    return none;
}
