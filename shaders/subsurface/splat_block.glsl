// subsurface/splat_block.glsl: one level of points and the band of the profile that they leave around them.
#include "views/view.glsl"
const int kMostPoles = 32;

layout(std140) uniform SplatBlock {
    View view;        // the camera's, in pixels of what is drawn into
    vec4 bounds;      // lowest and highest pixel that the object may cover
    vec4 depths[kMostPoles];  // rgb: of each pole below the place where light enters [m]; a: of depths[0]: how many
    vec4 weights[kMostPoles]; // rgb: [m]
    vec4 transport;   // rgb: [1/m]
    vec4 albedo;      // rgb
    int columns;      // of the level
    int object;
    float widest;     // points that stand for more of the surface are not used [m, times M_d]
    float reach;      // of the band [m, times M_d]
    int isFinest;     // the level: its points are used however wide
    int isCoarsest;
    int first;        // of the points that are gathered
    int count;
    float unit;       // [W/m²] that counts as 1 where light is gathered
    float bluntest;   // M_d of the painted points that are used, without this one
    float sharpest;   // up to this one
    int side;         // of a ball's square [pixels of what is drawn into]
    int corners;      // vertices of a splat: 1, a square point; 6, two triangles
} splat;
