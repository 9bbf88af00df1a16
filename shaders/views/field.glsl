// views/field.glsl: a height field and the one walk through it that everything here is made of.
//
// Coordinates  g: texels + 1/2, so that sample (i, j) stands at g = (i + 1, j + 1), cell (i, j) = [i, i+1] x [j, j+1]
//              lies between four samples and the footprint is [1/2, n + 1/2]. z: metres above the shading point.
//              All is relative to a base cell and a reference height near the shading point: in absolute
//              coordinates a depth of 1e-6 would keep one digit.
// Pyramid      level k of uPyramid holds the lowest and highest height of 2^(k+1) cells squared, 16 bits each,
//              rounded outwards, over [lowest, highest].
struct Field {
    vec2 texels;       // N x M samples
    float texelSize;   // m
    float heightScale; // m for a height of 1
    float lowest;      // stored height
    float highest;     // stored height
    float bottom;      // m, where drawn side walls end
    float topLevel;    // coarsest level of the pyramid
};

uniform sampler2D uHeights;
uniform usampler2D uPyramid;

// A straight line through the field: g = base + origin + s * step, z = z0 + s * rise, s in metres.
struct Ray {
    ivec2 base;      // cell near the shading point
    vec2 origin;     // texels from base
    vec2 step;       // texels a metre
    float z0, rise;  // m above the reference, and m a metre
    float reference; // stored height that counts as 0 ...
    float offset;    // ... less this many metres
};

struct Crossing {
    float inside; // length of the stretch that runs inside the solid, m
    float entry;  // s where it first enters the solid; 1e30: never
    int steps;    // cells looked at
};

float storedHeight(ivec2 sampleIndex, Field field) {
    return texelFetch(uHeights, clamp(sampleIndex, ivec2(0), ivec2(field.texels) - 1), 0).r;
}

float relativeHeight(float stored, Ray ray, Field field) {
    return (stored - ray.reference) * field.heightScale - ray.offset;
}

// Stored height at g, bilinear, constant in the outer half texel.
float heightAt(vec2 g, Field field) {
    vec2 cell = floor(g);
    vec2 f = g - cell;
    ivec2 i = ivec2(cell) - 1;
    float h00 = storedHeight(i, field);
    float h10 = storedHeight(i + ivec2(1, 0), field);
    float h01 = storedHeight(i + ivec2(0, 1), field);
    float h11 = storedHeight(i + ivec2(1, 1), field);
    return h00 + f.x * (h10 - h00) + f.y * (h01 - h00 + f.x * (h11 - h10 - h01 + h00));
}

// Normal of one texel in object space: central difference in world units, one-sided at the border. Image rows
// run towards -y.
vec3 texelNormal(ivec2 i, Field field) {
    ivec2 last = ivec2(field.texels) - 1;
    i = clamp(i, ivec2(0), last);
    ivec2 low = max(i - 1, ivec2(0));
    ivec2 high = min(i + 1, last);
    float dx = storedHeight(ivec2(high.x, i.y), field) - storedHeight(ivec2(low.x, i.y), field);
    float dy = storedHeight(ivec2(i.x, high.y), field) - storedHeight(ivec2(i.x, low.y), field);
    vec2 span = vec2(max(high - low, ivec2(1))) * field.texelSize;
    return normalize(vec3(-dx * field.heightScale / span.x, dy * field.heightScale / span.y, 1.0));
}

// Normal at g: bilinear between texels.
vec3 normalAt(vec2 g, Field field) {
    vec2 cell = floor(g);
    vec2 f = g - cell;
    ivec2 i = ivec2(cell) - 1;
    vec3 low = mix(texelNormal(i, field), texelNormal(i + ivec2(1, 0), field), f.x);
    vec3 high = mix(texelNormal(i + ivec2(0, 1), field), texelNormal(i + ivec2(1, 1), field), f.x);
    return normalize(mix(low, high, f.y));
}

// The ray through a point of the field along a unit vector of object space; relative to that point's cell and to
// the given height. Components too small to leave a cell count as 0.
Ray rayFrom(vec2 g, float z0, vec3 direction, float reference, float offset, Field field) {
    vec2 step = vec2(direction.x, -direction.y) / field.texelSize;
    step = vec2(abs(step.x) < 1e-18 ? 0.0 : step.x, abs(step.y) < 1e-18 ? 0.0 : step.y);
    ivec2 base = ivec2(floor(g));
    return Ray(base, g - vec2(base), step, z0, direction.z, reference, offset);
}

// Object space to g and back; z is not concerned.
vec2 gridFromObject(vec2 p, Field field) { return vec2(p.x, -p.y) / field.texelSize + 0.5 * field.texels + 0.5; }
vec2 objectFromGrid(vec2 g, Field field) {
    vec2 p = (g - 0.5 - 0.5 * field.texels) * field.texelSize;
    return vec2(p.x, -p.y);
}

// Stretch of the ray over the footprint, within [from, to]; empty when x >= y.
vec2 clipToFootprint(Ray ray, Field field, float from, float to) {
    vec2 low = vec2(0.5) - vec2(ray.base) - ray.origin;
    vec2 high = low + field.texels;
    for (int axis = 0; axis < 2; ++axis) {
        if (ray.step[axis] == 0.0) {
            if (low[axis] > 0.0 || high[axis] < 0.0) return vec2(1.0, 0.0);
        } else {
            float a = low[axis] / ray.step[axis];
            float b = high[axis] / ray.step[axis];
            from = max(from, min(a, b));
            to = min(to, max(a, b));
        }
    }
    return vec2(from, to);
}

// Where the ray leaves a cell of the given level: x and y crossings. Ties and rounding only ever make a stretch
// of length 0, because every stretch starts where the last one ended.
vec2 cellExit(ivec2 cell, int level, Ray ray, vec2 inverseStep, ivec2 forward) {
    vec2 border = vec2(((cell + forward) << level) - ray.base) - ray.origin;
    return border * inverseStep;
}

// Follows the ray over [from, to] and sums what lies inside the solid. Whole cells of the pyramid are added or
// skipped at once; at the samples the length is exact. Stops as soon as more than `enough` is inside.
Crossing walk(Ray ray, Field field, float from, float to, float enough) {
    Crossing crossing = Crossing(0.0, 1e30, 0);
    vec2 span = clipToFootprint(ray, field, from, to);
    float s = span.x;
    float end = span.y;
    // Above the highest point nothing is inside: a rising ray ends there, a falling one begins.
    float ceiling = relativeHeight(field.highest, ray, field);
    if (ray.rise > 0.0) end = min(end, (ceiling - ray.z0) / ray.rise);
    else if (ray.rise < 0.0) s = max(s, (ceiling - ray.z0) / ray.rise);
    else if (ray.z0 >= ceiling) return crossing;
    if (!(s < end)) return crossing;

    // A direction component of 0 never leaves its cell: its exit is at +infinity.
    vec2 inverseStep = vec2(ray.step.x == 0.0 ? 1e30 : 1.0 / ray.step.x, ray.step.y == 0.0 ? 1e30 : 1.0 / ray.step.y);
    ivec2 forward = ivec2(ray.step.x >= 0.0 ? 1 : 0, ray.step.y >= 0.0 ? 1 : 0);
    ivec2 stride = 2 * forward - 1;
    float unit = (field.highest - field.lowest) * field.heightScale / 65535.0;
    float floorZ = relativeHeight(field.lowest, ray, field);
    int topLevel = int(field.topLevel) + 1; // in levels of cells; level k of the pyramid is k + 1 here
    int level = min(3, topLevel);
    ivec2 cell = (ray.base + ivec2(floor(ray.origin + s * ray.step))) >> level;

    while (s < end && crossing.inside <= enough) {
        crossing.steps += 1;
        vec2 exits = cellExit(cell, level, ray, inverseStep, forward);
        bool alongX = exits.x < exits.y;
        float exit = clamp(min(exits.x, exits.y), s, end);
        vec2 heights = vec2(texelFetch(uPyramid, cell, level - 1).rg) * unit + floorZ;
        float zIn = ray.z0 + s * ray.rise;
        float zOut = ray.z0 + exit * ray.rise;
        bool below = max(zIn, zOut) <= heights.x;
        bool above = min(zIn, zOut) >= heights.y;
        bool leaf = !below && !above && level == 1;
        if (below) {
            crossing.inside += exit - s;
            crossing.entry = min(crossing.entry, s);
        }
        if (!below && !above && level > 1) {
            // Down into the child that holds s.
            level -= 1;
            vec2 middle = vec2(((2 * cell + 1) << level) - ray.base) - ray.origin;
            cell = 2 * cell + ivec2(greaterThanEqual(s * ray.step, middle));
            continue;
        }
        // The two or three cells of samples inside this block.
        float at = s;
        ivec2 leafCell = ray.base + ivec2(floor(ray.origin + s * ray.step));
        leafCell = clamp(leafCell, 2 * cell, 2 * cell + 1);
        while (leaf && at < exit) {
            crossing.steps += 1;
            vec2 leafExits = cellExit(leafCell, 0, ray, inverseStep, forward);
            float leafExit = clamp(min(leafExits.x, leafExits.y), at, exit);
            float h00 = storedHeight(leafCell - 1, field);
            float h10 = storedHeight(leafCell + ivec2(0, -1), field);
            float h01 = storedHeight(leafCell + ivec2(-1, 0), field);
            float h11 = storedHeight(leafCell, field);
            float slopeX = (h10 - h00) * field.heightScale;
            float slopeY = (h01 - h00) * field.heightScale;
            float twist = (h11 - h10 - h01 + h00) * field.heightScale;
            vec2 f = vec2(ray.base - leafCell) + ray.origin + at * ray.step;
            float c = relativeHeight(h00, ray, field) + f.x * slopeX + f.y * (slopeY + f.x * twist) -
                      (ray.z0 + at * ray.rise);
            float b = ray.step.x * (slopeX + f.y * twist) + ray.step.y * (slopeY + f.x * twist) - ray.rise;
            float a = ray.step.x * ray.step.y * twist;
            vec2 part = positivePart(a, b, c, leafExit - at);
            crossing.inside += part.x;
            crossing.entry = min(crossing.entry, at + part.y);
            if (leafExits.x < leafExits.y) leafCell.x += stride.x;
            else leafCell.y += stride.y;
            at = leafExit;
            if (any(lessThan(leafCell, 2 * cell)) || any(greaterThan(leafCell, 2 * cell + 1))) break;
        }
        // On to the neighbour; up where it belongs to another parent.
        s = exit;
        if (alongX) cell.x += stride.x;
        else cell.y += stride.y;
        int entered = alongX ? cell.x + 1 - forward.x : cell.y + 1 - forward.y;
        if ((entered & 1) == 0 && level < topLevel) {
            level += 1;
            cell >>= 1;
        }
    }
    return crossing;
}
