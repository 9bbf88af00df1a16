// subsurface/balls.frag: balls around the places of squares of the picture, which splats that meet none of them miss.
//
// in    uPlaces  subsurface/receivers.frag
// out   oBall    xyz: world, middle; w: radius [m], below 0 where the square shows nothing
layout(std140) uniform BallsBlock {
    int side; // of a square
} balls;
uniform sampler2D uPlaces;
layout(location = 0) out vec4 oBall;

const float kFar = 1e30;

void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * balls.side;
    ivec2 last = textureSize(uPlaces, 0) - 1;
    int count = balls.side * balls.side;
    vec3 low = vec3(kFar);
    vec3 high = vec3(-kFar);
    for (int i = 0; i < count; ++i) {
        vec4 place = texelFetch(uPlaces, min(corner + ivec2(i % balls.side, i / balls.side), last), 0);
        if (place.w == 0.0) continue;
        low = min(low, place.xyz);
        high = max(high, place.xyz);
    }
    vec3 middle = 0.5 * (low + high);
    float radius = -kFar;
    for (int i = 0; i < count; ++i) {
        vec4 place = texelFetch(uPlaces, min(corner + ivec2(i % balls.side, i / balls.side), last), 0);
        if (place.w != 0.0) radius = max(radius, distance(place.xyz, middle));
    }
    oBall = vec4(middle, radius);
}
