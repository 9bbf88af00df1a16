// caustics/photon.glsl: a ray of the grid: where it begins, and what becomes of it.
//
// The file that includes this has said whether a pixel of the light's view shows what bends light: isMet().
// in    uOpticalDepth  USE_BLENDED: of what it passes before
// out   a ray that leaves what bends it; WITH_BOOK: where its light stays
// model VERTICES: the rays through the middles of cells, for beams (caustics/beams.frag); RESTS: a ray for each cell,
//       of what no beam carries: where what bends light ends, or its rays part; PIXELS: for each pixel of that; both
//       packed (caustics/lone_cells.glsl). VERTICES and one of the two together carry all light. Else a ray for each
//       cell, full or not
#if defined(PACKED) || (defined(VERTICES) && defined(WITH_BOOK))
#include "caustics/beams.glsl"
#endif
#ifdef PACKED
#include "caustics/lone_cells.glsl"
#endif
#ifdef WITH_BOOK
layout(location = 0) out vec4 oMet; // [W]; a: the share of the ray's flux that is its own to carry
layout(location = 1) out vec4 oAbsorbed;
layout(location = 2) out vec4 oReflected;
layout(location = 3) out vec4 oLost;
void clearOutputs() { oMet = oAbsorbed = oReflected = oLost = vec4(0.0); }
#else
layout(location = 0) out vec4 oPlace;     // world; w: the way it took as a number, 0: no ray
layout(location = 1) out vec4 oDirection; // unit; w: 1 where the place is already on an opaque object, inside glass; where
                                          // it goes on in water: -1 - the object's number
layout(location = 2) out vec4 oFlux;      // [W]; a: coverage; VERTICES: 1 + sixths (caustics/sixths.glsl), or below 0
                                          // where a cell has no ray, but pixels that show what bends light
void clearOutputs() { oPlace = oDirection = oFlux = vec4(0.0); }
#endif

#ifdef VERTICES
#include "caustics/sixths.glsl"
float markOf(float coverage, int sixths) { return float(1 + sixths); }
#else
float markOf(float coverage, int sixths) { return coverage; }
#endif

#ifdef USE_BLENDED
uniform sampler2D uOpticalDepth; // views/optical_depth.frag
float transmittanceAt(ivec2 pixel) { return exp(-texelFetch(uOpticalDepth, pixel, 0).r); }
#else
float transmittanceAt(ivec2 pixel) { return 1.0; }
#endif

struct Start {
    ivec2 pixel;    // that shows what bends light
    float coverage; // share of a cell's pixels that the ray stands for; 0: there is no ray
    float own;      // share of that for which it is traced itself: the rest of a cell's is traced by pixels
    int sixths;     // VERTICES: bits of those that are full
    bool isBeside;  // VERTICES: there is no ray, but other pixels of the cell show what bends light
};

// What is left where no ray goes on.
void leave(Start start) {
    clearOutputs();
#ifndef WITH_BOOK
    if (start.coverage > 0.0 || start.isBeside) oFlux.a = -1.0;
#endif
}

#if defined(PIXELS)
Start startOf(View view, vec2 grid) {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    int side = int(view.size.x / grid.x);
    ivec2 place = texel / side;
    if (place.y * int(grid.x) + place.x >= loneCells()) return Start(texel, 0.0, 0.0, 0, false);
    ivec2 pixel = texel + side * (packedAt(place) - place);
    float alone = loneShare(pixel, side, ivec2(grid));
    if (alone == 0.0 || !isMet(pixel)) alone = 0.0;
    return Start(pixel, alone / float(side * side), 1.0, 0, false);
}
#elif defined(VERTICES)
Start startOf(View view, vec2 grid) {
    int side = int(view.size.x / grid.x);
    ivec2 middle = side * ivec2(gl_FragCoord.xy) + side / 2;
    int empty = 0;
    bool isAny = false;
    for (int i = 0; i < side * side; ++i) {
        ivec2 beside = ivec2(i % side, i / side) - side / 2;
        if (isMet(middle + beside)) isAny = true;
        else empty |= sixthsOf(beside);
    }
    if (!isMet(middle)) return Start(middle, 0.0, 0.0, 0, isAny);
    float own = 1.0;
#ifdef WITH_BOOK
    own -= loneShare(middle, side, ivec2(grid));
#endif
    return Start(middle, 1.0, own, 63 & ~empty, false);
}
#else
#ifdef RESTS
float shareOf(ivec2 pixel, int side, vec2 grid) { return isMet(pixel) ? loneShare(pixel, side, ivec2(grid)) : 0.0; }
ivec2 cellAt(ivec2 place) { return packedAt(place); }
bool isCarried(ivec2 place, int side, vec2 grid) {
    return place.y * int(grid.x) + place.x >= loneCells() || loneShare(side * packedAt(place) + side / 2, side, ivec2(grid)) == 0.0;
}
#else
float shareOf(ivec2 pixel, int side, vec2 grid) { return isMet(pixel) ? 1.0 : 0.0; }
ivec2 cellAt(ivec2 place) { return place; }
bool isCarried(ivec2 place, int side, vec2 grid) { return false; }
#endif

// Through the pixel nearest to the middle of those of the cell that count.
Start startOf(View view, vec2 grid) {
    int side = int(view.size.x / grid.x);
    ivec2 place = ivec2(gl_FragCoord.xy);
    ivec2 corner = side * cellAt(place);
    Start start = Start(corner, 0.0, 1.0, 0, false);
    if (isCarried(place, side, grid)) return start;
    vec2 middle = vec2(0.0);
    float count = 0.0;
    for (int i = 0; i < side * side; ++i) {
        ivec2 within = ivec2(i % side, i / side);
        float share = shareOf(corner + within, side, grid);
        middle += share * vec2(within);
        count += share;
    }
    if (count == 0.0) return start;
    middle /= count;
    start.coverage = count / float(side * side);
    float nearest = 1e30;
    for (int i = 0; i < side * side; ++i) {
        ivec2 within = ivec2(i % side, i / side);
        float apart = distance(vec2(within), middle);
        if (apart >= nearest || shareOf(corner + within, side, grid) == 0.0) continue;
        nearest = apart;
        start.pixel = corner + within;
    }
    return start;
}
#endif
