// views/pose_flat.frag: normals of moved triangles; vertices 3i to 3i + 2 are a triangle.
//
// out   oNormal  object space; of a triangle without area the vertex's own
uniform sampler2D uPositions;
uniform sampler2D uNormals;
layout(location = 0) out vec4 oNormal;

vec3 positionOf(int vertex, int width) {
    return texelFetch(uPositions, ivec2(vertex % width, vertex / width), 0).xyz;
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy), size = textureSize(uPositions, 0);
    int first = (texel.y * size.x + texel.x) / 3 * 3;
    vec3 n = vec3(0.0);
    if (first + 2 < size.x * size.y) {
        vec3 a = positionOf(first, size.x);
        n = cross(positionOf(first + 1, size.x) - a, positionOf(first + 2, size.x) - a);
    }
    float length2 = dot(n, n);
    oNormal = length2 > 0.0 ? vec4(n * inversesqrt(length2), 0.0) : texelFetch(uNormals, texel, 0);
}
