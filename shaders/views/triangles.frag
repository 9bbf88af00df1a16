// views/triangles.frag: corners and triangles of one mesh among those of all refractive meshes, in the world.
//
// in    uPositions, uNormals  of the mesh's vertices, object space
//       uSources, uTable      its own table, counted from 0 (views/triangle_links.glsl)
// out   views/triangles.glsl
#include "views/triangle_links.glsl"
#include "views/layer_texel.glsl"
uniform sampler2D uPositions;
uniform sampler2D uNormals;
uniform usampler2D uSources;
uniform usampler2D uTable;
layout(std140) uniform TrianglesBlock {
    mat4 worldFromObject;
    mat4 normalFromObject;
    int first; // where this mesh begins among all
    int count;
} mesh;
layout(location = 0) out vec4 oCorner;
layout(location = 1) out vec4 oNormal;
layout(location = 2) out uvec4 oLinks;

// Water has rows of its own.
ivec2 vertexOf(int corner) {
    int source = int(texelFetch(uSources, tableTexel(corner), 0).x), width = textureSize(uPositions, 0).x;
    return ivec2(source % width, source / width);
}

vec3 placeOf(ivec2 vertex) { return (mesh.worldFromObject * vec4(texelFetch(uPositions, vertex, 0).xyz, 1.0)).xyz; }

int shifted(int number) { return number == kNoTriangle ? number : number + mesh.first; }

void main() {
    int corner = int(gl_FragCoord.y) * textureSize(uSources, 0).x + int(gl_FragCoord.x) - mesh.first;
    Links links = linksFrom(texelFetch(uTable, tableTexel(corner), 0));
    ivec2 vertex = vertexOf(corner);
    vec3 place = placeOf(vertex);
    vec3 normal = normalize(mat3(mesh.normalFromObject) * texelFetch(uNormals, vertex, 0).xyz);
    vec3 outward = normal;
    if (corner < mesh.count && links.corners.x != kNoTriangle) {
        vec3 a = placeOf(vertexOf(links.corners.x)) - place, b = placeOf(vertexOf(links.corners.y)) - place;
        vec3 across = cross(a, b);
        if (across != vec3(0.0)) outward = normalize(across);
    }
    oCorner = vec4(place, packedNormal(outward));
    oNormal = vec4(normal, 0.0);
    oLinks = texelFrom(Links(ivec2(shifted(links.corners.x), shifted(links.corners.y)),
                             ivec3(shifted(links.across.x), shifted(links.across.y), shifted(links.across.z))));
}
