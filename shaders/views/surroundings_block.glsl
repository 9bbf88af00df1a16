// views/surroundings_block.glsl: cube views from mirrors and refractive objects.
const int kMostCubes = 8; // more are not drawn
const int kMostFlat = 4;  // mirrors with pictures of their own

struct Cube {
    vec4 place;       // world, its middle; w: number of its mirror in the scene, -1: of refractive objects, -2: shows
                      // nothing but the mirror of the cube before, which is seen in itself
    vec4 reflectance; // of the mirror; a: a bit for each face that shows anything, of the first objects and of
                      // the second ones
};
struct Around {
    Cube cubes[kMostCubes];
    vec4 low, high; // world: of a box around all that there is
    int count;      // of cubes
    int further;    // mirrors that a ray is followed to at most
    float texelsALook; // along a ray, as the cube's middle sees it
};
