// views/glass_block.glsl: what a refractive object does with light.
struct Glass {
    vec4 ior;        // of red, green, blue; a: 1 with Fresnel's reflection
    vec4 absorption; // 1/m; a: transmission
};
const int kMostGlass = 31; // each is a bit of a number; the last bit is its sign
