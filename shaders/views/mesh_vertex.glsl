// views/mesh_vertex.glsl: the vertices of one object. A vertex is a texel of two images; gl_VertexID is its number.
//
// out   vNormal [1]  world, interpolated; not unit
//       vDepth  [m]  along the view's forward
//       vPaint  PAINTED: place on the atlas [texels]
//       vCoordinate     TEXTURED, HOLES: places on the textures by both sets of coordinates
//       vColor, vPlace [m]  TEXTURED: colour, and place in the world from the eye on
#include "views/mesh_block.glsl"
uniform sampler2D uPositions; // object space
uniform sampler2D uNormals;
out vec3 vNormal;
out float vDepth;
#ifdef PAINTED
uniform sampler2D uPlaces;
out vec2 vPaint;
#endif
#if defined(TEXTURED) || defined(HOLES)
uniform sampler2D uCoordinates; // of all vertices, as the positions; or one row
out vec4 vCoordinate;
#endif
#ifdef TEXTURED
uniform sampler2D uVertexColors;
out vec3 vColor;
out vec3 vPlace;
#endif

void main() {
    int width = textureSize(uPositions, 0).x;
    ivec2 texel = ivec2(gl_VertexID % width, gl_VertexID / width);
    vec4 world = mesh.worldFromObject * vec4(texelFetch(uPositions, texel, 0).xyz, 1.0);
    vNormal = mat3(mesh.normalFromObject) * texelFetch(uNormals, texel, 0).xyz;
    vDepth = dot(world.xyz - mesh.view.eye.xyz, mesh.view.forward.xyz);
#ifdef PAINTED
    vPaint = texelFetch(uPlaces, texel, 0).xy;
#endif
#if defined(TEXTURED) || defined(HOLES)
    vCoordinate = texelFetch(uCoordinates, min(texel, textureSize(uCoordinates, 0) - 1), 0);
#endif
#ifdef TEXTURED
    vColor = texelFetch(uVertexColors, min(texel, textureSize(uVertexColors, 0) - 1), 0).rgb;
    vPlace = world.xyz - mesh.view.eye.xyz;
#endif
    gl_Position = mesh.clipFromWorld * world;
}
