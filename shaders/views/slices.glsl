// views/slices.glsl: depths as slices between two bounds (multiple-refractions thesis 2008, 3.3 and 3.4).
//
// The file that includes this is compiled with SLICES.

// The slice nearest to a depth: the first at bounds.x, the last at bounds.y.
int sliceOf(float depth, vec2 bounds) {
    float part = bounds.y > bounds.x ? (depth - bounds.x) / (bounds.y - bounds.x) : 0.0;
    return int(clamp(part, 0.0, 1.0) * float(SLICES - 1) + 0.5);
}

float depthOfSlice(int slice, vec2 bounds) {
    return mix(bounds.x, bounds.y, float(slice) / float(SLICES - 1));
}
