// caustics/photon.glsl: a ray of the grid: where it begins, and what becomes of it.
//
// The file that includes this has said whether a pixel of the light's view shows what bends light: isMet().
// out   a ray that leaves what bends it; WITH_BOOK: where its light stays
#ifdef WITH_BOOK
layout(location = 0) out vec4 oMet; // [W]
layout(location = 1) out vec4 oAbsorbed;
layout(location = 2) out vec4 oReflected;
layout(location = 3) out vec4 oLost;
void clearOutputs() { oMet = oAbsorbed = oReflected = oLost = vec4(0.0); }
#else
layout(location = 0) out vec4 oPlace;     // world; w: the way it took as a number, 0: no ray
layout(location = 1) out vec4 oDirection; // unit; w: 1 where the place is already on an opaque object, inside glass
layout(location = 2) out vec4 oFlux;      // [W]; a: 1
void clearOutputs() { oPlace = oDirection = oFlux = vec4(0.0); }
#endif

struct Start {
    ivec2 pixel;    // that shows what bends light, nearest to the middle of those of the ray's cell that do
    float coverage; // share of the cell's pixels that do; 0: there is no ray
};

Start startOf(View view, vec2 grid) {
    int side = int(view.size.x / grid.x);
    ivec2 corner = side * ivec2(gl_FragCoord.xy);
    vec2 middle = vec2(0.0);
    float count = 0.0;
    for (int i = 0; i < side * side; ++i) {
        ivec2 within = ivec2(i % side, i / side);
        if (!isMet(corner + within)) continue;
        middle += vec2(within);
        ++count;
    }
    middle /= max(count, 1.0);
    Start start = Start(corner, count / float(side * side));
    float nearest = 1e30;
    for (int i = 0; i < side * side; ++i) {
        ivec2 within = ivec2(i % side, i / side);
        float apart = distance(vec2(within), middle);
        if (apart >= nearest || !isMet(corner + within)) continue;
        nearest = apart;
        start.pixel = corner + within;
    }
    return start;
}
