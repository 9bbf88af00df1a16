// brdf/in_view.glsl: a ray from a mirror to what the camera sees.
//
// in    views/pictured.glsl  what is seen, but for mirrors
// The file that includes this defines environmentAt(direction).
// not   what the camera does not see: the environment stands there
const int kMostSteps = 256;
const float kPixelsAStep = 2.0;
const int kHalvingSteps = 5;

// A share of the way in the picture as a share of the ray.
float alongRay(View view, float share, float near, float far) {
    return view.eye.w > 0.5 ? share * near / mix(far, near, share) : share;
}

// [m] by which a place lies before what is seen in its pixel; 1e30: nothing there.
float gapInView(View view, vec3 v) {
    vec4 solid = texelFetch(uSolid, ivec2(clamp(pixelOf(view, v), vec2(0.0), view.size - 1.0)), 0);
    return solid.a == 0.0 ? 1e30 : solid.r - v.z;
}

// Where the ray meets the plane of what a pixel shows, in the pixels beside it; below 0: it does not.
float planeInView(View view, vec3 origin, vec3 direction, vec3 v) {
    ivec2 pixel = ivec2(clamp(pixelOf(view, v), vec2(0.0), view.size - 1.0));
    vec4 solid = texelFetch(uSolid, pixel, 0);
    vec3 n = fromOctahedral(solid.gb);
    float slope = dot(direction, n);
    if (solid.a == 0.0 || slope > -1e-4) return -1.0;
    float t = dot(placeFrom(view, vec2(pixel) + 0.5, solid.r) - origin, n) / slope;
    vec2 apart = abs(pixelOf(view, inView(view, origin + t * direction)) - vec2(pixel) - 0.5);
    return max(apart.x, apart.y) < 2.0 ? t : -1.0;
}

vec4 lightInView(View view, vec3 origin, vec3 direction) {
    vec3 from = inView(view, origin), along = inView(view, direction);
    float end = along.z > 0.0 ? (view.forward.w - from.z) / along.z : 1e30;
    if (along.z < 0.0) end = (view.right.w - from.z) / along.z;
    end = clamp(end, 0.0, 1e3 * view.forward.w);
    float near = from.z, far = from.z + end * along.z;
    vec2 first = pixelOf(view, from), last = pixelOf(view, from + end * along);
    // Until it leaves the picture.
    vec2 way = mix(last - first, vec2(1e-20), lessThan(abs(last - first), vec2(1e-20)));
    vec2 leaves = (mix(vec2(0.0), view.size, step(0.0, way)) - first) / way;
    float shown = clamp(min(leaves.x, leaves.y), 0.0, 1.0);
    int steps = int(clamp(ceil(shown * length(way) / kPixelsAStep), 1.0, float(kMostSteps)));
    float before = 0.0;
    bool isBefore = true;
    for (int i = 1; i <= steps; ++i) {
        float t = end * alongRay(view, shown * float(i) / float(steps), near, far);
        bool isBehind = gapInView(view, from + t * along) < 0.0;
        if (isBefore && isBehind) {
            float low = before, high = t;
            for (int halving = 0; halving < kHalvingSteps; ++halving) {
                float middle = 0.5 * (low + high);
                if (gapInView(view, from + middle * along) < 0.0) high = middle;
                else low = middle;
            }
            for (int side = 0; side < 2; ++side) {
                float met = planeInView(view, origin, direction, from + (side == 0 ? high : low) * along);
                if (met < 0.0) continue;
                ivec2 pixel = ivec2(clamp(pixelOf(view, from + met * along), vec2(0.0), view.size - 1.0));
                vec4 light = texelFetch(uShown, pixel, 0);
                vec3 normal = fromOctahedral(texelFetch(uSolid, pixel, 0).yz);
                return vec4(picturedAt(view, origin + met * direction, normal, light.rgb), light.a);
            }
        }
        isBefore = !isBehind;
        before = t;
    }
    return environmentAt(direction);
}
