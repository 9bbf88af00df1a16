// caustics/grid.glsl: the rays of a light as the vertices of a grid of triangles.
//
// Square (i, j) of rays (i, j) ... (i + 1, j + 1) is cut from its right lower to its left upper corner: triangle 0 is
// the one at its lowest ray, triangle 1 the other.
uniform sampler2D uLanding;

ivec2 cornerOf(ivec2 square, int triangle, int corner) {
    ivec2 low = corner == 0 ? ivec2(triangle, 0) : corner == 1 ? ivec2(1, triangle) : ivec2(0, 1);
    return square + low;
}

// Flux of a triangle [W]: six lie around each ray.
vec3 triangleFlux(sampler2D flux, ivec2 square, int triangle) {
    vec3 sum = vec3(0.0);
    for (int corner = 0; corner < 3; ++corner)
        sum += texelFetch(flux, cornerOf(square, triangle, corner), 0).rgb;
    return sum / 6.0;
}

// Receivers that are steeper against the light are two, of which one lies behind the other.
const float kMostSteep = 8.0;

// Whether two rays land on one surface.
//
// along  unit: of the light there
bool isNear(vec3 a, vec3 b, vec3 along) {
    float deeper = abs(dot(b - a, along));
    return deeper * deeper * (1.0 + 1.0 / (kMostSteep * kMostSteep)) <= dot(b - a, b - a) + 1e-12;
}
