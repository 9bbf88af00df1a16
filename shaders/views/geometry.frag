// views/geometry.frag: a geometric quantity of each visible point of one object.
//
// out   oSum.rgb  SHOW_NORMAL: world normal; SHOW_POSITION: world position [m]; SHOW_DEPTH: distance from the eye
//                 along the view direction [m], in all three
#include "lib/quadratic.glsl"
#include "views/field.glsl"
#include "views/surface_pixel.glsl"
layout(std140) uniform GeometryBlock {
    mat4 worldFromObject;
    vec4 eye;     // world
    vec4 forward; // world, unit
    Field field;
    int object;
} geometry;
layout(location = 0) out vec4 oSum;

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.object != geometry.object) discard;
    vec3 normal = pixel.face == 1 ? normalAt(pixel.g, geometry.field) : wallNormal(pixel.face);
    vec3 position = (geometry.worldFromObject * vec4(objectFromGrid(pixel.g, geometry.field), pixel.z, 1.0)).xyz;
#if defined(SHOW_NORMAL)
    oSum = vec4(normalize(mat3(geometry.worldFromObject) * normal), 1.0);
#elif defined(SHOW_POSITION)
    oSum = vec4(position, 1.0);
#else
    oSum = vec4(vec3(dot(position - geometry.eye.xyz, geometry.forward.xyz)), 1.0);
#endif
}
