// views/layers.glsl: a ray through layered images.
//
// Surfaces stand in pixels as places with normals, that is, as small planes. A ray steps through blocks of pixels
// whose depth ranges say that nothing can be met in them (Uludag 2014 for one layer), and meets the planes of the
// pixels that it passes. Which objects it is inside of decides what it can meet: their surfaces from behind,
// those of others from the front. It therefore needs no distance to keep from where it starts. What it went through
// between two pixels shows in the next ones, which have other objects around it than it is inside of.
//
// The file that includes this declares `layers`: a struct or block with View view, int count, int hasSolid.
#include "views/layer_texel.glsl"
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
    vec3 normal;  // of kGlass: outward, interpolated
    ivec2 pixel;  // of kSolid
};

Ray rayOf(View view, vec3 origin, vec3 direction) {
    return Ray(origin, direction, inView(view, origin), inView(view, direction));
}

vec2 pixelAt(View view, Ray ray, float t) { return pixelOf(view, ray.from + t * ray.along); }

// Which way the ray moves on the picture; the same all along.
vec2 movement(View view, Ray ray) {
    vec2 m = view.eye.w > 0.5 ? ray.along.xy * ray.from.z - ray.from.xy * ray.along.z : ray.along.xy;
    return sign(m);
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

// Where a ray meets the plane of a texel from the side that it can come from; below 0: it does not.
float meet(View view, Ray ray, ivec2 pixel, vec4 texel, int inside) {
    vec3 n = normalOf(texel);
    float slope = dot(ray.direction, n);
    if (slope == 0.0 || isInside(inside, objectOf(texel)) != (slope > 0.0)) return -1.0;
    vec3 place = placeFrom(view, vec2(pixel) + 0.5, texel.x);
    return dot(place - ray.origin, n) / slope;
}

#ifdef USE_SOLID
// The same for the opaque surface, which is met from the front only.
float meetSolid(View view, Ray ray, ivec2 pixel, vec4 solid) {
    vec3 n = fromOctahedral(solid.yz);
    float slope = dot(ray.direction, n);
    if (slope >= 0.0) return -1.0;
    return dot(placeFrom(view, vec2(pixel) + 0.5, solid.x) - ray.origin, n) / slope;
}
#endif

// The crossing at about t with the surface of `texel`, between the four pixels around. kNothing where the pixel that
// the ray is in does not show it: at an outline the planes of its neighbours go on where the surface does not.
Crossing refine(View view, Ray ray, float t, vec4 texel, int inside) {
    bool entered = !isInside(inside, objectOf(texel));
    Crossing crossing = Crossing(kGlass, t, objectOf(texel), entered, normalOf(texel), ivec2(0));
    for (int round = 0; round < 2; ++round) {
        vec2 at = pixelAt(view, ray, crossing.t) - 0.5;
        ivec2 base = ivec2(floor(at));
        vec2 f = at - vec2(base);
        // A surface that goes on here is met within about two pixels of the guess.
        float reach = 2.0 * length(view.right.xyz) * (view.eye.w > 0.5 ? ray.from.z + crossing.t * ray.along.z : 1.0) /
                      max(abs(dot(ray.direction, crossing.normal)), 0.05);
        float sum = 0.0;
        float place = 0.0;
        vec3 normal = vec3(0.0);
        bool here = false; // whether the pixel that the ray is in shows it
        for (int i = 0; i < 4; ++i) {
            ivec2 corner = ivec2(i & 1, i >> 1);
            vec2 share = mix(1.0 - f, f, vec2(corner));
            float best = reach;
            vec4 bestTexel = vec4(0.0);
            float bestT = 0.0;
            for (int layer = 0; layer < layers.count; ++layer) {
                vec4 other = texelFetch(uLayers, ivec3(base + corner, layer), 0);
                if (other.w == 0.0) break;
                if (other.w != texel.w) continue;
                float there = meet(view, ray, base + corner, other, inside);
                if (there < 0.0 || abs(there - crossing.t) > best) continue;
                if (dot(normalOf(other), crossing.normal) < 0.7) continue;
                best = abs(there - crossing.t);
                bestTexel = other;
                bestT = there;
            }
            if (bestTexel.w == 0.0) continue;
            float weight = share.x * share.y + 1e-6;
            here = here || corner == ivec2(step(0.5, f));
            sum += weight;
            place += weight * bestT;
            normal += weight * normalOf(bestTexel);
        }
        crossing.kind = here ? kGlass : kNothing;
        if (sum == 0.0) break;
        crossing.t = place / sum;
        crossing.normal = normalize(normal);
    }
    return crossing;
}

// The ray is inside of something that no longer is where the ray is: it went through between two pixels, as at a
// silhouette. The surface that it must have met is the one nearest in depth of the pixel before.
Crossing leaveAt(View view, Ray ray, float t, vec2 moves, int inside) {
    vec2 p = pixelAt(view, ray, t);
    float z = ray.from.z + t * ray.along.z;
    for (int back = 1; back <= 3; ++back) {
        ivec2 pixel = ivec2(floor(p - (float(back) - 0.5) * moves));
        float best = 1e30;
        vec4 bestTexel = vec4(0.0);
        for (int layer = 0; layer < layers.count; ++layer) {
            vec4 texel = texelFetch(uLayers, ivec3(pixel, layer), 0);
            if (texel.w == 0.0) break;
            if (!isInside(inside, objectOf(texel)) || dot(normalOf(texel), ray.direction) <= 0.0) continue;
            if (abs(texel.x - z) >= best) continue;
            best = abs(texel.x - z);
            bestTexel = texel;
        }
        if (bestTexel.w > 0.0) return Crossing(kGlass, t, objectOf(bestTexel), false, normalOf(bestTexel), pixel);
    }
    // Nothing turns towards it: it goes on as it came.
    int object = 0;
    while (object < 31 && !isInside(inside, object)) ++object;
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

// Where the ray entered an object between two pixels, unseen as at an outline. The edge between the object's surfaces
// before and behind the ray is taken as round.
Crossing enterAt(ivec2 pixel, float t, float depth, int object) {
    vec4 before = vec4(0.0), behind = vec4(0.0);
    for (int layer = 0; layer < layers.count && behind.w == 0.0; ++layer) {
        vec4 texel = texelFetch(uLayers, ivec3(pixel, layer), 0);
        if (texel.w == 0.0) break;
        if (objectOf(texel) != object) continue;
        if (texel.x <= depth) before = texel;
        else behind = texel;
    }
    if (behind.w == 0.0) behind = before;
    float share = behind.x > before.x ? (depth - before.x) / (behind.x - before.x) : 0.0;
    return Crossing(kGlass, t, object, true, normalize(mix(normalOf(before), normalOf(behind), share)), pixel);
}

// What a ray meets next.
//
// inside  a bit for each object that the ray's origin is inside of
Crossing march(View view, Ray ray, int inside) {
    Crossing none = Crossing(kNothing, 0.0, 0, false, vec3(0.0), ivec2(0));
    vec2 moves = movement(view, ray);
    // Everything lies between the near and the far depth, but for what a perspective view has before it.
    bool away = ray.along.z >= 0.0;
    float farthest = ray.along.z == 0.0 ? 1e30 : ((away ? view.forward.w : view.right.w) - ray.from.z) / ray.along.z;
    float t = 0.0;
    int level = 1;
    int differed = 0; // objects that the last pixel had around the ray and `inside` has not, or the other way round
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
        float first = 1e30;
        vec4 firstTexel = vec4(0.0);
        bool any_ = false;
        float slack = 0.5 * (exit - t) + 1e-6 * view.forward.w; // and the rounding of depths
        for (int layer = 0; layer < layers.count; ++layer) {
            vec4 texel = texelFetch(uLayers, ivec3(block, layer), 0);
            if (texel.w == 0.0) break;
            any_ = true;
            float there = meet(view, ray, block, texel, inside);
            if (there < max(0.0, t - slack) || there > exit + slack || there >= first) continue;
            first = there;
            firstTexel = texel;
        }
#ifdef USE_SOLID
        vec4 solid = texelFetch(uSolid, block, 0);
        if (solid.a > 0.0) {
            float there = meetSolid(view, ray, block, solid);
            if (there >= max(0.0, t - slack) && there <= exit + slack && there < first)
                return Crossing(kSolid, there, 0, false, vec3(0.0), block);
        }
#endif
        if (first < 1e30) {
            Crossing crossing = refine(view, ray, first, firstTexel, inside);
            if (crossing.kind == kGlass) return crossing;
        }
        if (!any_ && inside != 0) return leaveAt(view, ray, t, moves, inside);
        // What stands around the ray in two pixels one after the other, without being met, was entered unseen between
        // pixels, as at an outline that the view sees edge-on; what no longer does was left.
        float depth = 0.5 * (z0 + z1);
        int differs = t > 0.0 ? standingAround(block, depth, inside) ^ inside : 0;
        int unseen = differs & differed;
        differed = differs;
        if ((unseen & inside) != 0) return leaveAt(view, ray, t, moves, unseen & inside);
        if (unseen != 0) {
            int object = 0;
            while (!isInside(unseen, object)) ++object;
            Crossing crossing = enterAt(block, t, depth, object);
            if (dot(crossing.normal, ray.direction) < 0.0) return crossing;
        }
        if (exit >= 1e29) return none;
        t = exit;
        ivec2 next = ivec2(floor(pixelAt(view, ray, t) + 1e-3 * moves));
        if (differed == 0 && (next >> 2) != (block >> 2)) level = 1;
    }
    none.kind = kLost;
    return none;
}
