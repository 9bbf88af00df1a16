// views/displaced_textures.frag: what the textures of one displaced mesh say of each point that a view shows of it.
//
// in    uSurface      the visible points (views/surface_pixel.glsl), and views/material_textures.glsl
//       uCoordinates  places on the textures of the mesh's vertices by both sets of coordinates
//       uVertexColors their colours; or one row of white
// out   views/textured.glsl
// model a point has the coordinates of its foot on the triangle (scene/Displacement.h). The depth buffer keeps the triangle
//       whose heights come nearest to the point: above others it may lie as well, where normals meet
#pragma variants -
#include "views/displaced_block.glsl"
#include "views/prism.glsl"
#include "views/prism_ray.glsl"
#include "views/height_search.glsl"
#include "views/surface_pixel.glsl"
#include "views/material_textures.glsl"
uniform sampler2D uCoordinates;
uniform sampler2D uVertexColors;
flat in int vPrism;

ivec2 vertexTexel(int vertex, ivec2 size) { return min(ivec2(vertex % size.x, vertex / size.x), size - 1); }

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.object != displaced.object) discard;
    Prism prism = prismOf(vPrism);
    PrismRay ray = eyeRayIn(prism);
    float start = dot(displaced.depthFromObject, vec4(prism.middle + ray.origin, 1.0));
    float at = (pixel.z - start) / dot(displaced.depthFromObject.xyz, ray.direction);
    vec3 place = ray.origin + at * ray.direction;
    vec3 q = inPrism(prism, place, inPrism(prism, place, vec3(0.33, 0.33, 0.5 * displaced.span.y)));
    float inside = min(min(q.x, q.y), 1.0 - q.x - q.y);
    if (!(inside > -2.0 * kRoom && q.z > 2.0 * displaced.span.x && q.z < 2.0 * displaced.span.y)) discard;
    vec2 onMap = coordinateAt(prism, q.xy) * (displaced.field.texels - 2.0);
    float apart = abs(q.z - metresAt(onMap)) / (displaced.span.y - displaced.span.x);
    gl_FragDepth = clamp(0.5 * apart, 0.0, 1.0);

    vec4 coordinates[3];
    vec3 colors[3];
    for (int i = 0; i < 3; ++i) {
        int vertex = vertexOf(vPrism, i);
        coordinates[i] = texelFetch(uCoordinates, vertexTexel(vertex, textureSize(uCoordinates, 0)), 0);
        colors[i] = texelFetch(uVertexColors, vertexTexel(vertex, textureSize(uVertexColors, 0)), 0).rgb;
    }
    vec3 weights = vec3(1.0 - q.x - q.y, q.xy);
    vec4 coordinate = weights.x * coordinates[0] + weights.y * coordinates[1] + weights.z * coordinates[2];
    vec3 color = weights.x * colors[0] + weights.y * colors[1] + weights.z * colors[2];
    mat3 turn = mat3(displaced.normalFromObject);
    vec3 own = fromOctahedral(pixel.g);
    vec3 normal = texturedNormal(own, turn * (prism.place[1] - prism.place[0]),
                                 turn * (prism.place[2] - prism.place[0]),
                                 coordinateOf(coordinates[1] - coordinates[0], displaced.wraps.w),
                                 coordinateOf(coordinates[2] - coordinates[0], displaced.wraps.w), coordinate,
                                 displaced.wraps.w, displaced.normalScale);
    if (dot(normal, turn * ray.direction) > 0.0) normal = own;
    writeTextures(normal, color, coordinate, displaced.wraps);
}
