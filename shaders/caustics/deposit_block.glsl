// caustics/deposit_block.glsl: the caustic map, which lies in the light's views of the receivers.
#include "views/view.glsl"
layout(std140) uniform DepositBlock {
    View faces[6];
    ivec2 grid; // rays a side
    int faceCount;
    int face;   // that is drawn
    float unit; // [W] that the map counts as 1
    float size; // of a splat, texels
    int padding0, padding1;
} light;
#include "views/shadow.glsl"

// Pixel coordinates in the face that is drawn; z: depth.
vec3 onMap(vec3 place) {
    View face = light.faces[light.face];
    vec3 seen = inView(face, place - face.eye.xyz);
    return vec3(pixelOf(face, seen), seen.z);
}

vec4 clipFromMap(vec2 pixel) { return vec4(2.0 * pixel / light.faces[light.face].size - 1.0, 0.0, 1.0); }

const vec4 kAway = vec4(2.0, 2.0, 0.0, 1.0); // outside of every face
