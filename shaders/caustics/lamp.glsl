// caustics/lamp.glsl: what the rays of a light carry.
#include "views/view.glsl"
#include "light/picture.glsl"

struct Lamp {
    vec4 color; // [W/m², W/sr]; a: exponent of the cone
    vec4 axis;  // unit: along which it shines most; w: 1 where light fades with the squared distance
    vec2 cone;  // scale and offset of the cosine to the axis
    vec2 grid;  // rays a side
    PictureFrame picture;
};

// Whether a pixel belongs to the lamp's next view.
bool isBeside(View view, int border, ivec2 pixel) {
    return any(lessThan(pixel, ivec2(border))) || any(greaterThanEqual(pixel, ivec2(view.size) - border));
}

// Irradiance or intensity in a direction.
vec3 shiningTo(Lamp lamp, vec3 direction) {
    float cone = pow(clamp(lamp.cone.y + lamp.cone.x * dot(direction, lamp.axis.xyz), 0.0, 1.0), lamp.color.a);
    return cone * lamp.color.rgb * projectedAt(lamp.picture, lamp.axis.xyz, direction);
}

// Flux of one ray of the grid: of parallel light irradiance times the area of a texel, of a point intensity times its
// solid angle. No cosine at the surface comes in: it is in the number of rays that a slanted surface gets.
//
// reach  [m] from a point to the first surface: what does not fade keeps its irradiance there
vec3 fluxOf(View view, Lamp lamp, vec3 eye, float reach) {
    vec2 texel = vec2(length(view.right.xyz), length(view.up.xyz)) * view.size / lamp.grid;
    float part = texel.x * texel.y;
    if (view.eye.w > 0.5) {
        float cosine = dot(eye, view.forward.xyz);
        part *= cosine * cosine * cosine;
        if (lamp.axis.w < 0.5) part *= reach * reach;
    }
    return part * shiningTo(lamp, eye);
}
