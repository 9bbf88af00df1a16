// views/pose.frag: the vertices of a mesh as they stand at one time: morph targets, then joints, then a wave.
//
// model morphing and skinning as glTF 2.0 has them (3.7.2.2, 3.7.3.3); then
//       p' = p + amplitude sin(2 pi (turns . p + turns.w)). Normals go by the inverse transpose of each motion's
//       derivative times the size of its determinant, which exists for flat ones as well; for the wave, whose
//       derivative is 1 + a k^T, that is the sign of 1 + a.k times (1 + a.k) - k a^T (Sherman, Morrison 1950)
#pragma variants - TARGETS
#pragma variants - JOINTS
#pragma variants - WAVE
uniform sampler2D uPositions;
uniform sampler2D uNormals;
layout(location = 0) out vec4 oPosition;
layout(location = 1) out vec4 oNormal;

#ifdef TARGETS
uniform sampler2DArray uTargets; // displacements: layer 2i of positions, 2i + 1 of normals
uniform sampler2D uTargetWeights; // a texel a target

void morph(ivec2 texel, inout vec3 p, inout vec3 n) {
    for (int i = 0; i < textureSize(uTargetWeights, 0).x; ++i) {
        float weight = texelFetch(uTargetWeights, ivec2(i, 0), 0).x;
        p += weight * texelFetch(uTargets, ivec3(texel, 2 * i), 0).xyz;
        n += weight * texelFetch(uTargets, ivec3(texel, 2 * i + 1), 0).xyz;
    }
}
#endif

#ifdef JOINTS
uniform usampler2D uJoints;       // four of 16 bits
uniform sampler2D uJointWeights;
uniform sampler2D uJointMatrices; // a row a joint, a texel a column

mat4 joint(uint number) {
    int row = int(number);
    return mat4(texelFetch(uJointMatrices, ivec2(0, row), 0), texelFetch(uJointMatrices, ivec2(1, row), 0),
                texelFetch(uJointMatrices, ivec2(2, row), 0), texelFetch(uJointMatrices, ivec2(3, row), 0));
}

void skin(ivec2 texel, inout vec3 p, inout vec3 n) {
    uvec2 pairs = texelFetch(uJoints, texel, 0).xy;
    vec4 weights = texelFetch(uJointWeights, texel, 0);
    mat4 m = weights.x * joint(pairs.x & 0xffffu) + weights.y * joint(pairs.x >> 16) +
             weights.z * joint(pairs.y & 0xffffu) + weights.w * joint(pairs.y >> 16);
    p = (m * vec4(p, 1.0)).xyz;
    vec3 x = m[0].xyz, y = m[1].xyz, z = m[2].xyz;
    vec3 yz = cross(y, z);
    vec3 turned = yz * n.x + cross(z, x) * n.y + cross(x, y) * n.z;
    n = dot(x, yz) < 0.0 ? -turned : turned;
}
#endif

#ifdef WAVE
layout(std140) uniform PoseBlock {
    vec4 amplitude; // m
    vec4 turns;     // xyz: turns of the sine for each metre; w: turns at the origin
} wave;
const float kTwoPi = 6.28318531;

void bend(inout vec3 p, inout vec3 n) {
    float turn = dot(wave.turns.xyz, p) + wave.turns.w;
    float angle = kTwoPi * (turn - floor(turn));
    vec3 k = kTwoPi * cos(angle) * wave.turns.xyz;
    vec3 a = wave.amplitude.xyz;
    p += sin(angle) * a;
    float stretch = 1.0 + dot(a, k);
    vec3 turned = stretch * n - k * dot(a, n);
    n = stretch < 0.0 ? -turned : turned;
}
#endif

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec3 p = texelFetch(uPositions, texel, 0).xyz;
    vec3 rest = texelFetch(uNormals, texel, 0).xyz;
    vec3 n = rest;
#ifdef TARGETS
    morph(texel, p, n);
#endif
#ifdef JOINTS
    skin(texel, p, n);
#endif
#ifdef WAVE
    bend(p, n);
#endif
    float size = length(n);
    oPosition = vec4(p, 0.0);
    oNormal = vec4(size > 0.0 ? n / size : rest, 0.0);
}
