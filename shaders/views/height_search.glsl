// views/height_search.glsl: where a straight stretch through tiles of heights first goes below them.
//
// A place is (t, z): texels from the edge of a tile, which lies on endlessly, and metres. SEARCHED: by the methods that
// look at places; else by the pyramid.

struct Found {
    float at; // share of the stretch; 1e30: nowhere
    int steps; // places, or cells of the pyramid, that were looked at
};

const float kEnough = 1.0 / 4096.0; // of the highest height: nearer is found

// g of views/field.glsl, on the tile whose edge has one texel more.
vec2 gridOf(vec2 t) {
    vec2 texels = displaced.field.texels - 2.0;
    return t - texels * floor(t / texels) + 1.5;
}
float metresAt(vec2 t) { return heightAt(gridOf(t), displaced.field) * displaced.field.heightScale; }

float above(vec3 from, vec3 way, float at) { return from.z + at * way.z - metresAt(from.xy + at * way.xy); }

// Where Newton's steps in a prism lead nowhere, as in pixels beside its triangles that are drawn along with others, what
// comes is no number, and loops over it would not end.
bool isOnMap(vec3 from, vec3 way) { return abs(from.x) + abs(from.y) + abs(way.x) + abs(way.y) < 1e6; }

#ifdef SEARCHED
// The map is shifted by the height that it has where the ray would meet the bare surface.
Found parallax(vec3 from, vec3 way) {
    if (way.z >= 0.0) return Found(1e30, 1);
    float bare = -from.z / way.z;
    float at = (metresAt(from.xy + bare * way.xy) - from.z) / way.z;
    return Found(at >= 0.0 && at <= 1.0 ? at : 1e30, 1);
}

// Steps to the first that is below, then as many halvings of it (relief mapping: Policarpo, Oliveira, Comba 2005), or
// secants between its ends (interval mapping: 2007, 3.2). A secant may leave one end where it is, beside a cliff for
// ever: after two steps that left more than half of the interval comes a half.
Found searched(vec3 from, vec3 way, int count, bool refines, bool secant) {
    float low = 0.0, high = 0.0, lowAbove = above(from, way, 0.0), highAbove = lowAbove;
    int steps = 0;
    while (steps < count && highAbove >= 0.0) {
        steps += 1;
        low = high;
        lowAbove = highAbove;
        high = float(steps) / float(count);
        highAbove = above(from, way, high);
    }
    if (highAbove >= 0.0) return Found(1e30, steps);
    if (!refines) return Found(high, steps);
    float enough = kEnough * displaced.field.highest * displaced.field.heightScale;
    float at = high;
    int slow = 0;
    for (int i = 0; i < displaced.refineSteps && high > low; ++i) {
        bool halves = !secant || slow >= 2;
        at = halves ? 0.5 * (low + high) : mix(low, high, lowAbove / (lowAbove - highAbove));
        float there = above(from, way, at);
        steps += 1;
        float before = high - low;
        if (there < 0.0) {
            high = at;
            highAbove = there;
        } else {
            low = at;
            lowAbove = there;
        }
        slow = high - low > 0.5 * before && !halves ? slow + 1 : 0;
        if (abs(there) < enough) return Found(at, steps);
    }
    return Found(secant ? mix(low, high, lowAbove / max(lowAbove - highAbove, 1e-30)) : 0.5 * (low + high), steps);
}

Found findBelow(vec3 from, vec3 way) {
    if (!isOnMap(from, way)) return Found(1e30, 0);
    if (displaced.method == 0) return parallax(from, way);
    vec2 tiles = abs(way.xy) / (displaced.field.texels - 2.0);
    float share = max(abs(way.z) / (displaced.span.y - displaced.span.x), max(tiles.x, tiles.y));
    int count = max(1, int(ceil(share * float(displaced.searchSteps))));
    return searched(from, way, count, displaced.method >= 2, displaced.method == 3);
}
#else
// Tile by tile by the pyramid, exactly.
Found findBelow(vec3 from, vec3 way) {
    if (!isOnMap(from, way)) return Found(1e30, 0);
    vec2 texels = displaced.field.texels - 2.0;
    vec2 step = vec2(abs(way.x) < 1e-12 ? 0.0 : way.x, abs(way.y) < 1e-12 ? 0.0 : way.y);
    vec2 inverse = vec2(step.x == 0.0 ? 1e30 : 1.0 / step.x, step.y == 0.0 ? 1e30 : 1.0 / step.y);
    vec2 forward = vec2(step.x > 0.0 ? 1.0 : 0.0, step.y > 0.0 ? 1.0 : 0.0);
    vec2 tile = floor(from.xy / texels);
    float reference = 0.5 * (displaced.field.lowest + displaced.field.highest);
    float at = 0.0;
    int steps = 0;
    while (at < 1.0) {
        vec2 borders = ((tile + forward) * texels - from.xy) * inverse;
        if (step.x == 0.0) borders.x = 1e30;
        if (step.y == 0.0) borders.y = 1e30;
        float end = clamp(min(borders.x, borders.y), at, 1.0);
        if (end > at) {
            vec2 g = from.xy - tile * texels + 1.5;
            ivec2 base = ivec2(floor(g));
            Ray ray = Ray(base, g - vec2(base), step, from.z - reference * displaced.field.heightScale, way.z,
                          reference, 0.0);
            Crossing crossing = walk(ray, displaced.field, at, end, 0.0);
            steps += crossing.steps;
            if (crossing.entry <= end) return Found(crossing.entry, steps);
        }
        at = end;
        tile += borders.x < borders.y ? vec2(2.0 * forward.x - 1.0, 0.0) : vec2(0.0, 2.0 * forward.y - 1.0);
    }
    return Found(1e30, steps);
}

#endif

// How the height changes along u and v at t, in metres a texel: central differences of the samples, bilinear between.
vec2 slopeAt(vec2 t) {
    vec2 texels = displaced.field.texels - 2.0;
    vec2 at = t - 0.5;
    vec2 cell = floor(at), f = at - cell;
    vec2 sum = vec2(0.0);
    for (int i = 0; i < 4; ++i) {
        vec2 beside = vec2(float(i & 1), float(i >> 1));
        vec2 sampleAt = cell + beside;
        ivec2 inside = ivec2(sampleAt - texels * floor(sampleAt / texels)) + 1;
        vec2 share = mix(1.0 - f, f, beside);
        vec2 slope = vec2(storedHeight(inside + ivec2(1, 0)) - storedHeight(inside - ivec2(1, 0)),
                          storedHeight(inside + ivec2(0, 1)) - storedHeight(inside - ivec2(0, 1)));
        sum += share.x * share.y * 0.5 * slope;
    }
    return sum * displaced.field.heightScale;
}
