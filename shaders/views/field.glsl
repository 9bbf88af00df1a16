// views/field.glsl: a height field and the one walk through it that everything here is made of.
//
// Coordinates  g: texels + 1/2, so that sample (i, j) stands at g = (i + 1, j + 1), cell (i, j) = [i, i+1] x [j, j+1]
//              lies between four samples and the footprint is [1/2, n + 1/2]. z: metres above the shading point.
//              All is relative to a base cell and a reference height near the shading point: in absolute
//              coordinates a depth of 1e-6 would keep one digit.
// Pyramid      level k >= 1 holds the lowest and highest height of 2^k cells squared, 16 bits each in one word,
//              rounded outwards, over [lowest, highest]. All levels lie in one image: level 1 at the left, the
//              others on top of each other right of it. (Mip levels would do, but a level that differs from pixel
//              to pixel makes software drivers slow.)
struct Field {
    vec2 texels;       // N x M samples
    float texelSize;   // m
    float heightScale; // m for a height of 1
    float lowest;      // stored height
    float highest;     // stored height
    float bottom;      // m, where drawn side walls end
    float topLevel;    // coarsest level of the pyramid, >= 1
};

const int kFirstLevel = 3; // where a walk begins: 8 x 8 cells; 2 to 4 differ little

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

float storedHeight(ivec2 sampleIndex) { return texelFetch(uHeights, sampleIndex, 0).r; }

// The four samples around a cell; at the border two of them, or all, are the same.
struct Corners {
    float h00, h10, h01, h11; // first index: column
};

Corners cornersOf(ivec2 cell, Field field) {
    ivec2 last = ivec2(field.texels) - 1;
    ivec2 low = clamp(cell - 1, ivec2(0), last);
    ivec2 high = clamp(cell, ivec2(0), last);
    return Corners(storedHeight(low), storedHeight(ivec2(high.x, low.y)), storedHeight(ivec2(low.x, high.y)),
                   storedHeight(high));
}

float relativeHeight(float stored, Ray ray, Field field) {
    return (stored - ray.reference) * field.heightScale - ray.offset;
}

// Stored height at g, bilinear, constant in the outer half texel.
float heightAt(vec2 g, Field field) {
    vec2 cell = floor(g);
    vec2 f = g - cell;
    Corners c = cornersOf(ivec2(cell), field);
    return c.h00 + f.x * (c.h10 - c.h00) + f.y * (c.h01 - c.h00 + f.x * (c.h11 - c.h10 - c.h01 + c.h00));
}

// Normal of one texel in object space: central difference in world units, one-sided at the border. Image rows
// run towards -y.
vec3 texelNormal(ivec2 i, Field field) {
    ivec2 last = ivec2(field.texels) - 1;
    i = clamp(i, ivec2(0), last);
    ivec2 low = max(i - 1, ivec2(0));
    ivec2 high = min(i + 1, last);
    float dx = storedHeight(ivec2(high.x, i.y)) - storedHeight(ivec2(low.x, i.y));
    float dy = storedHeight(ivec2(i.x, high.y)) - storedHeight(ivec2(i.x, low.y));
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

// Lowest and highest height of a block, in 1/65535 of the field's range.
vec2 blockHeights(ivec2 block, int level, ivec2 finest) {
    ivec2 corner = level == 1 ? ivec2(0) : ivec2(finest.x, finest.y - (finest.y >> (level - 2)));
    uint word = texelFetch(uPyramid, corner + block, 0).r;
    return vec2(float(word & 0xffffu), float(word >> 16));
}

// A place on the way: a block of cells at a level of the pyramid. Level 0 is a single cell.
struct Block {
    ivec2 cell;
    int level;
};

// What stays the same along a ray.
struct Way {
    vec2 inverseStep;
    ivec2 forward; // 1 where the ray runs towards greater g
    int topLevel;
};

// Where the ray leaves a block, for its x and its y borders. Ties and rounding only ever make stretches of
// length 0, because every stretch starts where the last one ended.
vec2 exits(Block block, Ray ray, Way way) {
    return (vec2(((block.cell + way.forward) << block.level) - ray.base) - ray.origin) * way.inverseStep;
}

// On to the neighbour through the nearer border, and up where that belongs to another parent.
Block leave(Block block, vec2 borders, Way way) {
    bool alongX = borders.x < borders.y;
    ivec2 stride = 2 * way.forward - 1;
    block.cell += ivec2(alongX ? stride.x : 0, alongX ? 0 : stride.y);
    int entered = alongX ? block.cell.x - way.forward.x : block.cell.y - way.forward.y;
    bool up = (entered & 1) != 0 && block.level < way.topLevel;
    block.level += up ? 1 : 0;
    block.cell >>= up ? 1 : 0;
    return block;
}

// Down into the child that holds ray parameter s.
Block child(Block block, float s, Ray ray) {
    block.level -= 1;
    vec2 middle = vec2(((2 * block.cell + 1) << block.level) - ray.base) - ray.origin;
    block.cell = 2 * block.cell + ivec2(greaterThanEqual(s * ray.step, middle));
    return block;
}

// Stretch [from, to] of the ray inside one cell: the quadratic height less the ray's height, solved exactly.
vec2 insideCell(ivec2 cell, Ray ray, Field field, float from, float to) {
    Corners h = cornersOf(cell, field);
    float slopeX = (h.h10 - h.h00) * field.heightScale;
    float slopeY = (h.h01 - h.h00) * field.heightScale;
    float twist = (h.h11 - h.h10 - h.h01 + h.h00) * field.heightScale;
    vec2 f = vec2(ray.base - cell) + ray.origin + from * ray.step;
    float c = relativeHeight(h.h00, ray, field) + f.x * slopeX + f.y * (slopeY + f.x * twist) -
              (ray.z0 + from * ray.rise);
    float b = ray.step.x * (slopeX + f.y * twist) + ray.step.y * (slopeY + f.x * twist) - ray.rise;
    float a = ray.step.x * ray.step.y * twist;
    return positivePart(a, b, c, to - from);
}

// Follows the ray over [from, to] and sums what lies inside the solid. Whole blocks of the pyramid are added or
// skipped at once; at the samples the length is exact. Stops as soon as more than `enough` is inside.
//
// The walk over blocks runs until it meets one of 2 x 2 cells that the ray may cross, and only then looks at cells:
// pixels that are drawn together then do the same thing at the same time (after Aila, Laine 2009).
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
    // Below the lowest point all is inside: a falling ray is followed down to there only.
    float floorZ = relativeHeight(field.lowest, ray, field);
    float sunk = ray.rise < 0.0 ? clamp((floorZ - ray.z0) / ray.rise, s, max(s, end)) : end;
    float sunkLength = max(end - sunk, 0.0);
    end = min(end, sunk);

    // A direction component of 0 never leaves its cell: its border is at +infinity.
    Way way = Way(vec2(ray.step.x == 0.0 ? 1e30 : 1.0 / ray.step.x, ray.step.y == 0.0 ? 1e30 : 1.0 / ray.step.y),
                  ivec2(ray.step.x >= 0.0 ? 1 : 0, ray.step.y >= 0.0 ? 1 : 0), int(field.topLevel));
    float unit = (field.highest - field.lowest) * field.heightScale / 65535.0;
    ivec2 finest = textureSize(uPyramid, 0); // level 1 is two thirds of the image's width and all of its height
    finest.x = finest.x * 2 / 3;
    int level = min(kFirstLevel, way.topLevel);
    Block block = Block((ray.base + ivec2(floor(ray.origin + s * ray.step))) >> level, level);

    while (s < end && crossing.inside <= enough) {
        bool crosses = false;
        vec2 borders;
        float exit = s;
        while (!crosses && s < end && crossing.inside <= enough) {
            crossing.steps += 1;
            borders = exits(block, ray, way);
            exit = clamp(min(borders.x, borders.y), s, end);
            vec2 heights = blockHeights(block.cell, block.level, finest) * unit + floorZ;
            float zIn = ray.z0 + s * ray.rise;
            float zOut = ray.z0 + exit * ray.rise;
            bool below = max(zIn, zOut) <= heights.x;
            bool above = min(zIn, zOut) >= heights.y;
            if (below || above) {
                if (below) {
                    crossing.inside += exit - s;
                    crossing.entry = min(crossing.entry, s);
                }
                s = exit;
                block = leave(block, borders, way);
            } else if (block.level > 1) {
                block = child(block, s, ray);
            } else {
                crosses = true;
            }
        }
        Block cell = child(block, s, ray);
        while (crosses && s < exit) {
            crossing.steps += 1;
            vec2 cellBorders = exits(cell, ray, way);
            float cellExit = clamp(min(cellBorders.x, cellBorders.y), s, exit);
            vec2 part = insideCell(cell.cell, ray, field, s, cellExit);
            crossing.inside += part.x;
            crossing.entry = min(crossing.entry, s + part.y);
            s = cellExit;
            cell.cell += cellBorders.x < cellBorders.y ? ivec2(2 * way.forward.x - 1, 0)
                                                       : ivec2(0, 2 * way.forward.y - 1);
            if ((cell.cell >> 1) != block.cell) break;
        }
        if (crosses) {
            s = exit;
            block = leave(block, borders, way);
        }
    }
    if (sunkLength > 0.0 && crossing.inside <= enough) {
        crossing.inside += sunkLength;
        crossing.entry = min(crossing.entry, sunk);
    }
    return crossing;
}
