// caustics/beam.vert: the triangles of the grid, carried to the receivers.
//
// in    gl_VertexID  three a triangle; AS_POINTS: one
//       uShare       caustics/share.frag
// out   vFlux flat   [light.unit] of a texel; AS_POINTS: of the whole triangle
// model flux over area (beams after Watt 1990), so that triangles that lie side by side are evenly bright. Of small ones
//       many hold no texel's middle: part of their flux, at last all of it, is drawn as a point. Thin ones, as at
//       folds, lie on each other rather than side by side: flux over the number of texels that they cover, so that it
//       is kept; those that cover none are points
#include "caustics/deposit_block.glsl"
#include "caustics/grid.glsl"
uniform sampler2D uShare;
flat out vec3 vFlux;

const float kMostCounted = 16.0; // texels a side of the box around a thin triangle
const float kThin = 0.15;       // area over the square of the longest side; 0.43 where all are alike
const vec2 kSmall = vec2(0.5, 2.0); // texels, of what is all and not at all a point

float crossOf(vec2 u, vec2 v) { return u.x * v.y - u.y * v.x; }

// How many texels a triangle covers.
float covered(vec2 a, vec2 b, vec2 c, vec2 low, vec2 size) {
    float side = sign(crossOf(b - a, c - a));
    float count = 0.0;
    for (float y = 0.0; y < size.y; ++y)
        for (float x = 0.0; x < size.x; ++x) {
            vec2 p = low + vec2(x, y);
            vec3 inside = side * vec3(crossOf(b - a, p - a), crossOf(c - b, p - b), crossOf(a - c, p - c));
            if (all(greaterThan(inside, vec3(0.0)))) ++count;
        }
    return count;
}

// x: texels over which a triangle's flux is spread; y: share of the flux that a point gets.
vec2 spreadOf(vec2 a, vec2 b, vec2 c) {
    float area = 0.5 * abs(crossOf(b - a, c - a));
    float longest = max(dot(b - a, b - a), max(dot(c - b, c - b), dot(a - c, a - c)));
    vec2 low = ceil(min(a, min(b, c)) - 0.5) + 0.5; // the lowest texel's middle
    vec2 size = floor(max(a, max(b, c)) - low) + 1.0;
    float part = clamp((kSmall.y - area) / (kSmall.y - kSmall.x), 0.0, 1.0);
    if (area > kThin * longest || max(size.x, size.y) > kMostCounted) return vec2(max(area, 1e-6), part);
    float count = covered(a, b, c, low, size);
    return vec2(max(count, 1.0), count > 0.0 ? 0.0 : 1.0);
}

void main() {
#ifdef AS_POINTS
    int number = gl_VertexID;
    gl_PointSize = 1.0;
#else
    int number = gl_VertexID / 3;
#endif
    int columns = light.grid.x - 1;
    ivec2 square = ivec2((number >> 1) % columns, (number >> 1) / columns);
    int triangle = number & 1;
    vFlux = vec3(0.0);
    gl_Position = kAway;
    if ((int(texelFetch(uShare, square, 0).a) & (8 << triangle)) == 0) return;
    vec3 sum = vec3(0.0);
    vec3 flux = vec3(0.0);
    vec3 corners[3];
    bool before = true;
    for (int corner = 0; corner < 3; ++corner) {
        ivec2 ray = cornerOf(square, triangle, corner);
        vec3 place = texelFetch(uLanding, ray, 0).xyz;
        sum += place / 3.0;
        flux += texelFetch(uShare, ray, 0).rgb;
        corners[corner] = onMap(place);
        before = before && (light.faces[light.face].eye.w < 0.5 || corners[corner].z > 0.0);
    }
    if (!before) return;
    vec2 spread = spreadOf(corners[0].xy, corners[1].xy, corners[2].xy);
#ifdef AS_POINTS
    if (spread.y == 0.0 || faceOf(sum) != light.face) return;
    vFlux = spread.y * flux / light.unit;
    gl_Position = clipFromMap(onMap(sum).xy);
#else
    if (spread.y == 1.0) return;
    vFlux = (1.0 - spread.y) * flux / (light.unit * spread.x);
    int corner = gl_VertexID % 3;
    gl_Position = clipFromMap((corner == 0 ? corners[0] : corner == 1 ? corners[1] : corners[2]).xy);
#endif
}
