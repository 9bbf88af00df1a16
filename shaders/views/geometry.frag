// views/geometry.frag: a geometric quantity of each visible point of one height field; OF_MESHES: of all that is no
// height field.
//
// out   oSum.rgb  SHOW_NORMAL: world normal; SHOW_POSITION: world position [m]; SHOW_DEPTH: distance from the eye
//                 along the view direction [m], in all three
//                 SHOW_SOLID: depth, octahedral normal, 1 (uSolid of views/layers.glsl)
#pragma variants SHOW_NORMAL SHOW_POSITION SHOW_DEPTH SHOW_SOLID
#pragma variants - OF_MESHES
#include "views/surface_pixel.glsl"
#include "lib/octahedral.glsl"
#ifdef OF_MESHES
#include "views/view.glsl"
layout(std140) uniform SolidBlock {
    View view;
} geometry;
#else
#include "lib/quadratic.glsl"
#include "views/field.glsl"
layout(std140) uniform GeometryBlock {
    mat4 worldFromObject;
    vec4 eye;     // world
    vec4 forward; // world, unit
    Field field;
    int object;
} geometry;
#endif
layout(location = 0) out vec4 oSum;

void main() {
    SurfacePixel pixel = readSurface();
#ifdef OF_MESHES
    if (pixel.face != kMeshFace) discard;
    vec3 normal = fromOctahedral(pixel.g);
    float depth = pixel.z;
    vec3 position = geometry.view.eye.xyz + placeFrom(geometry.view, gl_FragCoord.xy, depth);
#else
    if (pixel.object != geometry.object) discard;
    vec3 normal = mat3(geometry.worldFromObject) *
                  (pixel.face == 1 ? normalAt(pixel.g, geometry.field) : wallNormal(pixel.face));
    vec3 position = (geometry.worldFromObject * vec4(objectFromGrid(pixel.g, geometry.field), pixel.z, 1.0)).xyz;
    float depth = dot(position - geometry.eye.xyz, geometry.forward.xyz);
#endif
#if defined(SHOW_SOLID)
    oSum = vec4(depth, octahedralFrom(normalize(normal)), 1.0);
#elif defined(SHOW_NORMAL)
    oSum = vec4(normalize(normal), 1.0);
#elif defined(SHOW_POSITION)
    oSum = vec4(position, 1.0);
#else
    oSum = vec4(vec3(depth), 1.0);
#endif
}
