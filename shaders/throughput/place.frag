// throughput/place.frag: where the texels of an object's atlas lie in the world, as views of surfaces have it.
//
// in    uPlace    object's space times its scale [m] | area of the texel [m²]; 0: shows nothing
//       uFrame    octahedral normal, object's space
// out   oSurface  views/surface_pixel.glsl; z: unused
//       oPlaces   world
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
layout(std140) uniform PlaceBlock {
    mat4 worldFromBody; // turns and moves
    int object;
} body;
uniform sampler2D uPlace;
uniform sampler2D uFrame;
layout(location = 0) out vec4 oSurface;
layout(location = 1) out vec4 oPlaces;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 place = texelFetch(uPlace, at, 0);
    if (place.w == 0.0) discard;
    vec3 normal = mat3(body.worldFromBody) * fromOctahedral(texelFetch(uFrame, at, 0).xy);
    oSurface = vec4(octahedralFrom(normal), 0.0, packSurface(body.object, kMeshFace, 1.0));
    oPlaces = body.worldFromBody * vec4(place.xyz, 1.0);
}
