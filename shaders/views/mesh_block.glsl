#include "views/view.glsl"
layout(std140) uniform MeshBlock {
    mat4 clipFromWorld;
    mat4 worldFromObject;
    mat4 normalFromObject; // inverse transpose, rotation part
    View view;
    int object;  // in the scene
    int firstCorner; // of a refractive mesh, among those of all
    float normalScale; // of textured meshes, this and the rest
    float cutoff;      // as scene::Textures has it
    float threshold;   // of what is blended, added to those of views/holes.glsl: [0,1]
    vec4 wraps; // of color, emission, roughness and normal: codes of views/texture_at.glsl
} mesh;
