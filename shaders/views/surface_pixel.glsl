// views/surface_pixel.glsl: what views/surface.frag leaves in a pixel of the surface image, and its reading.
//
// w: object * 8 + face + coverage / 2. 0: nothing there.
// Height fields: xy: g of field.glsl; z: object-space height in metres. Faces: 1 the field itself; 2..5 the walls
// towards -x, +x, -y, +y of object space.
// Other shapes: face 6; xy: octahedral normal, world; z: depth along the view in metres.
uniform sampler2D uSurface;

const int kMeshFace = 6;

struct SurfacePixel {
    vec2 g;
    float z;
    int object; // index in the scene, -1: background
    int face;
    float coverage;
};

float packSurface(int object, int face, float coverage) { return float(8 * object + face) + 0.5 * coverage; }

SurfacePixel surfaceAt(ivec2 at) {
    vec4 texel = texelFetch(uSurface, at, 0);
    int code = int(floor(texel.w));
    return SurfacePixel(texel.xy, texel.z, code == 0 ? -1 : code >> 3, code & 7, 2.0 * fract(texel.w));
}

SurfacePixel readSurface() { return surfaceAt(ivec2(gl_FragCoord.xy)); }

vec3 wallNormal(int face) {
    float side = (face & 1) == 0 ? -1.0 : 1.0;
    return face < 4 ? vec3(side, 0.0, 0.0) : vec3(0.0, side, 0.0);
}
