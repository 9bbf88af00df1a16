// caustics/deposit_block.glsl: the caustic map, which lies in the light's views of the receivers.
#include "views/view.glsl"
layout(std140) uniform DepositBlock {
    View faces[6];
    ivec2 grid; // rays a side
    int faceCount;
    int face;   // that is drawn
    float unit; // [W] that the map counts as 1
    float size; // of a splat, texels; of what bends light: width of a ray's cell [m], of a point's light a metre deep
    int padding0, padding1;
} light;
#include "views/shadow.glsl"

// Pixel coordinates in a face; z: depth.
vec3 onMap(int number, vec3 place) {
    View face = light.faces[number];
    vec3 seen = inView(face, place - face.eye.xyz);
    return vec3(pixelOf(face, seen), seen.z);
}

vec4 clipFromMap(vec2 pixel) { return vec4(2.0 * pixel / light.faces[light.face].size - 1.0, 0.0, 1.0); }

// The middle of the texel: a point of one texel on the border between two may be drawn on both or none.
vec4 clipFromTexel(vec2 pixel) { return clipFromMap(floor(pixel) + 0.5); }

const vec4 kAway = vec4(2.0, 2.0, 0.0, 1.0); // outside of every face
