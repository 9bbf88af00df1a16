// views/view.glsl: a view as lines through its pixels. Places are measured from the view's eye.
//
// A place is pixel coordinates (middle of the lowest left pixel: 0.5, 0.5) and a depth in metres along `forward`.
struct View {
    vec4 eye;     // world; w: 1 for a perspective view, 0 for a parallel one
    vec4 forward; // world, unit; w: far depth
    vec4 right;   // world way of one pixel: in metres, or of a perspective view a metre deep; w: near depth
    vec4 up;
    vec2 size;    // pixels
    vec2 middle;  // pixel coordinates that `forward` goes through
    vec4 cut;     // plane from the eye: what lies where dot(cut, (place, 1)) is below 0 is not shown
};

// Whether a place lies before what the view shows, as behind the mirror whose view it is.
bool isCut(View view, vec3 place) { return dot(view.cut.xyz, place) + view.cut.w < 0.0; }

// From the eye to a place.
vec3 placeFrom(View view, vec2 pixel, float depth) {
    vec2 p = pixel - view.middle;
    return (p.x * view.right.xyz + p.y * view.up.xyz) * (view.eye.w > 0.5 ? depth : 1.0) + depth * view.forward.xyz;
}

// The eye ray through a pixel, unit.
vec3 eyeRay(View view, vec2 pixel) {
    if (view.eye.w < 0.5) return view.forward.xyz;
    vec2 p = pixel - view.middle;
    return normalize(p.x * view.right.xyz + p.y * view.up.xyz + view.forward.xyz);
}

// A vector from the eye in the view's own measures: pixels from the middle (times depth in a perspective view),
// and depth.
vec3 inView(View view, vec3 v) {
    return vec3(dot(v, view.right.xyz) / dot(view.right.xyz, view.right.xyz),
                dot(v, view.up.xyz) / dot(view.up.xyz, view.up.xyz), dot(v, view.forward.xyz));
}

// Pixel coordinates of what inView() gave.
vec2 pixelOf(View view, vec3 v) { return v.xy / (view.eye.w > 0.5 ? v.z : 1.0) + view.middle; }

// Depth as a depth buffer holds it, evenly spaced.
float bufferDepth(View view, float depth) {
    return clamp((depth - view.right.w) / (view.forward.w - view.right.w), 0.0, 1.0);
}
